// SPDX-License-Identifier: BSD-3-Clause
#include "harness.hpp"
#include "rheology/advance.hpp"

using namespace grainlaw;
using namespace grainlaw::consistency;

namespace {

Tensor<double> isochoric(Tensor<double> l) {
  const double k = trace(l) / 3;
  l.xx -= k, l.yy -= k, l.zz -= k;
  return l;
}
template <class L>
SymTensor<double> viscous_stress(const L& law, const Flow<double>& flow, const typename L::template State<double>& y) {
  return law.stress(flow, y) - law.stress(Flow<double>{{}, flow.compaction}, y);
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("the rate has the degree in the velocity gradient that the law claims", "[homogeneity]",
                        AllLaws) {
  const auto law = example_law<TestType>();
  const Claims& claim = claims_of<TestType>();
  Random random(31);
  for (int i = 0; i < 2000; ++i) {
    const Flow<double> flow = random.flow(1e-6, 1e3);
    const auto y = at_rest(law, flow.compaction, random.stress(random.decades(1e-2, 1e7)));
    const double k = random.decades(1e-3, 1e3);
    const Flow<double> faster{k * flow.L, flow.compaction};
    CAPTURE(i, k);
    if (claim.rate_independent) {
      // a dozen roundings of terms of the size of the stiffness
      const double tolerance = 100 * eps * stiffness(law, flow, y) * size(flow.L) * k;
      const double d = distance<double>(stress_rate(law, faster, y), k * stress_rate(law, flow, y));
      HOLDS(d <= tolerance);
    }
    if (!std::isnan(claim.degree_in_L)) {
      const SymTensor<double> slow = viscous_stress(law, flow, y), fast = viscous_stress(law, faster, y);
      const double power = std::pow(k, claim.degree_in_L);
      // the carried stress is subtracted from the whole, which costs its roundings
      const double tolerance = 100 * eps * (stress_size(law, flow, y) * power + stress_size(law, faster, y));
      const double d = distance<double>(fast, power * slow);
      HOLDS(d <= tolerance);
      HOLDS((claim.degree_in_L != 0 || size(slow) == 0.0));
    }
  }
}

TEMPLATE_LIST_TEST_CASE("the rate at a frozen density factor is proportional to the stress", "[homogeneity]", AllLaws) {
  auto law = example_law<TestType>();
  if (!claims_of<TestType>().homogeneous_in_stress) return;
  // without their decay with the pressure the critical curves are constants, and so is the density factor
  visit_parameters(law, [](const auto& row, Constant& value) {
    if (row.unit == "1/Pa") value = 0;
  });
  Random random(32);
  for (int i = 0; i < 2000; ++i) {
    const Flow<double> flow = random.flow(1e-6, 1e3);
    const SymTensor<double> sigma = random.stress(random.decades(1e-2, 1e6));
    const double k = random.decades(1e-3, 1e3);
    const auto y = at_rest(law, flow.compaction, sigma), y2 = at_rest(law, flow.compaction, k * sigma);
    const double tolerance = 100 * eps * (k * stiffness(law, flow, y) + stiffness(law, flow, y2)) * size(flow.L);
    const double d = distance<double>(stress_rate(law, flow, y2), k * stress_rate(law, flow, y));
    CAPTURE(i, k);
    HOLDS(d <= tolerance);
  }
}

TEMPLATE_LIST_TEST_CASE("the rate-dependent stress takes up work in every isochoric flow", "[dissipation]", AllLaws) {
  const auto law = example_law<TestType>();
  Random random(33);
  for (int i = 0; i < 5000; ++i) {
    Flow<double> flow = random.flow(1e-3, 1e4);
    const double before = size(flow.L);
    flow.L = isochoric(flow.L);
    const auto y = at_rest(law, flow.compaction, random.stress(random.decades(1, 1e6)));
    const double power = contract(viscous_stress(law, flow, y), symmetric(flow.L));
    // the carried stress is subtracted from the whole, which costs its roundings
    const double tolerance = 100 * eps * stress_size(law, flow, y) * size(flow.L);
    HOLDS(power >= -tolerance);
    // a rotation, or what rounding left of an expansion, is no shear
    const bool rests = size(symmetric(flow.L)) < 1e-9 * before || claims_of<TestType>().degree_in_L == 0 ||
                       law.viscosity(flow, y) * size(flow.L) <= 1e-9 * size(law.stress(flow, y));
    HOLDS((rests || power > 0));
  }
}

TEMPLATE_LIST_TEST_CASE("steady flow takes up work", "[dissipation]", AllLaws) {
  const auto law = example_law<TestType>();
  if (!claims_of<TestType>().flows) return;
  Random random(34);
  int steady = 0;
  for (int i = 0; i < 40; ++i) {
    Tensor<double> l = isochoric(random.tensor(1));
    if (i % 4 == 0) l = {0, 0, 1, 0, 0, 0, 0, 0, 0};
    // a dense packing, since a loose one liquefies and then has no stress to speak of
    const Flow<double> flow{l, largest_compaction};
    const auto y0 = at_rest(law, flow.compaction, random.stress(1e4, 0.5));
    const double strain = 1 / shear_rate(symmetric(l));  // directions are forgotten over a strain of 0.1
    const auto end = advance(law, flow, flow, y0, strain, 1e-8);
    CAPTURE(i);
    REQUIRE((end.reasons & (not_finite | too_many_steps)) == 0);
    const SymTensor<double> sigma = law.stress(flow, end.state);
    const double power = contract(sigma, symmetric(l));
    // the stress direction stands still: in a rotating flow it may circle instead, which is no steady flow
    const SymTensor<double> change = stress_rate(law, flow, end.state);
    const SymTensor<double> turning = deviator(change) - (trace(change) / trace(sigma)) * deviator(sigma);
    if (size(turning) < 1e-3 * size(sigma)) {
      ++steady;
      CHECK(power > 0);
    }
  }
  CHECK(steady >= 5);  // of ten simple shears and thirty others, or nothing was tested
}

TEMPLATE_LIST_TEST_CASE("a state made from a stress has that stress", "[start]", AllLaws) {
  using State = typename TestType::template State<double>;
  if constexpr (count < State, double >> 0) {
    const auto law = example_law<TestType>();
    Random random(35);
    for (int i = 0; i < 5000; ++i) {
      const Flow<double> flow = random.flow(1e-6, 1e3);
      // a stress that the law can have at this rate: that of some state
      const SymTensor<double> sigma =
          law.stress(flow, at_rest(law, flow.compaction, random.stress(random.decades(1e-2, 1e7))));
      const double d = distance<double>(law.stress(flow, law.start(flow, sigma)), sigma);
      // an addition and its inverse; a logarithm of up to 20 and its inverse
      const double tolerance = (StressInState<TestType> ? 2 : 50) * eps * size(sigma);
      CAPTURE(i);
      HOLDS(d <= tolerance);
    }
  }
}

namespace {

template <class Recipe, std::size_t... k>
void compare_forms(std::index_sequence<k...>) {
  using First = std::tuple_element_t<0, typename Recipe::Forms>;
  const auto one = example_law<First>();
  [[maybe_unused]] const auto compare = [&]<class L>(const L& other) {
    Random random(36);
    for (int i = 0; i < 5000; ++i) {
      const Flow<double> flow = random.flow(1e-6, 1e3);
      const SymTensor<double> sigma = random.stress(random.decades(1e-2, 1e7));
      const auto y = at_rest(one, flow.compaction, sigma);
      const auto z = at_rest(other, flow.compaction, sigma);
      // the logarithm of the trace, about 20, carries its rounding into every term
      const double tolerance = 200 * eps * stiffness(one, flow, y) * size(flow.L);
      const double d = distance<double>(stress_rate(one, flow, y), stress_rate(other, flow, z));
      CAPTURE(i, Recipe::name);
      HOLDS(d <= tolerance);
      const double s = distance<double>(one.stress(flow, y), other.stress(flow, z));
      HOLDS(s <= 50 * eps * stress_size(one, flow, y));
      const double c = one.wave_speed(flow, y, 1600.0), c2 = other.wave_speed(flow, z, 1600.0);
      HOLDS(std::fabs(c - c2) <= 200 * eps * c);
    }
  };
  (compare(example_law<std::tuple_element_t<k + 1, typename Recipe::Forms>>()), ...);
}

}  // namespace

TEST_CASE("the forms of a state are the same law", "[forms]") {
  for_each_recipe(
      []<class R>(R) { compare_forms<R>(std::make_index_sequence<std::tuple_size_v<typename R::Forms> - 1>{}); });
}
