// SPDX-License-Identifier: BSD-3-Clause
// Long paths, vanishing stresses, steps that are too large, numbers that are none.
#include <catch2/catch.hpp>

#include "rheology/advance.hpp"
#include "tests/paths.hpp"

using namespace grainlaw;
using namespace grainlaw::testing;

TEST_CASE("Liquefaction goes on for a hundred thousand units of ln|tr| without a fault", "[stability]") {
  // slope -8.25502441 per unit shear strain near zero pressure (two independent codes): -1e5 after some 12200
  auto test = shear(T2, .984, 500, equal_rows(13000, 13), 1e-10, Method::bdf);
  const auto record = run(test);
  REQUIRE(record.status == Status::done);
  CHECK(last(record, "ln_trace") < -1e5);
  const double slope = (value(record, 13, "ln_trace") - value(record, 12, "ln_trace")) / 1000;
  CHECK(std::abs(slope + 8.25502441) < 1e-8);  // eight decimals
  for (const auto& n : record.admit) CHECK(n == 0);
}

TEST_CASE("A thousand revolutions of simple shear end on the steady state", "[stability]") {
  for (const auto& [set, e, p0] : {std::tuple{T1, .80, 1e5}, {T2, .908, 500.0}}) {
    CAPTURE(set.name);
    const auto record = run(shear(set, e, p0, {12566}, 1e-10, Method::bdf));
    REQUIRE(record.status == Status::done);
    const Steady end = steady(set, e);
    // a fixed point of every Runge-Kutta and multistep method: no drift, only the rounding of the steady state itself
    // (bisection of I_e = I*, condition 1/(dI_e/d ln t) = 10)
    CHECK(distance(stress_at(record, 1), end.sigma) < 1e-12);
  }
}

TEST_CASE("A thousand revolutions by the exact rotation keep trace and J2", "[stability]") {
  const SymTensor<double> sigma{-1.2e5, -.9e5, -1.5e5, 1.1e4, 2.5e4, -.8e4};
  for (const Tensor<double>& spin :
       {Tensor<double>{0, 0, 1, 0, 0, 0, -1, 0, 0}, {0, .3, -.5, -.3, 0, .7, .5, -.7, 0}}) {
    const double w = std::sqrt(.5 * (2 * (spin.xy * spin.xy + spin.xz * spin.xz + spin.yz * spin.yz)));
    const auto check = [&](double jitter, double allowed) {
      Dice dice(40);
      const double step = 2 * std::numbers::pi / (36 * w);
      SymTensor<double> now = sigma;
      for (double t = 0; t < 1000 * 36 * step;) {
        const double dt = step * dice(1 - jitter, 1 + jitter);
        now = rotated(now, rotation(spin, dt));
        t += dt;
      }
      CHECK(std::abs(trace(now) / trace(sigma) - 1) < allowed);
      CHECK(std::abs(second_invariant(now) / second_invariant(sigma) - 1) < allowed);
    };
    check(0.1, 1e-12);  // steps as a particle code has them: roundings of 2e-16 add up like the root of 36000
    // equal steps repeat one rounding of Q 36000 times: at worst n eps per factor Q, two factors, J2 quadratic
    check(0, 36000 * 4 * 2.2e-16);
    // and every whole revolution in one step brings the stress back: the rounding of 2 pi and of its sine
    CHECK(distance(rotated(sigma, rotation(spin, 2 * std::numbers::pi / w)), sigma) < 1e-14);
  }
}

TEST_CASE("The annular shear cell ramps to 500 1/s for every packing", "[stability]") {
  // dv_x/dz = 2 kappa, kappa 10 1/s for 0.5 s, then to 500 1/s in 20 s; total strain 10210. k_v from Table 3.
  const struct {
    double e, k_v, slope;  // slope of ln|tr| per strain near zero pressure
  } rows[]{{1.169, .0018, -30.22650152}, {1.070, .0027, -18.58584458}, {.984, .0041, -8.25502441}, {.908, .0065, 0}};
  const double alpha = 27 * std::numbers::pi / 180;
  for (const auto& row : rows) {
    CAPTURE(row.e);
    const HypoplasticBagnold<> law{law_of(T2, row.e), {row.k_v, alpha}};
    auto test = path(law, row.e, simple_shear_flow, isotropic(-500.0), {.5, 20, 20.5}, 1e-10, Method::bdf);
    test.control.rate = {{{20, 20, .5}, {20, 1000, 20}}};
    const auto record = run(test);
    REQUIRE(record.status == Status::done);
    CHECK(last(record, "shear_strain") == Approx(10210).epsilon(1e-12));
    for (const auto& n : record.admit) CHECK(n == 0);
    // closed form at 1000 1/s, plus the critical state of the skeleton where there is one (0 otherwise)
    const Steady skeleton = steady(T2, row.e);
    CHECK(last(record, "shear_stress") == Approx(row.k_v * 1e6 + skeleton.sigma.xz).epsilon(1e-9));
    CHECK(-last(record, "stress_zz") == Approx(row.k_v * 1e6 / std::tan(alpha) - skeleton.sigma.zz).epsilon(1e-9));
    // after 0.5 s the strain is 10: k_v 20^2 plus the reference path there
    CHECK(value(record, 1, "shear_stress") ==
          Approx(row.k_v * 400 + (row.slope == 0 ? 36.77967021343 : 0)).epsilon(1e-9));
    if (row.slope == 0) continue;
    const double strain = 10210 - test.control.rate.strain(20);
    CHECK(std::abs((value(record, 3, "ln_trace") - value(record, 2, "ln_trace")) / strain - row.slope) < 1e-7);
  }
}

TEST_CASE("No principal stress turns tensile while I_e is at least 9|c1|/c4", "[stability]") {
  // At a boundary state (principal compression 0 along n) the law gives  sigma_nn' = tr (c1 D_nn + c4 I_e |D|/9): the
  // c2, c3 and spin terms vanish there, and the rest is compressive for every D exactly when I_e >= 9|c1|/c4.
  for (const Set& set : {T1, T2, T4, PILE}) {
    CAPTURE(set.name);
    const double least = guaranteed_I_e(set.c1, set.c4);
    const auto above = frozen(set, least);
    Dice dice(20);
    double worst = -1;
    for (int i = 0; i < 20000; ++i) {
      const double b = dice(0, 1);
      const Tensor<double> q = dice.turn(), L = dice.tensor();
      const SymTensor<double> sigma = -1.0 * rotated<double>({0, b, 1 - b, 0, 0, 0}, q);
      const auto rate = above.rate(Flow<double>{L, 0}, {sigma}).sigma;
      const double n[3]{q.xx, q.yx, q.zx};
      const double along = n[0] * n[0] * rate.xx + n[1] * n[1] * rate.yy + n[2] * n[2] * rate.zz +
                           2 * (n[1] * n[2] * rate.yz + n[0] * n[2] * rate.xz + n[0] * n[1] * rate.xy);
      worst = std::max(worst, along / (set.c4 * norm(symmetric(L))));
    }
    CHECK(worst < 1e-13);  // tension positive; rounding of terms of size c4 |D| |sigma|
    CHECK(worst > -0.05);  // the bound is nearly attained: expansion along n is what it is made for
    // and it is sharp: expansion along n, 1 % below the threshold, pulls
    const Flow<double> expansion{{1, 0, 0, 0, 0, 0, 0, 0, 0}, 0};
    const SymTensor<double> sigma{0, -.4, -.6, 0, 0, 0};
    CHECK(frozen(set, .99 * least).rate(expansion, {sigma}).sigma.xx > 0);
    CHECK(frozen(set, 1.01 * least).rate(expansion, {sigma}).sigma.xx < 0);
    // every state inside the range of the law is above it: I_e >= a >= 1 + q2
    CHECK(1 + set.q2 > least);
    for (int i = 0; i < 20000; ++i) {
      const auto critical = law_of(set, dice(set.e_min, 1.5)).critical;
      const double t = std::exp(dice(-30, 13));
      if (critical.e_crt(t) > set.e_min) CHECK(critical.I_e(0.0, t) >= 1 + set.q2 - 1e-15);
    }
  }
}

TEST_CASE("A fixed step beyond the blow-up limit never gives a silent wrong answer", "[stability]") {
  // measured limits per step of shear strain from an isotropic start: Euler .0050-.0056, midpoint .0048-.0066,
  // Heun .0054-.0062, RK4 .0054-.0066
  int exploded = 0, inaccurate = 0;
  const auto rows = equal_rows(1, 20);
  for (const auto& [set, e, p0] : {std::tuple{T1, .89, 1e5},
                                   {T1, .80, 1e5},
                                   {T1, .70, 1e5},
                                   {T2, .984, 500.0},
                                   {T2, .908, 500.0},
                                   {T4, .98, 1000.0}}) {
    const auto exact = run(shear(set, e, p0, rows));
    double largest = 0;
    for (std::size_t i = 0; i < exact.rows(); ++i) largest = std::max(largest, norm(stress_at(exact, i)));
    for (const StateForm form : {StateForm::stress, StateForm::logarithmic}) {
      for (const Method method : {Method::euler, Method::midpoint, Method::heun, Method::rk4}) {
        for (const double step : {2e-3, 4e-3, 5e-3, 6e-3, 8e-3, 1e-2, 2e-2, 5e-2}) {
          CAPTURE(int(form), element::info(method).name, set.name, e, step);
          auto test = with_fixed_step(shear(set, e, p0, rows, 0, method, form), method, step);
          test.integration.error_estimate = true;
          const auto record = run(test);
          const bool told = record.status == Status::failed;
          exploded += told;
          if (step >= 2e-2) CHECK(told);
          if (told) continue;
          // not stopped: then the answer is right to 5 %, or the reported error says that it is not
          const double truth = path_error(record, exact, largest);
          CAPTURE(truth, record.global_error_estimate);
          if (truth < 0.05) continue;
          ++inaccurate;
          CHECK(record.global_error_estimate > 0.5 * truth);
        }
      }
    }
  }
  CHECK(exploded > 100);
  CHECK(inaccurate > 0);
}

TEST_CASE("A step of a host agrees with the integrated path", "[stability]") {
  const auto law = law_of(T1, .80);
  const auto logarithmic = law_of<LogForm>(T1, .80);
  const Flow<double> flow{simple_shear_flow, 0};
  const SymTensor<double> start = isotropic(-1e5);
  const auto exact = stress_at(run(shear(T1, .80, 1e5, {.01})), 1);
  double before = 1;
  for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9}) {
    CAPTURE(tolerance);
    const auto a = advance(law, flow, flow, {start}, .01, tolerance);
    const auto b = advance(logarithmic, flow, flow, logarithmic.start(flow, start), .01, tolerance);
    CHECK(a.reasons == 0);
    CHECK(b.reasons == 0);
    const double error = distance(a.state.sigma, exact);
    // the tolerance is that of a sub-step: a third-order pair takes up to some hundred of them here
    CHECK(error < 100 * tolerance);
    CHECK(error < 0.3 * before);
    CHECK(distance(logarithmic.stress(flow, b.state), exact) < 100 * tolerance);
    before = error;
  }
  // ends that differ: a ramp from rest to 2 is the mean rate of 1 for a law that does not know time
  const auto ramp = advance(law, {}, {2.0 * simple_shear_flow, 0}, {start}, .01, 1e-9);
  CHECK(distance(ramp.state.sigma, exact) < 1e-7);
  // many small steps of a particle code: one sub-step, four rates each
  const auto small = advance(law, flow, flow, {start}, 1e-6, 1e-6);
  CHECK(small.rates == 4);
  // a circle in closed form
  const Elastic solid{3e6, 2e6};
  const auto turned = advance(solid, flow, flow, {SymTensor<double>{}}, .5, 1e-10).state.sigma;
  CHECK(turned.xz == Approx(2e6 * std::sin(.5)).epsilon(1e-7));
}

TEST_CASE("A step of no length returns the state, a hopeless one says so", "[stability]") {
  const auto law = law_of(T1, .80);
  const Flow<double> flow{simple_shear_flow, 0};
  const SymTensor<double> start{-1.2e5, -.9e5, -1.5e5, 1.1e4, 2.5e4, -.8e4};
  const auto none = advance(law, flow, flow, {start}, 0);
  CHECK(identical(none.state.sigma, start));
  CHECK(none.rates == 0);
  CHECK(none.reasons == 0);
  const auto few = advance(law, flow, flow, {start}, 1, 1e-9, 3);
  CHECK((few.reasons & too_many_steps) != 0);
  CHECK(std::isfinite(norm(few.state.sigma)));
  CHECK(pressure(few.state.sigma) > 0);
  const auto broken = advance(law, flow, flow, {isotropic(std::nan(""))}, 1);
  CHECK((broken.reasons & not_finite) != 0);
  CHECK((broken.reasons & too_many_steps) != 0);
  CHECK(broken.rates < 200);  // it gives up soon
  const Flow<double> nan_flow{{0, 0, std::nan(""), 0, 0, 0, 0, 0, 0}, 0};
  CHECK((advance(law, nan_flow, nan_flow, {start}, 1).reasons & too_many_steps) != 0);
  CHECK((advance(law, flow, flow, {start}, std::nan("")).reasons) != 0);  // a NaN for dt is not a step of no length
  // a law without a state has nothing to integrate
  CHECK(advance(Newtonian{1, 1}, flow, flow, {}, 1).reasons == 0);
  CHECK(advance(Newtonian{1, 1}, flow, flow, {}, 1).rates == 0);
}

TEST_CASE("Huge steps of a host end in the cone, or say that they do not", "[stability]") {
  Dice dice(30);
  const auto law = law_of(T1, .80);
  for (int i = 0; i < 300; ++i) {
    const Flow<double> flow{std::exp(dice(-3, 3)) * dice.tensor(), 0};
    const SymTensor<double> start = -std::exp(dice(0, 11)) * dice.compressive();
    const auto end = advance(law, flow, flow, {start}, .05, 1e-4, 5000);
    if ((end.reasons & (too_many_steps | not_finite)) != 0) continue;
    CHECK(pressure(end.state.sigma) >= 0);
    CHECK((law.admit(flow, end.state).reasons & tension) == 0);
  }
}
