// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// The arithmetic a law may use. `Real` is double, float or a pack of them: a formula is written once.
// Everything is constexpr, so that a device compiler can call it without annotations.
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace grainlaw {

template <class R>
struct RealTraits;

template <class T, class B>
struct ScalarTraits {
  using Scalar = T;
  using Bits = B;
  using Mask = bool;
  static constexpr int lanes = 1;
  static constexpr T sqrt(T x) { return std::sqrt(x); }
  static constexpr T log(T x) { return std::log(x); }
  static constexpr T abs(T x) { return std::bit_cast<T>(std::bit_cast<B>(x) & (B(-1) >> 1)); }
  static constexpr T select(bool m, T a, T b) { return m ? a : b; }
  static constexpr bool any(bool m) { return m; }
  static constexpr B flag(bool m, B bit) { return m ? bit : B(0); }
};
template <>
struct RealTraits<double> : ScalarTraits<double, std::uint64_t> {};
template <>
struct RealTraits<float> : ScalarTraits<float, std::uint32_t> {};

template <class R>
concept Real = requires {
  RealTraits<R>::lanes;
};

template <class R>
using scalar_t = typename RealTraits<R>::Scalar;
template <class R>
using bits_t = typename RealTraits<R>::Bits;
template <class R>
using mask_t = typename RealTraits<R>::Mask;

/// A number of a formula or of a material, in the precision of whatever it meets: float is never promoted silently.
struct Constant {
  double value;
  constexpr Constant(double v = 0) : value(v) {}
  template <Real R>
  constexpr R as() const {
    return R(static_cast<scalar_t<R>>(value));
  }
  template <Real R>
  friend constexpr R operator+(Constant a, const R& b) {
    return a.as<R>() + b;
  }
  template <Real R>
  friend constexpr R operator+(const R& a, Constant b) {
    return a + b.as<R>();
  }
  template <Real R>
  friend constexpr R operator-(Constant a, const R& b) {
    return a.as<R>() - b;
  }
  template <Real R>
  friend constexpr R operator-(const R& a, Constant b) {
    return a - b.as<R>();
  }
  template <Real R>
  friend constexpr R operator*(Constant a, const R& b) {
    return a.as<R>() * b;
  }
  template <Real R>
  friend constexpr R operator*(const R& a, Constant b) {
    return a * b.as<R>();
  }
  template <Real R>
  friend constexpr R operator/(Constant a, const R& b) {
    return a.as<R>() / b;
  }
  template <Real R>
  friend constexpr R operator/(const R& a, Constant b) {
    return a / b.as<R>();
  }
};

/// Primitives live in RealTraits and are called qualified, so that no argument-dependent lookup interferes.
namespace real {

template <Real R>
constexpr R sqrt(const R& x) {
  return RealTraits<R>::sqrt(x);
}
/// Natural logarithm; not meant for hot loops (lane by lane in packs).
template <Real R>
constexpr R log(const R& x) {
  return RealTraits<R>::log(x);
}
template <Real R>
constexpr R select(const mask_t<R>& m, const std::type_identity_t<R>& a, const std::type_identity_t<R>& b) {
  return RealTraits<R>::select(m, a, b);
}
template <Real R>
constexpr bool any(const mask_t<R>& m) {
  return RealTraits<R>::any(m);
}
/// The bit where the mask is set, 0 elsewhere.
template <Real R>
constexpr bits_t<R> flag(const mask_t<R>& m, unsigned bit) {
  return RealTraits<R>::flag(m, bit);
}

// x comes first in the comparison: a NaN in x survives and is never laundered into the bound.
template <Real R>
constexpr R at_least(const R& x, const std::type_identity_t<R>& bound) {
  return select<R>(x < bound, bound, x);
}
template <Real R>
constexpr R at_most(const R& x, const std::type_identity_t<R>& bound) {
  return select<R>(bound < x, bound, x);
}
template <Real R>
constexpr R abs(const R& x) {
  return RealTraits<R>::abs(x);
}

/// Neither NaN nor infinite.
template <Real R>
constexpr mask_t<R> is_finite(const R& x) {
  return abs(x) <= R(std::numeric_limits<scalar_t<R>>::max());
}

/// Largest stress whose cube, and largest rate whose square times a stress, stay finite: `admit` flags what is beyond.
template <Real R>
constexpr R largest_stress() {
  return R(sizeof(scalar_t<R>) == 8 ? scalar_t<R>(1e100) : scalar_t<R>(1e12f));
}
template <Real R>
constexpr R largest_rate() {
  return R(sizeof(scalar_t<R>) == 8 ? scalar_t<R>(1e145) : scalar_t<R>(1e18f));
}
/// Smallest magnitude by which a law divides: below it the reciprocal would overflow.
template <Real R>
constexpr R tiny() {
  return R(sizeof(scalar_t<R>) == 8 ? scalar_t<R>(1e-290) : scalar_t<R>(1e-32f));
}

/// exp(x) without a branch or a call: x = n ln 2 + r with |r| <= ln(2)/2, a polynomial in r, and n added to the
/// exponent bits. About 1 ulp; clamped to the normal range, so 0 and infinity are never returned; NaN gives NaN.
template <Real R>
constexpr R exp(const R& argument) {
  using B = bits_t<R>;
  using T = scalar_t<R>;
  if constexpr (sizeof(T) == 8) {
    const R x = at_most<R>(at_least<R>(argument, R(-708.0)), R(709.0));
    const R shifted = x * R(0x1.71547652b82fep0) + R(0x1.8p52);  // n sits in the low bits of the sum
    const R n = shifted - R(0x1.8p52);
    const R r = (x - n * R(0x1.62e42fefa38p-1)) - n * R(0x1.ef35793c7673p-45);
    const R r2 = r * r;
    // exp(r) = 1 + r + r^2 (even + r odd), minimax on |r| <= ln(2)/2
    const R even =
        R(0.50000000000000011) +
        r2 * (R(0.041666666666624129) +
              r2 * (R(0.0013888888917213717) + r2 * (R(2.4801521295954376e-05) + r2 * R(2.7620088445409746e-07))));
    const R odd =
        R(0.16666666666666669) +
        r2 * (R(0.0083333333333300615) +
              r2 * (R(0.00019841269863053618) + r2 * (R(2.7557268459997064e-06) + r2 * R(2.510038549551032e-08))));
    const R y = R(1) + (r + r2 * (even + r * odd));
    return std::bit_cast<R>(std::bit_cast<B>(y) + (std::bit_cast<B>(shifted) << 52));
  } else {
    const R x = at_most<R>(at_least<R>(argument, R(-87.0f)), R(88.0f));
    const R shifted = x * R(0x1.715476p0f) + R(0x1.8p23f);
    const R n = shifted - R(0x1.8p23f);
    const R r = (x - n * R(0x1.62e4p-1f)) - n * R(0x1.7f7d1cp-20f);
    const R q = R(0.5f) + r * (R(0.16666577f) + r * (R(0.041666555f) + r * (R(0.0083631791f) + r * R(0.0013926184f))));
    const R y = R(1) + (r + r * r * q);
    return std::bit_cast<R>(std::bit_cast<B>(y) + (std::bit_cast<B>(shifted) << 23));
  }
}

}  // namespace real
}  // namespace grainlaw
