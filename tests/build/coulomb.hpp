// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// A law of another project, whole: what a law is made of, and nothing else. The tests hold it to the same rules as
// the library's own.
#include "rheology/law.hpp"

namespace example {
using namespace grainlaw;

/// Frictional fluid: Coulomb friction at the pressure of a linear equation of state, creeping below the rate g0.
///
///     sigma = -p I + 2 mu p D'/sqrt(gamma_dot^2 + g0^2),   p = max(K (rho/rho_ref - 1), 0)
///
/// Source   Coulomb friction with the usual regularisation.
/// Inputs   L [1/s], compaction [-].   State   none.   Output   stress [Pa]
/// Valid    gamma_dot >> g0; small compaction.   Fails   never: no stress at compaction <= 0.
struct Coulomb {
  Constant mu, g0, K;

  template <class R>
  struct State {};

  static constexpr std::string_view name = "coulomb";
  static constexpr std::string_view source = "Coulomb friction, regularised at small rates";
  static constexpr std::string_view valid = "gamma_dot >> g0, small compaction";

  static constexpr auto parameters() {
    using P = Parameter<Coulomb>;
    return std::array{P{"mu", "-", "friction coefficient", &Coulomb::mu, 0.0, 2.0},
                      P{"g0", "1/s", "shear rate below which the material creeps", &Coulomb::g0, 1e-12, 1e6},
                      P{"K", "Pa", "bulk modulus of the equation of state", &Coulomb::K, 0.0, 1e15}};
  }

  template <class R>
  constexpr R fluid_pressure(const Flow<R>& flow) const {
    return real::at_least<R>(K * flow.compaction, R(0));
  }
  template <class R>
  constexpr SymTensor<R> stress(const Flow<R>& flow, const State<R>& /*state*/) const noexcept {
    const SymTensor<R> D = deviator(symmetric(flow.L));
    const R p = fluid_pressure(flow);
    const R rate = real::sqrt<R>(Constant(2) * contract(D, D) + (g0.as<R>() * g0.as<R>()));
    return plus_isotropic<R>((Constant(2) * mu.as<R>() * p / rate) * D, -p);
  }
  template <class R>
  constexpr State<R> rate(const Flow<R>& /*flow*/, const State<R>& /*state*/) const noexcept {
    return {};
  }
  template <class R>
  constexpr State<R> start(const Flow<R>& /*flow*/, const SymTensor<R>& /*sigma*/) const noexcept {
    return {};
  }
  template <class R>
  constexpr Admitted<State<R>, R> admit(const Flow<R>& flow, const State<R>& state) const noexcept {
    const SymTensor<R> sigma = stress(flow, state);
    return {state, real::flag<R>(!real::is_finite(contract(sigma, sigma)), not_finite)};
  }
  template <class R>
  constexpr R wave_speed(const Flow<R>& flow, const State<R>& /*state*/, const R& density) const noexcept {
    // friction follows the pressure; 2/sqrt(3) is the largest principal value of 2 D'/gamma_dot
    const R stiffness = K * real::at_least<R>(Constant(1) + flow.compaction, R(0));
    return real::sqrt<R>((Constant(1) + Constant(1.1547005383792517) * mu.as<R>()) * stiffness / density);
  }
  template <class R>
  constexpr R viscosity(const Flow<R>& flow, const State<R>& /*state*/) const noexcept {
    return mu * fluid_pressure(flow) / g0.as<R>();
  }
  template <class R, class Sink>
  constexpr void observe(const Flow<R>& flow, const State<R>& /*state*/, Sink&& sink) const {
    sink("fluid_pressure", "Pa", fluid_pressure(flow));
  }
};
static_assert(Law<Coulomb>);

}  // namespace example
