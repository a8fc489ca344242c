// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// The contract between a law and whoever hosts it: an element test, a particle solver, another code.
#include <array>
#include <string_view>

#include "parameter.hpp"
#include "tensor.hpp"

namespace grainlaw {

/// What the host knows at a point. The density enters as the compaction rho/rho_ref - 1 (0 where the host starts):
/// near-incompressible laws lose no digits, and history laws get their void ratio from it.
template <class R>
struct Flow {
  Tensor<R> L;   ///< velocity gradient L_ij = dv_i/dx_j [1/s]
  R compaction;  ///< rho/rho_ref - 1 [-]
};

/// Why a state had to be corrected or is not to be trusted; `admit` returns them as bits, the host counts them.
enum Reason : unsigned {
  pressure_floor = 1,   ///< pressure below the floor, lifted
  tension = 2,          ///< a principal stress was not compressive, deviator scaled back
  beyond_validity = 4,  ///< outside the range in which the formulas mean anything, clamped
  not_finite = 8,       ///< NaN, infinity or numbers whose products overflow came in; nothing is repaired
  too_many_steps = 16,  ///< `advance` gave up before the end of the step
};
inline constexpr std::array<std::string_view, 5> reason_names{"pressure_floor", "tension", "beyond_validity",
                                                              "not_finite", "too_many_steps"};

template <class State, class R>
struct Admitted {
  State state;
  bits_t<R> reasons;
};

/// An effect that is absent has an empty type of its own (`NoCriticalState`): no time, no bytes.
template <class Slot>
inline constexpr bool on = !std::is_empty_v<Slot>;

/// How many numbers a state holds; a state is nothing but Reals, and a host may see it as an array.
template <class State, class R>
inline constexpr int count = std::is_empty_v<State> ? 0 : int(sizeof(State) / sizeof(R));

/// A sink that accepts anything, for checking the concept.
struct IgnoreAll {
  constexpr void operator()(std::string_view /*name*/, std::string_view /*unit*/, const auto& /*value*/) const {}
};

/// A constitutive law: a plain struct of parameters, a plain State, pure functions that never throw or allocate.
///
///     start(flow, sigma)       the state whose total stress is sigma
///     stress(flow, state)      Cauchy stress, including the part that depends on the rate [Pa]
///     rate(flow, state)        d(state)/dt, spin terms included [1/s]
///     admit(flow, state)       the nearest state the law can live with, and why it was changed
///     wave_speed(flow, state, density)   upper bound of the speed of sound [m/s]
///     viscosity(flow, state)   upper bound of d(shear stress)/d(shear rate) [Pa s]
///     observe(flow, state, sink)         named intermediate results with units
///
/// The density is an argument of wave_speed because a rate-independent law has no density of its own.
template <class L, class R = double>
concept Law = std::is_trivially_copyable_v<L> && std::is_trivially_copyable_v<typename L::template State<R>> &&
    requires(const L law, const Flow<R> flow, const typename L::template State<R> state, const SymTensor<R> sigma,
             const R density) {
  { L::name } -> std::convertible_to<std::string_view>;
  { L::source } -> std::convertible_to<std::string_view>;
  { L::valid } -> std::convertible_to<std::string_view>;
  { law.start(flow, sigma) }
  noexcept->std::same_as<typename L::template State<R>>;
  { law.stress(flow, state) }
  noexcept->std::same_as<SymTensor<R>>;
  { law.rate(flow, state) }
  noexcept->std::same_as<typename L::template State<R>>;
  { law.admit(flow, state) }
  noexcept->std::same_as<Admitted<typename L::template State<R>, R>>;
  { law.wave_speed(flow, state, density) }
  noexcept->std::same_as<R>;
  { law.viscosity(flow, state) }
  noexcept->std::same_as<R>;
  law.observe(flow, state, IgnoreAll{});
};

/// The stress is part of the state (not a function of the velocity gradient alone).
template <class L, class R = double>
concept StressInState = requires(typename L::template State<R> state) {
  state.sigma;
};

}  // namespace grainlaw
