// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// All that a new law must add to be held to every rule of this folder: a value for each of its parameters, and what
// it claims. A law in grainlaw::Recipes is tested because it is listed there; a combination of slots that is no
// recipe is listed in Variants below.
#include <array>
#include <limits>
#include <string_view>
#include <tuple>

#include "rheology/laws.hpp"
#include "tests/build/coulomb.hpp"

namespace grainlaw::consistency {

/// A parameter by its name in the table.
struct Value {
  std::string_view name;
  double value;
};

/// What a law promises beyond the contract.
struct Claims {
  /// d(sigma)/dt is positively homogeneous of degree one in L: no time of its own.
  bool rate_independent;
  /// d(sigma)/dt at a frozen density factor is positively homogeneous of degree one in the stress.
  bool homogeneous_in_stress;
  /// The rate-dependent part of the stress grows with this power of L; NaN when it is no power, 0 when there is none.
  double degree_in_L;
  /// Under a constant isochoric shear it ends up flowing, and then takes up work.
  bool flows;
};

template <class Owner>
inline constexpr int example_values = 0;  // nothing given
template <class L>
inline constexpr int claims = 0;

// newtonian: a thick syrup
template <>
inline constexpr std::array example_values<Newtonian>{Value{"eta", 50.0}, Value{"K", 2e6}};
template <>
inline constexpr Claims claims<Newtonian>{true, true, 1, true};

// elastic: soft rubber
template <>
inline constexpr std::array example_values<Elastic>{Value{"K", 3e6}, Value{"G", 1e6}};
template <>
inline constexpr Claims claims<Elastic>{true, false, 0, false};

// hypoplastic: Karlsruhe fine sand, which has no pole; the floor lies below every ordinary pressure
template <class Critical, class Form>
inline constexpr std::array example_values<Hypoplastic<Critical, Form>>{
    Value{"c1", -42.0}, Value{"c2", -281.78}, Value{"c3", -372.23}, Value{"c4", 578.86}, Value{"p_floor", 1e-7}};
template <>
inline constexpr std::array example_values<CriticalState>{
    Value{"e_min", 0.677}, Value{"p1", 0.75},   Value{"p2", 0.242},   Value{"p3", -0.184e-6},
    Value{"q1", 1.0},      Value{"q2", -0.334}, Value{"q3", -0.33e-6}};
template <class Critical, class Form>
inline constexpr Claims claims<Hypoplastic<Critical, Form>>{true, true, 0, true};

// bagnold: peas in a drum
template <>
inline constexpr std::array example_values<Bagnold>{Value{"k_v", 0.01}, Value{"alpha_i", 0.6}};
template <>
inline constexpr Claims claims<Bagnold>{true, true, 2, true};

template <class Critical, class Form, class Collisions>
inline constexpr Claims claims<HypoplasticBagnold<Critical, Form, Collisions>>{true, true, on<Collisions> ? 2.0 : 0.0,
                                                                               true};

// coulomb: the law of another project
template <>
inline constexpr std::array example_values<example::Coulomb>{Value{"mu", 0.5}, Value{"g0", 1e-3}, Value{"K", 1e6}};
template <>
inline constexpr Claims claims<example::Coulomb>{true, true, std::numeric_limits<double>::quiet_NaN(), true};

/// Combinations that no recipe lists: slots off one by one, in both forms where the form matters.
using Variants = std::tuple<Hypoplastic<NoCriticalState>, Hypoplastic<NoCriticalState, LogForm>,
                            HypoplasticBagnold<NoCriticalState, StressForm, Bagnold>,
                            HypoplasticBagnold<CriticalState, StressForm, NoCollisions>,
                            HypoplasticBagnold<NoCriticalState, LogForm, NoCollisions>, example::Coulomb>;

/// The void ratio at zero compaction, and the range of compactions that every example law accepts.
inline constexpr double example_void_ratio = 0.85, smallest_compaction = -0.09, largest_compaction = 0.09;

}  // namespace grainlaw::consistency
