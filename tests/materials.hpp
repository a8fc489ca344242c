// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// The printed parameter sets of Peng, Guo, Wu & Wang, Acta Geotechnica 11 (2016) 1231, in SI units, and how the tests
// look at tensors.
#include <random>

#include "rheology/hypoplastic_bagnold.hpp"
#include "rheology/hypoplastic_calibration.hpp"

namespace grainlaw::testing {

struct Set {
  const char* name;
  double c1, c2, c3, c4, e_min, p1, p2, p3, q1, q2, q3;  // p3, q3 in 1/Pa of the full trace
};
inline constexpr Set T1{"T1", -50, -629.6, -629.6, 1220.8, 0.597, 0.53, 0.45, -0.0018e-3, 1.0, -0.4, -0.0001e-3};
inline constexpr Set T2{"T2", -50, -746.6, -746.6, 1855.1, 0.563, 0.65, 0.55, -0.11e-3, 1.0, -0.24, -0.013e-3};
inline constexpr Set T4{"T4", -66.7, -832.9, -832.9, 1594.5, 0.597, 0.53, 0.45, -0.0011e-3, 1.0, -0.4, -0.0001e-3};
/// Sect. 5.2: "all others as in Table 4".
inline constexpr Set PILE{"PILE", -50, -832.1, -832.1, 2369.9, 0.597, 0.53, 0.45, -0.0011e-3, 1.0, -0.4, -0.0001e-3};

template <class Form = StressForm>
Hypoplastic<CriticalState, Form> law_of(const Set& s, double e) {
  return {s.c1, s.c2, s.c3, s.c4, 0, {s.e_min, s.p1, s.p2, s.p3, s.q1, s.q2, s.q3, e}};
}
/// The same coefficients with the density factor frozen.
template <class Form = StressForm>
Hypoplastic<NoCriticalState, Form> frozen(const Set& s, double I_e) {
  return {s.c1, s.c2, I_e * s.c3, I_e * s.c4, 0, {}};
}

/// The velocity gradient of the reference evaluations.
inline constexpr Tensor<double> general_flow{0.3, -0.2, 1.1, 0.4, -0.5, 0.6, -0.7, 0.25, 0.1};

inline double distance(const SymTensor<double>& a, const SymTensor<double>& b) { return norm(a - b) / norm(b); }
inline bool identical(const SymTensor<double>& a, const SymTensor<double>& b) {
  return a.xx == b.xx && a.yy == b.yy && a.zz == b.zz && a.yz == b.yz && a.xz == b.xz && a.xy == b.xy;
}

/// Random numbers that are the same in every run and on every platform.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine(seed) {}
  double operator()(double low, double high) { return low + (high - low) * double(engine()) / 4294967296.0; }
  Tensor<double> tensor() {
    Tensor<double> l{};
    each(l, [&](double& x) { x = (*this)(-1, 1); });
    return l;
  }
  SymTensor<double> symmetric_tensor() { return symmetric(tensor()); }
  Tensor<double> turn() { return rotation(tensor(), (*this)(0, 20)); }
  /// sigma/tr with positive principal values.
  SymTensor<double> compressive() {
    const double a = (*this)(0.01, 1), b = (*this)(0.01, 1), c = (*this)(0.01, 1);
    return rotated<double>({a / (a + b + c), b / (a + b + c), c / (a + b + c), 0, 0, 0}, turn());
  }

 private:
  std::mt19937 engine;
};

}  // namespace grainlaw::testing
