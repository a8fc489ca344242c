// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// What an engineer knows about a sand, and the four coefficients that follow; the states at which the law flows
// for ever. Set-up code: uses Eigen's dense solvers, not meant for hot loops.
#include <Eigen/LU>
#include <numbers>

#include "hypoplastic.hpp"

namespace grainlaw {

struct Calibration {
  double c1, c2, c3, c4;
  bool usable;  ///< c4 > 0: otherwise the law has no failure surface
};

/// c1..c4 from the initial tangents and the critical state in triaxial compression.
///
///     c1 = -E/(3 p (1 + nu)),   -9 c1 nu = c2 (2 nu - 1) + c3 sqrt(1 + 2 nu^2)
///     axial and lateral rate vanish at K = (1 + sin phi)/(1 - sin phi), D = (-1, d, d),
///     d = (1/2)(1 + sin psi)/(1 - sin psi),   I_e = 1
///
/// Source   Wu & Bauer's procedure; reproduces the four printed sets of Peng et al. (2016).
/// Inputs   E/p [-] at isotropic pressure p, nu [-], phi and psi [rad].
/// Valid    nu >= 0 makes c4 small quickly; usable is false when c4 <= 0.
inline Calibration calibrate(double E_over_p, double nu, double phi, double psi) {
  const double c1 = -E_over_p / (3 * (1 + nu));
  const double K = (1 + std::sin(phi)) / (1 - std::sin(phi)), d = 0.5 * (1 + std::sin(psi)) / (1 - std::sin(psi));
  const double axial = K / (K + 2), lateral = 1 / (K + 2), n = std::sqrt(1 + 2 * d * d);
  const double rD = -axial + 2 * lateral * d, s_axial = axial - 1.0 / 3, s_lateral = lateral - 1.0 / 3;
  Eigen::Matrix3d A;
  A << 2 * nu - 1, std::sqrt(1 + 2 * nu * nu), 0,            //
      rD * axial, n * axial * axial, n * s_axial * s_axial,  //
      rD * lateral, n * lateral * lateral, n * s_lateral * s_lateral;
  const Eigen::Vector3d c = A.partialPivLu().solve(Eigen::Vector3d(-9 * c1 * nu, c1, -c1 * d));
  return {c1, c[0], c[1], c[2], c[2] > 0};
}

/// Smallest I_e for which principal stresses provably stay compressive: 9 |c1|/c4.
inline double guaranteed_I_e(double c1, double c4) { return 9 * std::abs(c1) / c4; }

/// A stress direction that no longer changes while the volume stays constant.
struct StationaryState {
  SymTensor<double> r;  ///< sigma/tr(sigma) [-]
  double I_star;        ///< the density factor at which the state is stationary [-]
  bool found;
};

/// The critical state under a given isochoric velocity gradient: stress direction and I_e constant, spin included.
///
///     tr B(r, D) = 0,   d(s)/dt = 0
///
/// I* = 1 in triaxial compression, but not in other modes (known property of the basic Wu-Bauer law).
/// Inputs   c1..c4 of the law, L [1/s] with tr L = 0.   Fails   found = false when Newton does not converge.
template <class Critical, class Form>
StationaryState stationary_state(const Hypoplastic<Critical, Form>& law, const Tensor<double>& L) {
  using Vector = Eigen::Matrix<double, 6, 1>;
  using Bare = Hypoplastic<NoCriticalState, LogForm>;
  const auto residual = [&](const Vector& x) {
    const Bare scaled{law.c1, law.c2, law.c3.value * x[5], law.c4.value * x[5], 0, {}};
    const auto k = scaled.rate(Flow<double>{L, 0}, Bare::State<double>{0, x[0], x[1], x[2], x[3], x[4]});
    return Vector{k.ln_trace, k.yy, k.zz, k.yz, k.xz, k.xy};
  };
  const SymTensor<double> D = deviator(symmetric(L));
  const SymTensor<double> s = (-0.3 / norm(D)) * D;
  Vector x{s.yy, s.zz, s.yz, s.xz, s.xy, 1};
  Vector f = residual(x);
  for (int i = 0; i < 60; ++i) {
    Eigen::Matrix<double, 6, 6> J;
    for (int k = 0; k < 6; ++k) {
      Vector up = x, down = x;
      up[k] += 1e-6, down[k] -= 1e-6;
      J.col(k) = (residual(up) - residual(down)) / 2e-6;
    }
    const Vector step = J.partialPivLu().solve(f);
    double damping = 1;
    Vector trial = x - step;
    while (damping > 1e-4 && !(residual(trial).norm() < f.norm() * (1 - 0.1 * damping))) {
      damping /= 2;
      trial = x - damping * step;
    }
    if (step.norm() < 1e-15 || damping <= 1e-4) break;
    x = trial;
    f = residual(x);
  }
  const SymTensor<double> found{-(x[0] + x[1]), x[0], x[1], x[2], x[3], x[4]};
  // round-off of the residual: coefficients of size |c4| times |D|
  const bool good = f.norm() < 1e-9 * std::abs(law.c4.value) * norm(D);
  return {plus_isotropic(found, 1.0 / 3), x[5], good};
}

inline constexpr Tensor<double> simple_shear_flow{0, 0, 1, 0, 0, 0, 0, 0, 0};
inline constexpr Tensor<double> triaxial_compression_flow{0.5, 0, 0, 0, 0.5, 0, 0, 0, -1};
inline constexpr Tensor<double> triaxial_extension_flow{-0.5, 0, 0, 0, -0.5, 0, 0, 0, 1};

/// The void ratio that is critical at |tr sigma| = t in a mode whose stationary density factor is I_star:
/// I_e(e, t) = I_star. At t = 0 it is the threshold above which an undrained test liquefies completely.
inline double critical_void_ratio(const CriticalState& critical, double I_star, double t) {
  const double e_c = critical.e_crt(t);
  return e_c - (I_star - 1) / (critical.a(t) - 1) * (e_c - critical.e_min.value);
}

/// A point of the failure surface on the pi-plane, where the stress can stand still, and the flow there.
struct FailurePoint {
  std::array<double, 3> r;     ///< principal sigma/tr [-]
  std::array<double, 3> flow;  ///< unit principal strain rate, extension positive [-]
  double radius;               ///< |s| [-]
  bool found;                  ///< false: no failure inside the compressive cone at this angle
};

/// Failure surface and flow rule at a Lode angle (0 on the positive axis of the first principal direction; triaxial
/// compression along that direction is at 0, extension at 60 degrees).
///
///     c1 D + c2 (r:D) r = -I_e (c3 r^2 + c4 s^2),  |D| = 1
///
/// Source   Peng et al. (2016), Fig. 1; D by Sherman-Morrison.   Inputs   lode [rad], I_e [-].
template <class Critical, class Form>
FailurePoint failure_point(const Hypoplastic<Critical, Form>& law, double lode, double I_e = 1) {
  const auto at = [&](double radius) {
    FailurePoint p{{}, {}, radius, true};
    std::array<double, 3> nu{};
    double rr = 0, rnu = 0;
    for (int k = 0; k < 3; ++k) {
      const double s = radius * std::sqrt(2.0 / 3) * std::cos(lode - 2 * std::numbers::pi * k / 3);
      const double r = 1.0 / 3 + s;
      p.r[std::size_t(k)] = r;
      nu[std::size_t(k)] = I_e * (law.c3.value * r * r + law.c4.value * s * s);
      rr += r * r;
      rnu += r * nu[std::size_t(k)];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      p.flow[k] = (-nu[k] + law.c2.value * rnu / (law.c1.value + law.c2.value * rr) * p.r[k]) / law.c1.value;
    }
    return p;
  };
  const auto excess = [&](double radius) {
    const auto p = at(radius);
    return p.flow[0] * p.flow[0] + p.flow[1] * p.flow[1] + p.flow[2] * p.flow[2] - 1;
  };
  // the cone ends where the smallest principal value of r vanishes
  double lowest = 1;
  for (int k = 0; k < 3; ++k) lowest = std::fmin(lowest, std::cos(lode - 2 * std::numbers::pi * k / 3));
  double inside = 0, outside = -1.0 / 3 / (std::sqrt(2.0 / 3) * lowest);
  if (!(excess(outside) > 0) || excess(inside) > 0) return {{}, {}, 0, false};
  for (int i = 0; i < 200 && outside - inside > 1e-16; ++i) {
    const double middle = 0.5 * (inside + outside);
    (excess(middle) > 0 ? outside : inside) = middle;
  }
  return at(0.5 * (inside + outside));
}

}  // namespace grainlaw
