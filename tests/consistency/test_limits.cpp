// SPDX-License-Identifier: BSD-3-Clause
#include "harness.hpp"

using namespace grainlaw;
using namespace grainlaw::consistency;

namespace {

template <class R, class L, class Y>
bool results_finite(const L& law, const Flow<R>& flow, const Y& y) {
  return finite<R>(law.stress(flow, y)) && finite<R>(law.rate(flow, y)) &&
         std::isfinite(law.wave_speed(flow, y, R(1600))) && std::isfinite(law.viscosity(flow, y));
}

template <class R, class L>
void check_admissible(int n) {
  const L law = example_law<L>();
  Random random(41);
  int failures = 0;
  for (int i = 0; i < n; ++i) {
    const Flow<double> flow = random.flow(1e-12, 1e6);
    const Flow<R> f = flow_in<R>(flow);
    const SymTensor<double> sigma = random.stress(random.decades(1e-6, 1e9));
    const auto y = law.start(Flow<R>{{}, f.compaction}, sym_in<R>(sigma));
    const auto a = law.admit(f, y);
    if (a.reasons != 0 || !same_bits(a.state, y) || !results_finite(law, f, y)) {
      if (++failures == 1) {
        CAPTURE(i, a.reasons, f.compaction, sigma.xx, sigma.yy, sigma.zz, size(flow.L));
        CHECK(a.reasons == 0);
        CHECK(same_bits(a.state, y));
        CHECK(results_finite(law, f, y));
      }
    }
  }
  CHECK(failures == 0);
}

/// Everything that can go wrong in one number.
template <class R>
std::vector<R> nasty() {
  using limits = std::numeric_limits<R>;
  std::vector<R> all{R(0),
                     -R(0),
                     limits::denorm_min(),
                     -limits::denorm_min(),
                     limits::min(),
                     limits::max(),
                     limits::lowest(),
                     limits::infinity(),
                     -limits::infinity(),
                     limits::quiet_NaN(),
                     R(1),
                     R(-1)};
  for (int k = limits::min_exponent10; k <= limits::max_exponent10; k += 7) {
    all.push_back(std::pow(R(10), R(k)));
    all.push_back(-std::pow(R(10), R(k)));
  }
  return all;
}

template <class R, class L>
void check_anything(int n) {
  using State = typename L::template State<R>;
  const L law = example_law<L>();
  const std::vector<R> values = nasty<R>();
  Random random(42);
  const auto any = [&] { return values[std::size_t(random.below(int(values.size())))]; };
  int silent = 0, unstable = 0, touched = 0;
  for (int i = 0; i < n; ++i) {
    Flow<R> flow = flow_in<R>(random.flow(1e-6, 1e3));
    const State ordinary =
        law.start(Flow<R>{{}, R(0)}, sym_in<R>(random.stress(random.decades(1e-2, 1e6), random.uniform(0, 4))));
    auto l = numbers<R>(flow.L);
    auto y = numbers<R>(ordinary);
    // one number, several, or all of them
    const int kind = random.below(4);
    for (R& x : y) {
      if (random.below(kind == 0 ? 1 : kind * 3) == 0) x = any();
    }
    if (random.below(2) == 0) {
      for (R& x : l) {
        if (random.below(kind == 0 ? 1 : kind * 3) == 0) x = any();
      }
    }
    if (random.below(3) == 0) flow.compaction = any();
    flow.L = from_numbers<Tensor<R>>(l);
    const State state = from_numbers<State>(y);

    const auto a = law.admit(flow, state);
    const bool flagged = (a.reasons & not_finite) != 0;
    const auto report = [&](int& counter, const char* what) {
      if (++counter > 3) return;
      std::ostringstream text;
      text << what << ": reasons " << a.reasons << ", L";
      for (R x : l) text << ' ' << x;
      text << ", compaction " << flow.compaction << ", state";
      for (R x : y) text << ' ' << x;
      text << ", admitted";
      for (R x : numbers<R>(a.state)) text << ' ' << x;
      text << ", stress";
      for (R x : numbers<R>(law.stress(flow, a.state))) text << ' ' << x;
      text << ", rate";
      for (R x : numbers<R>(law.rate(flow, a.state))) text << ' ' << x;
      UNSCOPED_INFO(text.str());
    };
    if (a.reasons == 0 && !same_bits(a.state, state)) report(touched, "touched without a reason");
    if (flagged) continue;
    if (!finite<R>(a.state) || !results_finite(law, flow, a.state)) {
      report(silent, "neither finite nor flagged");
      continue;
    }
    const auto b = law.admit(flow, a.state);
    if ((b.reasons & (tension | pressure_floor | not_finite)) != 0) report(unstable, "admitted twice");
  }
  CHECK(silent == 0);
  CHECK(unstable == 0);
  CHECK(touched == 0);
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("every admissible state has finite results and is left alone", "[finite]", AllLaws) {
  SECTION("double") { check_admissible<double, TestType>(100000); }
  SECTION("float") { check_admissible<float, TestType>(100000); }
}

TEMPLATE_LIST_TEST_CASE("whatever comes in, the result is finite or flagged", "[finite]", AllLaws) {
  SECTION("double") { check_anything<double, TestType>(40000); }
  SECTION("float") { check_anything<float, TestType>(40000); }
}

TEMPLATE_LIST_TEST_CASE("admit accepts what it returned", "[admit]", AllLaws) {
  const auto law = example_law<TestType>();
  Random random(43);
  int failures = 0, mended = 0;
  for (int i = 0; i < 100000; ++i) {
    const Flow<double> flow = random.flow(1e-6, 1e3);
    SymTensor<double> sigma = random.stress(random.decades(1e-10, 1e9), random.decades(0.9, 1e6));
    if (random.below(3) == 0) sigma = plus_isotropic(sigma, -2 * trace(sigma) / 3);  // all of it in tension
    const auto a = law.admit(flow, at_rest(law, flow.compaction, sigma));
    mended += (a.reasons & (tension | pressure_floor)) != 0;
    const auto b = law.admit(flow, a.state);
    if ((a.reasons & not_finite) == 0 &&
        ((b.reasons & (tension | pressure_floor)) != 0 || !same_bits(a.state, b.state))) {
      if (++failures <= 3) UNSCOPED_INFO(i << ": first " << a.reasons << ", then " << b.reasons);
    }
  }
  CHECK(failures == 0);
  if (count < typename TestType::template State<double>, double >> 0 && TestType::name.find("hypoplastic") == 0) {
    CHECK(mended > 10000);  // or nothing was tested
  }
}

// Where the critical curve meets e_min the density factor has its pole; beyond it the curves mean nothing.
TEMPLATE_LIST_TEST_CASE("the pole of the density factor is crossed with a flag and without a jump to infinity",
                        "[finite]", AllLaws) {
  if constexpr (uses_void_ratio<TestType>()) {
    auto law = example_law<TestType>();
    visit_parameters(law, [](const auto& row, Constant& value) {
      if (row.name == "p1") value = 0.53;
      if (row.name == "p2") value = 0.45;
      if (row.name == "e_min") value = 0.597;
      if (row.name == "p3") value = -1.8e-6;
    });
    const double pole = std::log((0.597 - 0.53) / 0.45) / -1.8e-6;  // of |tr sigma|, 1058 kPa
    Random random(44);
    for (double x : {1e-12, 1e-9, 1e-6, 1e-3}) {
      for (double side : {-1.0, 1.0}) {
        for (int i = 0; i < 200; ++i) {
          const Flow<double> flow = random.flow(1e-6, 1e3);
          const auto y = at_rest(law, flow.compaction, random.stress(pole / 3 * (1 + side * x)));
          CAPTURE(x, side, i);
          CHECK(results_finite(law, flow, y));
          // with p3 p2 exp(p3 t) t = 0.13 x of e_crt - e_min the flag must rise from x = 1e-5 on
          if (side > 0 || x < 1e-6) CHECK((law.admit(flow, y).reasons & beyond_validity) != 0);
        }
      }
    }
    SECTION("and so is a packing denser than the densest") {
      for (double compaction : {0.2, 0.5, 0.9, 5.0, 1e3}) {
        const Flow<double> flow{random.tensor(1), compaction};
        const auto y = at_rest(law, compaction, random.stress(1e4));
        CHECK((law.admit(flow, y).reasons & beyond_validity) != 0);
        CHECK(results_finite(law, flow, y));
      }
    }
  }
}
