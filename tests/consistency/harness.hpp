// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// What the tests of this folder share: the list of laws, random inputs, exact derivatives, units.
#include <catch2/catch.hpp>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "dual.hpp"
#include "examples.hpp"

/// REQUIRE for the inside of long loops: Catch2 is asked only when it fails.
#define HOLDS(...) \
  if (!(__VA_ARGS__)) REQUIRE(__VA_ARGS__)

namespace grainlaw::consistency {

template <class Recipes>
struct FormsOf;
template <class... R>
struct FormsOf<std::tuple<R...>> {
  using type = decltype(std::tuple_cat(std::declval<typename R::Forms>()...));
};
using RecipeForms = typename FormsOf<Recipes>::type;
/// Every law in every state form, and the variants.
using AllLaws = decltype(std::tuple_cat(std::declval<RecipeForms>(), std::declval<Variants>()));

/// Failures are printed to the last bit.
inline const bool all_digits = (Catch::StringMaker<double>::precision = 17, true);

inline constexpr double eps = std::numeric_limits<double>::epsilon();

template <class L>
constexpr const Claims& claims_of() {
  static_assert(std::is_same_v<std::remove_cv_t<decltype(claims<L>)>, Claims>,
                "tests/consistency/examples.hpp must say what this new law claims: specialise claims<Law>");
  return claims<L>;
}

/// A law with the parameters of examples.hpp.
template <class L>
L example_law() {
  L law{};
  visit_parameters(law, []<class Owner>(const Parameter<Owner>& row, Constant& value) {
    static_assert(!std::is_same_v<std::remove_cv_t<decltype(example_values<Owner>)>, int>,
                  "tests/consistency/examples.hpp must give values for this new law: specialise example_values<Law>");
    bool given = false;
    if constexpr (!std::is_same_v<std::remove_cv_t<decltype(example_values<Owner>)>, int>) {
      for (const Value& v : example_values<Owner>) {
        if (v.name == row.name) value = v.value, given = true;
      }
    }
    if (!given) FAIL("examples.hpp gives no value for the parameter " << row.name);
  });
  set_void_ratio(law, example_void_ratio);
  return law;
}

// ---- states and tensors as arrays -----------------------------------------------------------------------------------

template <class R, class X>
constexpr int size_of = count<X, R>;

template <class R, class X>
auto numbers(const X& x) {
  std::array<R, std::size_t(count<X, R>)> a{};
  if constexpr (count < X, R >> 0) std::memcpy(a.data(), &x, sizeof x);
  return a;
}
template <class X, class R, std::size_t n>
X from_numbers(const std::array<R, n>& a) {
  X x{};
  if constexpr (n > 0) std::memcpy(&x, a.data(), sizeof x);
  return x;
}
template <class X>
bool same_bits(const X& a, const X& b) {
  return std::is_empty_v<X> || std::memcmp(&a, &b, sizeof a) == 0;
}
template <class R, class X>
bool finite(const X& x) {
  for (R v : numbers<R>(x)) {
    if (!std::isfinite(v)) return false;
  }
  return true;
}
/// -0 == 0, and every other number by its value.
template <class R, class X>
bool equal(const X& a, const X& b) {
  return numbers<R>(a) == numbers<R>(b);
}
template <class R, class X>
double largest(const X& x) {
  double m = 0;
  for (R v : numbers<R>(x)) m = std::fmax(m, std::fabs(double(v)));
  return m;
}
template <class R, class X>
double distance(const X& a, const X& b) {
  const auto x = numbers<R>(a), y = numbers<R>(b);
  double m = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double d = std::fabs(double(x[i]) - double(y[i]));
    if (!(d <= m)) m = d;  // NaN stays
  }
  return m;
}
template <class R>
Flow<R> flow_in(const Flow<double>& f) {
  const auto l = numbers<double>(f.L);
  std::array<R, 9> a;
  for (std::size_t i = 0; i < 9; ++i) a[i] = R(l[i]);
  return {from_numbers<Tensor<R>>(a), R(f.compaction)};
}
template <class R>
SymTensor<R> sym_in(const SymTensor<double>& s) {
  return {R(s.xx), R(s.yy), R(s.zz), R(s.yz), R(s.xz), R(s.xy)};
}
inline double size(const Tensor<double>& l) { return largest<double>(l); }
inline double size(const SymTensor<double>& s) { return largest<double>(s); }

// ---- random inputs --------------------------------------------------------------------------------------------------

/// Random inputs that are the same everywhere: the engine is fixed by the standard, the distributions are not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double a, double b) { return a + (b - a) * (double(engine_() >> 11) * 0x1p-53); }
  double decades(double a, double b) { return std::pow(10.0, uniform(std::log10(a), std::log10(b))); }
  int below(int n) { return int(engine_() % std::uint64_t(n)); }

  Tensor<double> tensor(double scale) {
    std::array<double, 9> a;
    for (double& x : a) x = scale * uniform(-1, 1);
    return from_numbers<Tensor<double>>(a);
  }
  double compaction() { return uniform(smallest_compaction, largest_compaction); }
  /// Flows of every kind and of rates between the two: general, isochoric, volumetric, simple shear, rigid rotation.
  Flow<double> flow(double slowest, double fastest) {
    const double g = decades(slowest, fastest);
    Tensor<double> l = tensor(g);
    switch (below(8)) {
      case 0: {
        const double k = trace(l) / 3;
        l.xx -= k, l.yy -= k, l.zz -= k;
        break;
      }
      case 1:
        l = {l.xx, 0, 0, 0, l.xx, 0, 0, 0, l.xx};
        break;
      case 2:
        l = {0, 0, l.xz, 0, 0, 0, 0, 0, 0};
        break;
      case 3:
        l = {0, l.xy, l.xz, -l.xy, 0, l.yz, -l.xz, -l.yz, 0};
        break;
      default:
        break;
    }
    return {l, compaction()};
  }
  /// A compressive stress at pressure p whose deviator is that fraction of the way to the edge of the cone.
  SymTensor<double> stress(double p, double fraction) {
    const Tensor<double> a = tensor(1);
    const SymTensor<double> s = deviator(symmetric(a));
    Eigen3Values e(s);
    return plus_isotropic((fraction * p / e.largest) * s, -p);
  }
  SymTensor<double> stress(double p) { return stress(p, below(10) == 0 ? 0.0 : uniform(0, 0.95)); }

 private:
  /// Largest principal value, by the trigonometric formula: independent of the library's Newton.
  struct Eigen3Values {
    double largest;
    explicit Eigen3Values(const SymTensor<double>& s) {
      const double J2 = second_invariant(s), r = std::sqrt(J2 / 3);
      const double c = std::fmax(-1.0, std::fmin(1.0, determinant(s) / (2 * r * r * r)));
      largest = 2 * r * std::cos(std::acos(c) / 3);
    }
  };
  std::mt19937_64 engine_;
};

/// The state with the stress sigma where nothing moves.
template <class L>
auto at_rest(const L& law, double compaction, const SymTensor<double>& sigma) {
  return law.start(Flow<double>{{}, compaction}, sigma);
}

// ---- derivatives ----------------------------------------------------------------------------------------------------

/// d(stress) along a change of L, compaction and state, exactly.
template <class L>
SymTensor<double> stress_change(const L& law, const Flow<double>& flow, const Flow<double>& dflow,
                                const typename L::template State<double>& y,
                                const typename L::template State<double>& dy) {
  using State = typename L::template State<Dual>;
  const auto v = numbers<double>(y), d = numbers<double>(dy);
  std::array<Dual, std::tuple_size_v<std::remove_const_t<decltype(v)>>> a;
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = Dual{v[i], d[i]};
  const SymTensor<Dual> s = law.stress(dual(flow, dflow), from_numbers<State>(a));
  return {s.xx.d, s.yy.d, s.zz.d, s.yz.d, s.xz.d, s.xy.d};
}
/// d(stress)/dt at constant L and density: what the state does, whatever form it has.
template <class L>
SymTensor<double> stress_rate(const L& law, const Flow<double>& flow, const typename L::template State<double>& y) {
  return stress_change(law, flow, Flow<double>{{}, 0}, y, law.rate(flow, y));
}
/// The change of d(stress)/dt with L along M: the tangent at the loading direction flow.L, density included.
template <class L>
SymTensor<double> tangent(const L& law, const Flow<double>& flow, const typename L::template State<double>& y,
                          const Tensor<double>& M) {
  using State = typename L::template State<Dual>;
  const auto v = numbers<double>(y);
  std::array<Dual, std::tuple_size_v<std::remove_const_t<decltype(v)>>> a;
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = Dual{v[i], 0};
  const State k = law.rate(dual(flow, Flow<double>{M, 0}), from_numbers<State>(a));
  const auto kd = numbers<Dual>(k);
  std::array<double, std::tuple_size_v<std::remove_const_t<decltype(v)>>> dk{};
  for (std::size_t i = 0; i < dk.size(); ++i) dk[i] = kd[i].d;
  return stress_change(law, flow, Flow<double>{{}, -(1 + flow.compaction) * trace(M)}, y,
                       from_numbers<typename L::template State<double>>(dk));
}

/// A stiffness [Pa] to measure rounding errors against: rho c^2 bounds every modulus of the law.
template <class L>
double stiffness(const L& law, const Flow<double>& flow, const typename L::template State<double>& y) {
  const double c = law.wave_speed(flow, y, 1.0);
  return c * c + size(law.stress(flow, y));
}
/// A stress [Pa] to measure rounding errors against: a rounding of L may look like a shear where there is none.
template <class L>
double stress_size(const L& law, const Flow<double>& flow, const typename L::template State<double>& y) {
  const double g = size(flow.L);
  const Flow<double> sheared{{0, 0, g, 0, 0, 0, 0, 0, 0}, flow.compaction};
  return size(law.stress(flow, y)) + (law.viscosity(flow, y) + law.viscosity(sheared, y)) * g;
}

// ---- units ----------------------------------------------------------------------------------------------------------

/// New units of mass, length and time, as powers of four: every product, quotient and square root stays exact.
struct Units {
  int mass, length, time;
  /// The power of four by which a number in that unit changes; fails for a unit that is not understood.
  int power(std::string_view unit) const {
    int total = 0, sign = 1;
    std::string word;
    const auto flush = [&] {
      if (!word.empty()) total += sign * one(word);
      word.clear();
    };
    for (char c : unit) {
      if (c == ' ') {
        flush();
      } else if (c == '/') {
        flush();
        sign = -1;
      } else {
        word += c;
      }
    }
    flush();
    return total;
  }
  double factor(std::string_view unit) const { return std::ldexp(1.0, 2 * power(unit)); }
  /// A quantity ln(x/Pa) moves instead of being scaled.
  double shift_of_ln_Pa() const { return 2 * power("Pa") * std::log(2.0); }

 private:
  int one(std::string word) const {
    int exponent = 1;
    if (const auto hat = word.find('^'); hat != std::string::npos) {
      exponent = std::stoi(word.substr(hat + 1));
      word.resize(hat);
    }
    const int pressure = mass - length - 2 * time, energy = mass + 2 * length - 2 * time;
    if (word == "-" || word == "1" || word == "rad") return 0;
    if (word == "kg") return exponent * mass;
    if (word == "m") return exponent * length;
    if (word == "s") return exponent * time;
    if (word == "Pa") return exponent * pressure;
    if (word == "J") return exponent * energy;
    if (word == "W") return exponent * (energy - time);
    FAIL("the unit '" << word << "' is not known to tests/consistency/harness.hpp");
    return 0;
  }
};

}  // namespace grainlaw::consistency
