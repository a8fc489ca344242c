// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// Tensors as plain numbers, and the conventions of the whole project, which live in this file only:
//
//   stress sigma       tension positive [Pa]          component order   xx yy zz yz xz xy
//   pressure p         -tr(sigma)/3, compression positive [Pa]
//   velocity gradient  L_ij = dv_i/dx_j [1/s],  D = sym L (extension positive),  W = skew L
//   shear rate         gamma_dot = sqrt(2 D':D') [1/s]
//   plane problems     the x-z plane, z up; sigma_yy is a real component
//   Jaumann rate       d(sigma)/dt = (objective rate) + W sigma - sigma W
#include "real.hpp"

namespace grainlaw {

template <class R>
struct SymTensor {
  R xx, yy, zz, yz, xz, xy;
  friend constexpr SymTensor operator+(const SymTensor& a, const SymTensor& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.yz + b.yz, a.xz + b.xz, a.xy + b.xy};
  }
  friend constexpr SymTensor operator-(const SymTensor& a, const SymTensor& b) {
    return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.yz - b.yz, a.xz - b.xz, a.xy - b.xy};
  }
  friend constexpr SymTensor operator*(const R& k, const SymTensor& a) {
    return {k * a.xx, k * a.yy, k * a.zz, k * a.yz, k * a.xz, k * a.xy};
  }
  friend constexpr SymTensor operator*(Constant k, const SymTensor& a) { return k.as<R>() * a; }
};

template <class R>
struct Tensor {
  R xx, xy, xz, yx, yy, yz, zx, zy, zz;
  friend constexpr Tensor operator+(const Tensor& a, const Tensor& b) {
    return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yx + b.yx, a.yy + b.yy,
            a.yz + b.yz, a.zx + b.zx, a.zy + b.zy, a.zz + b.zz};
  }
  friend constexpr Tensor operator*(const R& k, const Tensor& a) {
    return {k * a.xx, k * a.xy, k * a.xz, k * a.yx, k * a.yy, k * a.yz, k * a.zx, k * a.zy, k * a.zz};
  }
};

/// Calls f on every number of a tensor in column order: how a host loads and stores one.
template <class R, class F>
constexpr void each(SymTensor<R>& a, F&& f) {
  f(a.xx), f(a.yy), f(a.zz), f(a.yz), f(a.xz), f(a.xy);
}
template <class R, class F>
constexpr void each(const Tensor<R>& a, F&& f) {
  f(a.xx), f(a.xy), f(a.xz), f(a.yx), f(a.yy), f(a.yz), f(a.zx), f(a.zy), f(a.zz);
}
template <class R, class F>
constexpr void each(Tensor<R>& a, F&& f) {
  f(a.xx), f(a.xy), f(a.xz), f(a.yx), f(a.yy), f(a.yz), f(a.zx), f(a.zy), f(a.zz);
}

/// Sum of the sizes of the components: finite exactly when every one is.
template <class R>
constexpr R size_of(const SymTensor<R>& a) {
  return real::abs(a.xx) + real::abs(a.yy) + real::abs(a.zz) + real::abs(a.yz) + real::abs(a.xz) + real::abs(a.xy);
}
template <class R>
constexpr R size_of(const Tensor<R>& a) {
  R sum(0);
  each(a, [&](const R& x) { sum = sum + real::abs(x); });
  return sum;
}
template <class R>
constexpr R trace(const SymTensor<R>& a) {
  return a.xx + a.yy + a.zz;
}
template <class R>
constexpr R trace(const Tensor<R>& a) {
  return a.xx + a.yy + a.zz;
}
/// A : B
template <class R>
constexpr R contract(const SymTensor<R>& a, const SymTensor<R>& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + Constant(2) * (a.yz * b.yz + a.xz * b.xz + a.xy * b.xy);
}
/// sqrt(A : A)
template <class R>
constexpr R norm(const SymTensor<R>& a) {
  return real::sqrt(contract(a, a));
}
template <class R>
constexpr SymTensor<R> isotropic(const R& k) {
  return {k, k, k, R(0), R(0), R(0)};
}
/// A + k I
template <class R>
constexpr SymTensor<R> plus_isotropic(const SymTensor<R>& a, const R& k) {
  return {a.xx + k, a.yy + k, a.zz + k, a.yz, a.xz, a.xy};
}
template <class R>
constexpr SymTensor<R> deviator(const SymTensor<R>& a) {
  return plus_isotropic<R>(a, trace(a) * Constant(-1.0 / 3));
}
/// A A
template <class R>
constexpr SymTensor<R> square(const SymTensor<R>& a) {
  return {a.xx * a.xx + a.xy * a.xy + a.xz * a.xz, a.xy * a.xy + a.yy * a.yy + a.yz * a.yz,
          a.xz * a.xz + a.yz * a.yz + a.zz * a.zz, a.xy * a.xz + a.yy * a.yz + a.yz * a.zz,
          a.xx * a.xz + a.xy * a.yz + a.xz * a.zz, a.xx * a.xy + a.xy * a.yy + a.xz * a.yz};
}
template <class R>
constexpr R determinant(const SymTensor<R>& a) {
  return a.xx * (a.yy * a.zz - a.yz * a.yz) - a.xy * (a.xy * a.zz - a.yz * a.xz) + a.xz * (a.xy * a.yz - a.yy * a.xz);
}
/// D = (L + L^T)/2
template <class R>
constexpr SymTensor<R> symmetric(const Tensor<R>& l) {
  const Constant half(0.5);
  return {l.xx, l.yy, l.zz, half * (l.yz + l.zy), half * (l.xz + l.zx), half * (l.xy + l.yx)};
}
template <class R>
constexpr SymTensor<R> choose(const mask_t<R>& m, const SymTensor<R>& a, const SymTensor<R>& b) {
  return {real::select<R>(m, a.xx, b.xx), real::select<R>(m, a.yy, b.yy), real::select<R>(m, a.zz, b.zz),
          real::select<R>(m, a.yz, b.yz), real::select<R>(m, a.xz, b.xz), real::select<R>(m, a.xy, b.xy)};
}
/// W A - A W, the part of dA/dt that a rigid rotation makes (Jaumann).
template <class R>
constexpr SymTensor<R> spin_rate(const Tensor<R>& l, const SymTensor<R>& a) {
  const Constant half(0.5), two(2);
  const R yz = half * (l.yz - l.zy), xz = half * (l.xz - l.zx), xy = half * (l.xy - l.yx);
  return {two * (xy * a.xy + xz * a.xz),
          two * (yz * a.yz - xy * a.xy),
          -(two * (xz * a.xz + yz * a.yz)),
          yz * (a.zz - a.yy) - xy * a.xz - xz * a.xy,
          xz * (a.zz - a.xx) + xy * a.yz - yz * a.xy,
          xy * (a.yy - a.xx) + xz * a.yz + yz * a.xz};
}

/// p = -tr(sigma)/3, compression positive [Pa].
template <class R>
constexpr R pressure(const SymTensor<R>& sigma) {
  return trace(sigma) * Constant(-1.0 / 3);
}
/// J2 = s:s/2 of the deviator s.
template <class R>
constexpr R second_invariant(const SymTensor<R>& a) {
  const SymTensor<R> s = deviator(a);
  return Constant(0.5) * contract(s, s);
}
/// q = sqrt(3 J2) [Pa], the triaxial stress difference without its sign.
template <class R>
constexpr R von_mises(const SymTensor<R>& sigma) {
  return real::sqrt(Constant(3) * second_invariant(sigma));
}
/// gamma_dot = sqrt(2 D':D') [1/s].
template <class R>
constexpr R shear_rate(const SymTensor<R>& d) {
  return Constant(2) * real::sqrt(second_invariant(d));
}

/// Largest eigenvalue of a traceless symmetric tensor from its invariants J2, J3: the largest root of
/// x^3 - J2 x - J3, by Newton from above, where it converges monotonically.
template <Real R>
constexpr R largest_of_deviator(const R& J2, const R& J3) {
  // the root of round-off: below it the slope says nothing
  constexpr auto near_double = sizeof(scalar_t<R>) == 8 ? scalar_t<R>(1e-7) : scalar_t<R>(1e-3f);
  const R safe_J2 = real::at_least<R>(J2, real::tiny<R>());
  const R lowest = real::sqrt(Constant(1.0 / 3) * safe_J2);  // the root itself where it is double; never above it
  R x = Constant(2) * lowest;                                // never below the root
  for (int i = 0; i < 40; ++i) {
    const R slope = real::at_least<R>(Constant(3) * x * x - safe_J2, R(near_double) * safe_J2);
    // at a double root value and slope are both round-off: the bound catches what their quotient throws out
    x = real::at_least<R>(x - (x * (x * x - safe_J2) - J3) / slope, lowest);
  }
  return x;
}

/// Q = exp(W dt), the finite rotation of a constant spin (Rodrigues).
inline Tensor<double> rotation(const Tensor<double>& l, double dt) {
  const double x = 0.5 * (l.zy - l.yz) * dt, y = 0.5 * (l.xz - l.zx) * dt, z = 0.5 * (l.yx - l.xy) * dt;
  const double angle2 = x * x + y * y + z * z, angle = std::sqrt(angle2);
  const double half = angle < 1e-4 ? 0.5 * (1 - angle2 / 24) : std::sin(0.5 * angle) / angle;
  const double s = angle < 1e-4 ? 1 - angle2 / 6 : std::sin(angle) / angle;
  const double c = 2 * half * half;  // (1 - cos angle)/angle^2 without cancellation
  return {1 - c * (y * y + z * z), c * x * y - s * z,       c * x * z + s * y,
          c * x * y + s * z,       1 - c * (x * x + z * z), c * y * z - s * x,
          c * x * z - s * y,       c * y * z + s * x,       1 - c * (x * x + y * y)};
}
/// Q A Q^T
template <class R>
constexpr SymTensor<R> rotated(const SymTensor<R>& a, const Tensor<R>& q) {
  const R xx = q.xx * a.xx + q.xy * a.xy + q.xz * a.xz, xy = q.xx * a.xy + q.xy * a.yy + q.xz * a.yz,
          xz = q.xx * a.xz + q.xy * a.yz + q.xz * a.zz, yx = q.yx * a.xx + q.yy * a.xy + q.yz * a.xz,
          yy = q.yx * a.xy + q.yy * a.yy + q.yz * a.yz, yz = q.yx * a.xz + q.yy * a.yz + q.yz * a.zz,
          zx = q.zx * a.xx + q.zy * a.xy + q.zz * a.xz, zy = q.zx * a.xy + q.zy * a.yy + q.zz * a.yz,
          zz = q.zx * a.xz + q.zy * a.yz + q.zz * a.zz;
  return {xx * q.xx + xy * q.xy + xz * q.xz, yx * q.yx + yy * q.yy + yz * q.yz, zx * q.zx + zy * q.zy + zz * q.zz,
          yx * q.zx + yy * q.zy + yz * q.zz, xx * q.zx + xy * q.zy + xz * q.zz, xx * q.yx + xy * q.yy + xz * q.yz};
}

}  // namespace grainlaw
