// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "law.hpp"

namespace grainlaw {

/// Hypoelastic solid with the Jaumann rate: the smallest law with a history.
///
///     d(sigma)/dt = K tr(D) I + 2 G D' + W sigma - sigma W
///
/// Source   textbook; simple shear has the closed form sigma_xz = G sin(gamma), sigma_xx = G (1 - cos(gamma)).
/// Inputs   L [1/s].   State   sigma [Pa].   Output   d(sigma)/dt [Pa/s]
/// Valid    small elastic strains; the oscillation in simple shear is the Jaumann rate's own.
/// Fails    never.
struct Elastic {
  Constant K, G;

  template <class R>
  struct State {
    SymTensor<R> sigma;  ///< [Pa]
  };

  static constexpr std::string_view name = "elastic";
  static constexpr std::string_view source = "hypoelasticity with the Jaumann rate";
  static constexpr std::string_view valid = "small elastic strains, any rotation";

  static constexpr auto parameters() {
    using P = Parameter<Elastic>;
    return std::array{P{"K", "Pa", "bulk modulus", &Elastic::K, 1e-6, 1e15},
                      P{"G", "Pa", "shear modulus", &Elastic::G, 1e-6, 1e15}};
  }

  template <class R>
  constexpr SymTensor<R> stress(const Flow<R>& /*flow*/, const State<R>& state) const noexcept {
    return state.sigma;
  }
  template <class R>
  constexpr State<R> rate(const Flow<R>& flow, const State<R>& state) const noexcept {
    const SymTensor<R> D = symmetric(flow.L);
    return {plus_isotropic<R>((Constant(2) * G.as<R>()) * deviator(D), K * trace(D)) + spin_rate(flow.L, state.sigma)};
  }
  template <class R>
  constexpr State<R> start(const Flow<R>& /*flow*/, const SymTensor<R>& sigma) const noexcept {
    return {sigma};
  }
  template <class R>
  constexpr Admitted<State<R>, R> admit(const Flow<R>& flow, const State<R>& state) const noexcept {
    const mask_t<R> usable =
        size_of(flow.L) < real::largest_rate<R>() && size_of(state.sigma) < real::largest_stress<R>();
    return {state, real::flag<R>(!usable, not_finite)};
  }
  template <class R>
  constexpr R wave_speed(const Flow<R>& /*flow*/, const State<R>& state, const R& density) const noexcept {
    return real::sqrt<R>((K + (Constant(4.0 / 3) * G.as<R>() + Constant(2) * norm(state.sigma))) / density);
  }
  template <class R>
  constexpr R viscosity(const Flow<R>& /*flow*/, const State<R>& /*state*/) const noexcept {
    return R(0);
  }
  template <class R, class Sink>
  constexpr void observe(const Flow<R>& /*flow*/, const State<R>& state, Sink&& sink) const {
    const SymTensor<R> s = deviator(state.sigma);
    const R p = pressure(state.sigma);
    sink("elastic_energy", "J/m^3", R(p * p / (Constant(2) * K.as<R>()) + contract(s, s) / (Constant(4) * G.as<R>())));
  }
};

}  // namespace grainlaw
