// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "law.hpp"

namespace grainlaw {

/// Collisional stress of a sheared grain flow in the grain-inertia range.
///
///     sigma_v = -(4 k_v / tan alpha_i) J2 I + 4 k_v sqrt(J2) D',   J2 = D':D'/2
///
/// In simple shear: shear stress k_v gamma_dot^2, pressure k_v gamma_dot^2 / tan alpha_i.
/// Source   Bagnold, Proc. R. Soc. A 225 (1954) 49; Peng, Guo, Wu & Wang, Acta Geotechnica 11 (2016) 1231, Eq. 12 with
///          its ||.|| read as J2, the only reading that gives back Eqs 8 and 9.
/// Inputs   L [1/s].   State   none.   Output   stress [Pa], quadratic in L
/// Valid    rapid dense shear; k_v belongs to one solid fraction (see bagnold_coefficient).
/// Fails    never; zero at rest.
struct Bagnold {
  Constant k_v;      ///< [kg/m]
  Constant alpha_i;  ///< [rad]

  template <class R>
  struct State {};

  static constexpr std::string_view name = "bagnold";
  static constexpr std::string_view source = "Peng, Guo, Wu & Wang, Acta Geotechnica 11 (2016) 1231, Eq. 12";
  static constexpr std::string_view valid = "rapid shear at the solid fraction that k_v belongs to";

  static constexpr auto parameters() {
    using P = Parameter<Bagnold>;
    return std::array{
        P{"k_v", "kg/m", "collisional coefficient, shear stress = k_v gamma_dot^2", &Bagnold::k_v, 0.0, 1e9},
        P{"alpha_i", "rad", "collisional friction angle, tan alpha_i = shear stress/dispersive pressure",
          &Bagnold::alpha_i, 1e-3, 1.57}};
  }

  template <class R>
  constexpr SymTensor<R> collisional(const Flow<R>& flow) const noexcept {
    const SymTensor<R> D = deviator(symmetric(flow.L));
    const R J2 = Constant(0.5) * contract(D, D);
    const R k = Constant(4) * k_v.as<R>();
    return plus_isotropic<R>((k * real::sqrt(J2)) * D, -(k * J2 * Constant(1 / std::tan(alpha_i.value))));
  }
  template <class R>
  constexpr SymTensor<R> stress(const Flow<R>& flow, const State<R>& /*state*/) const noexcept {
    return collisional(flow);
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
    return {state, real::flag<R>(!(size_of(flow.L) < real::largest_rate<R>()), not_finite)};
  }
  template <class R>
  constexpr R wave_speed(const Flow<R>& flow, const State<R>& /*state*/, const R& density) const noexcept {
    // d(pressure)/d(rate) carries no elastic wave; the speed at which collisions transmit momentum is sqrt(p/rho)
    return real::sqrt<R>(-(trace(collisional(flow))) * Constant(1.0 / 3) / density);
  }
  template <class R>
  constexpr R viscosity(const Flow<R>& flow, const State<R>& /*state*/) const noexcept {
    // d(k_v g^2)/dg = 2 k_v g with g = 2 sqrt(J2)
    return Constant(4) * (k_v.as<R>() * real::sqrt(second_invariant(symmetric(flow.L))));
  }
  template <class R, class Sink>
  constexpr void observe(const Flow<R>& flow, const State<R>& /*state*/, Sink&& sink) const {
    const SymTensor<R> sigma = collisional(flow);
    sink("collisional_pressure", "Pa", pressure(sigma));
    sink("collisional_shear_stress", "Pa", R(real::sqrt(second_invariant(sigma))));
  }
};

/// No collisions: the slot costs neither time nor bytes.
struct NoCollisions {};

/// k_v by Bagnold's formula for spheres of density rho_s and diameter d at solid fraction C.
///
///     k_v = A rho_s (lambda d)^2,   lambda = 1/((C_max/C)^(1/3) - 1)
///
/// Source   Bagnold (1954). With A = 0.016 and C_max = 0.61 it gives the four printed values of Table 3 of
///          Peng et al. (2016) to their last digit.
/// Inputs   rho_s [kg/m^3], d [m], 0 < C < C_max [-].   Output   k_v [kg/m]; infinity at C >= C_max.
inline double bagnold_coefficient(double A, double rho_s, double d, double C, double C_max) noexcept {
  const double spacing = std::cbrt(C_max / C) - 1;
  if (!(spacing > 0)) return unbounded;
  return A * rho_s * (d / spacing) * (d / spacing);
}

}  // namespace grainlaw
