// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "law.hpp"

namespace grainlaw {

/// Viscous fluid with a linear equation of state: the smallest law without a history.
///
///     sigma = -K (rho/rho_ref - 1) I + 2 eta D'
///
/// Source   textbook (Newton; weakly compressible fluid).
/// Inputs   L [1/s], compaction [-].   State   none.   Output   stress [Pa]
/// Valid    small compaction.   Fails   never; at compaction < 0 the pressure is negative, as the equation says.
struct Newtonian {
  Constant eta, K;

  template <class R>
  struct State {};

  static constexpr std::string_view name = "newtonian";
  static constexpr std::string_view source = "Newtonian fluid, linear equation of state";
  static constexpr std::string_view valid = "small compaction";

  static constexpr auto parameters() {
    using P = Parameter<Newtonian>;
    return std::array{P{"eta", "Pa s", "shear viscosity", &Newtonian::eta, 0.0, 1e15},
                      P{"K", "Pa", "bulk modulus of the equation of state", &Newtonian::K, 0.0, 1e15}};
  }

  template <class R>
  constexpr SymTensor<R> stress(const Flow<R>& flow, const State<R>& /*state*/) const noexcept {
    return plus_isotropic<R>((Constant(2) * eta.as<R>()) * deviator(symmetric(flow.L)), -(K * flow.compaction));
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
    const mask_t<R> usable =
        size_of(flow.L) < real::largest_rate<R>() && real::abs(flow.compaction) < real::largest_stress<R>();
    return {state, real::flag<R>(!usable, not_finite)};
  }
  /// The compaction at which the pressure at rest is p.
  constexpr double compaction_at(double p) const noexcept { return p / K.value; }
  template <class R>
  constexpr R wave_speed(const Flow<R>& flow, const State<R>& /*state*/, const R& density) const noexcept {
    // dp/d(rho) = K/rho_ref, and rho_ref = density/(1 + compaction)
    return real::sqrt<R>(K * real::at_least<R>(Constant(1) + flow.compaction, R(0)) / density);
  }
  template <class R>
  constexpr R viscosity(const Flow<R>& /*flow*/, const State<R>& /*state*/) const noexcept {
    return eta.as<R>();
  }
  template <class R, class Sink>
  constexpr void observe(const Flow<R>& flow, const State<R>& /*state*/, Sink&& sink) const {
    const R g = shear_rate(symmetric(flow.L));
    sink("dissipation", "W/m^3", R(eta * (g * g)));
  }
};

}  // namespace grainlaw
