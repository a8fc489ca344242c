// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// A number that carries its derivative. A law is written for any Real, so this one differentiates it exactly.
#include "rheology/law.hpp"

namespace grainlaw::consistency {

struct Dual {
  double v, d;
  Dual() = default;
  constexpr Dual(double value) : v(value), d(0) {}
  constexpr Dual(double value, double derivative) : v(value), d(derivative) {}
  friend constexpr Dual operator-(Dual a) { return {-a.v, -a.d}; }
  friend constexpr Dual operator+(Dual a, Dual b) { return {a.v + b.v, a.d + b.d}; }
  friend constexpr Dual operator-(Dual a, Dual b) { return {a.v - b.v, a.d - b.d}; }
  friend constexpr Dual operator*(Dual a, Dual b) { return {a.v * b.v, a.v * b.d + a.d * b.v}; }
  friend constexpr Dual operator/(Dual a, Dual b) { return {a.v / b.v, (a.d - a.v / b.v * b.d) / b.v}; }
  friend constexpr bool operator<(Dual a, Dual b) { return a.v < b.v; }
  friend constexpr bool operator>(Dual a, Dual b) { return a.v > b.v; }
  friend constexpr bool operator<=(Dual a, Dual b) { return a.v <= b.v; }
  friend constexpr bool operator>=(Dual a, Dual b) { return a.v >= b.v; }
  friend constexpr bool operator==(Dual a, Dual b) { return a.v == b.v; }
  friend constexpr bool operator!=(Dual a, Dual b) { return a.v != b.v; }
};

}  // namespace grainlaw::consistency

namespace grainlaw {

template <>
struct RealTraits<consistency::Dual> {
  using Scalar = double;
  using Bits = std::uint64_t;
  using Mask = bool;
  using R = consistency::Dual;
  static constexpr int lanes = 1;
  static R sqrt(R x) {
    const double root = std::sqrt(x.v);
    return {root, x.d == 0 ? 0 : x.d / (2 * root)};  // sqrt(0) that does not move has no slope
  }
  static R log(R x) { return {std::log(x.v), x.d / x.v}; }
  static constexpr R abs(R x) { return x.v < 0 ? -x : x; }
  static constexpr R select(bool m, R a, R b) { return m ? a : b; }
  static constexpr bool any(bool m) { return m; }
  static constexpr Bits flag(bool m, unsigned bit) { return m ? bit : 0; }
};

namespace real {
// the library's exp works on the bits of a number, which a Dual does not have
template <>
constexpr consistency::Dual exp<consistency::Dual>(const consistency::Dual& x) {
  const double y = exp<double>(x.v);
  return {y, y * x.d};
}
}  // namespace real

namespace consistency {

inline Flow<Dual> dual(const Flow<double>& f, const Flow<double>& df) {
  const Tensor<double>&a = f.L, &b = df.L;
  return {{{a.xx, b.xx},
           {a.xy, b.xy},
           {a.xz, b.xz},
           {a.yx, b.yx},
           {a.yy, b.yy},
           {a.yz, b.yz},
           {a.zx, b.zx},
           {a.zy, b.zy},
           {a.zz, b.zz}},
          {f.compaction, df.compaction}};
}

}  // namespace consistency
}  // namespace grainlaw
