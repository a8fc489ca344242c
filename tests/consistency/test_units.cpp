// SPDX-License-Identifier: BSD-3-Clause
#include "harness.hpp"

using namespace grainlaw;
using namespace grainlaw::consistency;

namespace {

// A state whose numbers are stresses, or that has none, follows the units to the last bit. Any other form goes through
// a logarithm of the stress, whose absolute error is a rounding of ln(|tr|/Pa): about 30 in the ranges used here.
template <class L>
constexpr bool exact = StressInState<L> || count<typename L::template State<double>, double> == 0;
constexpr double logarithm_roundings = 400 * eps;

void check_scaled(bool to_the_bit, double scale, double a, double factor, double b) {
  if (to_the_bit) {
    HOLDS(a * factor == b);
  } else {
    HOLDS(std::fabs(a * factor - b) <= logarithm_roundings * scale * factor);
  }
}
void check_scaled(bool to_the_bit, double scale, const SymTensor<double>& a, double factor,
                  const SymTensor<double>& b) {
  const auto x = numbers<double>(a), y = numbers<double>(b);
  for (std::size_t i = 0; i < x.size(); ++i) check_scaled(to_the_bit, scale, x[i], factor, y[i]);
}

struct Observed {
  std::string name, unit;
  double value;
};
template <class L>
struct Results {
  SymTensor<double> stress, stress_rate, admitted_stress;
  typename L::template State<double> rate;
  unsigned long reasons;
  double wave_speed, viscosity, modulus, stress_size, admitted_size;
  std::vector<Observed> observed;
};
/// Not inlined: two copies of one formula may round differently, when the compiler contracts their sums and products
/// in different ways.
template <class L>
[[gnu::noinline]] Results<L> evaluate(const L& law, const Flow<double>& flow, const SymTensor<double>& sigma,
                                      double density) {
  const auto y = at_rest(law, flow.compaction, sigma);
  const auto a = law.admit(flow, y);
  Results<L> r{law.stress(flow, y),
               stress_rate(law, flow, y),
               law.stress(flow, a.state),
               law.rate(flow, y),
               (unsigned long)a.reasons,
               law.wave_speed(flow, y, density),
               law.viscosity(flow, y),
               stiffness(law, flow, y) * size(flow.L),
               stress_size(law, flow, y),
               stress_size(law, flow, a.state),
               {}};
  law.observe(flow, y, [&](std::string_view name, std::string_view unit, const double& value) {
    r.observed.push_back({std::string(name), std::string(unit), value});
  });
  return r;
}

}  // namespace

// Hard-coded dimensional constants, a wrong unit in a table and a forgotten power all fail here.
TEMPLATE_LIST_TEST_CASE("results do not depend on the choice of units", "[units]", AllLaws) {
  using L = TestType;
  const L law = example_law<L>();
  for (const Units units : {Units{3, 2, -1}, Units{-2, 1, 3}, Units{1, -3, 2}}) {
    L law2 = law;
    visit_parameters(law2, [&](const auto& row, Constant& value) { value.value *= units.factor(row.unit); });
    const double Pa = units.factor("Pa"), per_s = units.factor("1/s");
    Random random(11);
    for (int i = 0; i < 2000; ++i) {
      const Flow<double> flow = random.flow(1e-6, 1e4);
      // one in four is not admissible, so that the return map is scaled as well
      const double fraction = random.below(4) == 0 ? random.uniform(1, 3) : random.uniform(0, 0.95);
      const SymTensor<double> sigma = random.stress(random.decades(1e-9, 1e7), fraction);
      const Results<L> r = evaluate(law, flow, sigma, 1600);
      const Results<L> r2 =
          evaluate(law2, Flow<double>{per_s * flow.L, flow.compaction}, Pa * sigma, 1600 * units.factor("kg/m^3"));
      CAPTURE(L::name, i);
      check_scaled(exact<L>, r.stress_size, r.stress, Pa, r2.stress);
      check_scaled(exact<L>, r.modulus, r.stress_rate, Pa * per_s, r2.stress_rate);
      if constexpr (exact<L>) {
        const auto k = numbers<double>(r.rate), k2 = numbers<double>(r2.rate);
        for (std::size_t c = 0; c < k.size(); ++c) check_scaled(true, 0, k[c], Pa * per_s, k2[c]);
      }
      HOLDS(r.reasons == r2.reasons);
      check_scaled(exact<L>, r.admitted_size, r.admitted_stress, Pa, r2.admitted_stress);
      check_scaled(exact<L>, r.wave_speed, r.wave_speed, units.factor("m/s"), r2.wave_speed);
      check_scaled(exact<L>, r.viscosity, r.viscosity, units.factor("Pa s"), r2.viscosity);
      HOLDS(r.observed.size() == r2.observed.size());
      for (std::size_t k = 0; k < r.observed.size(); ++k) {
        const Observed &o = r.observed[k], &o2 = r2.observed[k];
        CAPTURE(o.name);
        HOLDS(o.name == o2.name);
        const double size = std::fabs(o.value) + (o.unit == "-" ? 1 : 0);
        if (o.name.starts_with("ln_")) {  // the logarithm of a number of pascals
          check_scaled(false, 30, o.value + units.shift_of_ln_Pa(), 1, o2.value);
        } else {
          check_scaled(exact<L>, size, o.value, units.factor(o.unit), o2.value);
        }
      }
    }
  }
}
