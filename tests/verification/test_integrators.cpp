// SPDX-License-Identifier: BSD-3-Clause
// Every method of the element driver on problems whose solution is known.
#include <catch2/catch.hpp>

#include "tests/paths.hpp"

using namespace grainlaw;
using namespace grainlaw::testing;
using element::Integrator;
using element::MethodInfo;
using element::Ode;

namespace {

/// u' = -u^2, v' = u v + 2 cos(2 t) v: non-linear, coupled, time dependent; u = 1/(1 + t), v = (1 + t) exp(sin(2 t)).
struct Problem {
  double rtol;
  static double u(double t) { return 1 / (1 + t); }
  static double v(double t) { return (1 + t) * std::exp(std::sin(2 * t)); }
  Ode ode() {
    Ode ode;
    ode.size = 2;
    ode.self = this;
    ode.derivative = [](void*, double t, const double* y, double* dydt) {
      dydt[0] = -y[0] * y[0];
      dydt[1] = (y[0] + 2 * std::cos(2 * t)) * y[1];
      return 0;
    };
    ode.tolerance = [](void* self, const double* y, double* allowed) {
      allowed[0] = allowed[1] = static_cast<Problem*>(self)->rtol * std::hypot(y[0], y[1]);
    };
    return ode;
  }
};

struct Outcome {
  double error;
  element::Counters counters;
};

/// To t = 2 with n steps of equal length. An adaptive table is forced: each start is one step, accepted because the
/// tolerance is loose.
Outcome forced(const MethodInfo& m, int n) {
  Problem problem{1e9};
  const double h = 2.0 / n;
  Integrator integrator(problem.ode(), {m.method, h, h});
  double y[]{1, 1};
  if (m.fixed_step) {
    integrator.start(0, y, 2);
    REQUIRE(integrator.advance(2, y));
  } else {
    for (int i = 0; i < n; ++i) {
      integrator.start(i * h, y, (i + 1) * h);
      REQUIRE(integrator.advance((i + 1) * h, y));
    }
  }
  CHECK(integrator.counters().steps == n);
  return {std::hypot(y[0] - Problem::u(2), y[1] - Problem::v(2)), integrator.counters()};
}
Outcome controlled(Method method, double rtol) {
  Problem problem{rtol};
  Integrator integrator(problem.ode(), {method, 0, 1e-3});
  double y[]{1, 1};
  integrator.start(0, y, 2);
  REQUIRE(integrator.advance(2, y));
  CHECK(integrator.t_reached() == 2);
  return {std::hypot(y[0] - Problem::u(2), y[1] - Problem::v(2)), integrator.counters()};
}

}  // namespace

TEST_CASE("Every one-step method has its documented order", "[integrators]") {
  int seen = 0;
  for (const auto& m : element::methods()) {
    if (m.name == "bdf" || m.name == "adams") continue;  // variable order: below
    ++seen;
    CAPTURE(m.name);
    // halving the step at errors between 1e-4 and 1e-12, far above round-off; the next order changes the slope by less
    // than 0.1 there
    const int n = m.order == 1 ? 4000 : m.order == 2 ? 400 : m.order == 3 ? 200 : 80;
    const double slope = std::log2(forced(m, n).error / forced(m, 2 * n).error);
    CHECK(std::abs(slope - m.order) < 0.1);
  }
  CHECK(seen == 9);
}

TEST_CASE("The error follows the tolerance, and the cost its root", "[integrators]") {
  for (const auto& m : element::methods()) {
    if (m.fixed_step) continue;
    CAPTURE(m.name);
    double before = 1;
    for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10}) {
      CAPTURE(rtol);
      const auto outcome = controlled(m.method, rtol);
      // local errors of a contracting problem add up to a few tolerances; multistep methods change their order on the
      // way and are allowed ten times more
      CHECK(outcome.error < (m.name == "bdf" || m.name == "adams" ? 100 : 10) * rtol);
      CHECK(outcome.error < 0.2 * before);  // two decades of tolerance are at least a factor of five
      before = outcome.error;
    }
    if (m.name == "bdf" || m.name == "adams") continue;
    // a step of length h makes an error of the pair's difference, h^order: four decades cost 10^(4/order); the first
    // steps and the last one blur the count by some 20 %
    const double cost =
        double(controlled(m.method, 1e-12).counters.steps) / double(controlled(m.method, 1e-8).counters.steps);
    CHECK(cost == Approx(std::pow(10, 4.0 / m.order)).epsilon(0.2));
  }
}

TEST_CASE("A problem that has no rate or no size is refused or done, never wrong", "[integrators]") {
  Ode empty;
  Integrator nothing(empty, {Method::dp54, 0, 0});
  nothing.start(0, nullptr, 1);
  CHECK(nothing.advance(1, nullptr));
  CHECK(nothing.t_reached() == 1);
  for (const auto& m : element::methods()) {
    CAPTURE(m.name);
    struct Wall : Problem {
      long evaluations = 0;
    } wall{{1e-6}};
    Ode ode = wall.ode();
    ode.self = &wall;
    ode.derivative = [](void* self, double t, const double* y, double* dydt) {  // no rate beyond t = 1
      dydt[0] = -y[0];
      dydt[1] = -y[1];
      if (++static_cast<Wall*>(self)->evaluations > 200000) return -1;  // only so that a creeping method ends at all
      return t > 1 ? 1 : 0;
    };
    Integrator integrator(ode, {m.method, 1e-2, 1e-3});
    double y[]{1, 1};
    integrator.start(0, y, 2);
    CHECK_FALSE(integrator.advance(2, y));
    CHECK_FALSE(integrator.failure().empty());
    CHECK(integrator.t_reached() < 1.02 + 1e-12);  // one fixed step beyond the wall at most
    CHECK(wall.evaluations < 100000);
    // what was reached is a point of the solution exp(-t): the order of Euler at this step is the loosest
    CHECK(y[0] == Approx(std::exp(-integrator.t_reached())).epsilon(0.02));
  }
}

namespace {

constexpr double K = 3e6, G = 2e6;

}  // namespace

TEST_CASE("Simple shear of the Jaumann solid is a circle", "[integrators]") {
  for (const auto& m : element::methods()) {
    if (m.fixed_step) continue;
    CAPTURE(m.name);
    const auto rows = equal_rows(10, 10);
    const auto record =
        run(path(Elastic{K, G}, 0, simple_shear_flow, isotropic(-G), rows, 1e-12, m.method, StateForm::stress));
    REQUIRE(record.status == Status::done);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double gamma = rows[i];
      CHECK(value(record, i + 1, "stress_xz") == Approx(G * std::sin(gamma)).margin(1e-9 * G));
      CHECK(value(record, i + 1, "stress_xx") + G == Approx(G * (1 - std::cos(gamma))).margin(1e-9 * G));
      CHECK(value(record, i + 1, "stress_zz") + G == Approx(-G * (1 - std::cos(gamma))).margin(1e-9 * G));
      CHECK(value(record, i + 1, "stress_yy") + G == Approx(0).margin(1e-9 * G));
    }
  }
}

TEST_CASE("A solid can be sheared from zero stress", "[integrators]") {
  for (const auto& m : element::methods()) {
    if (m.fixed_step) continue;
    CAPTURE(m.name);
    // no absolute tolerance: what the reader of element tests gives a specimen without initial stress
    const auto record = run(path(Elastic{K, G}, 0, simple_shear_flow, {}, {1}, 1e-9, m.method, StateForm::stress));
    CHECK(record.status == Status::done);
    CHECK(last(record, "stress_xz") == Approx(G * std::sin(1.0)).epsilon(1e-7));  // a hundred times the step tolerance
  }
}

TEST_CASE("A pure rotation turns the stress and nothing else, whatever the law and the form", "[integrators]") {
  const SymTensor<double> sigma{-1.2e5, -.9e5, -1.5e5, 1.1e4, 2.5e4, -.8e4};
  const Tensor<double> spin{0, 0, 1, 0, 0, 0, -1, 0, 0};
  const auto check = [&](const auto& law, StateForm form) {
    const auto rows = equal_rows(2 * std::numbers::pi, 8);
    const auto record = run(path(law, .8, spin, sigma, rows, 1e-12, Method::dp54, form));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      // closed form, angle t: the pair (xx - zz)/2, xz turns by 2 t, the pair yz, xy by t
      const double t = rows[i], c = std::cos(t), s = std::sin(t), c2 = std::cos(2 * t), s2 = std::sin(2 * t);
      const double mean = .5 * (sigma.xx + sigma.zz), a = .5 * (sigma.xx - sigma.zz), b = sigma.xz;
      const SymTensor<double> turned{mean + a * c2 + b * s2,      sigma.yy,        mean - a * c2 - b * s2,
                                     sigma.yz * c - sigma.xy * s, b * c2 - a * s2, sigma.xy * c + sigma.yz * s};
      CHECK(distance(stress_at(record, i + 1), turned) < 1e-9);
      CHECK(distance(stress_at(record, i + 1), rotated(sigma, rotation(spin, t))) < 1e-9);
    }
  };
  check(Elastic{K, G}, StateForm::stress);
  check(law_of(T1, .8), StateForm::stress);
  check(law_of(T1, .8), StateForm::logarithmic);
}

TEST_CASE("One revolution by a fixed step changes J2 by the power of its stability polynomial", "[integrators]") {
  // sigma_xz alone turns as exp(2 i t): J2 grows by |R(2 i h)|^2 per step, R = 1 + z + z^2/2 + ... of the method
  const SymTensor<double> sigma{-1e5, -1e5, -1e5, 0, 2e4, 0};
  for (const auto& [method, n] : {std::pair{Method::euler, 360},
                                  {Method::euler, 3600},
                                  {Method::midpoint, 36},
                                  {Method::midpoint, 360},
                                  {Method::heun, 36},
                                  {Method::rk4, 36},
                                  {Method::rk4, 360}}) {
    CAPTURE(element::info(method).name, n);
    const double h = 2 * std::numbers::pi / n, x = 2 * h;
    const int order = element::info(method).order;
    const double re = 1 - (order >= 2 ? x * x / 2 : 0) + (order >= 4 ? std::pow(x, 4) / 24 : 0);
    const double im = x - (order >= 4 ? x * x * x / 6 : 0);
    const auto test = with_fixed_step(path(law_of(T1, .8), .8, {0, 0, 1, 0, 0, 0, -1, 0, 0}, sigma,
                                           {2 * std::numbers::pi}, 0, method, StateForm::stress),
                                      method, h);
    const auto record = run(test);
    REQUIRE(record.counters.steps == n);
    const double growth = second_invariant(stress_at(record, 1)) / second_invariant(sigma);
    CHECK(growth == Approx(std::pow(re * re + im * im, n)).epsilon(1e-11));  // n roundings, amplified by the power
    CHECK(std::abs(trace(stress_at(record, 1)) / trace(sigma) - 1) < 1e-12);
  }
}

TEST_CASE("Fixed steps on the undrained path have their order and the documented size of error", "[integrators]") {
  // largest error of a component over the path relative to p0, explicit midpoint: 1-2e-7 at a step of 1e-5, 1-2e-5 at
  // 1e-4, 1.3-2.5e-3 at 1e-3. The reference names neither its rows nor its sets, so a factor of 1.3 is allowed on
  // either side; rows begin at 0.01, before which the error is twice as large.
  std::vector<double> rows;
  for (int i = 10; i <= 100; ++i) rows.push_back(1e-3 * i);
  const struct { double step, low, high; } sizes[]{{1e-5, 1e-7, 2e-7}, {1e-4, 1e-5, 2e-5}, {1e-3, 1.3e-3, 2.5e-3}};
  for (const auto& [set, e, p0] : {std::tuple{T1, .89, 1e5}, {T1, .80, 1e5}, {T2, .908, 500.0}}) {
    CAPTURE(set.name, e);
    const auto exact = run(shear(set, e, p0, rows, 1e-13, Method::dp54, StateForm::stress));
    const auto error = [&](Method method, double step) {
      const auto record = run(with_fixed_step(shear(set, e, p0, rows, 0, method, StateForm::stress), method, step));
      REQUIRE(record.status == Status::done);
      double worst = 0;
      for (std::size_t i = 0; i < exact.rows(); ++i) {
        SymTensor<double> d = stress_at(record, i) - stress_at(exact, i);
        each(d, [&](double x) { worst = std::max(worst, std::abs(x) / p0); });
      }
      return worst;
    };
    for (const auto& size : sizes) {
      CAPTURE(size.step);
      const double found = error(Method::midpoint, size.step);
      CHECK(found > size.low / 1.3);
      CHECK(found < size.high * 1.3);
    }
    for (const Method method : {Method::euler, Method::midpoint, Method::heun, Method::rk4}) {
      CAPTURE(element::info(method).name);
      // eigenvalues of 400 times the step: 0.02 and 0.01, so the next order bends the slope by a few per cent
      CHECK(std::log2(error(method, 5e-5) / error(method, 2.5e-5)) == Approx(element::info(method).order).margin(0.1));
    }
  }
}

TEST_CASE("The reported error is an upper bound of the true one, and not a wild one", "[integrators]") {
  for (const auto& m : element::methods()) {
    CAPTURE(m.name);
    for (const auto& [set, e, p0] : {std::tuple{T1, .89, 1e5}, {T1, .80, 1e5}, {T2, .984, 500.0}, {T2, .908, 500.0}}) {
      for (const double rtol : {1e-5, 1e-7, 1e-9}) {
        CAPTURE(set.name, e, rtol);
        const auto rows = equal_rows(1, 50);
        auto test = shear(set, e, p0, rows, rtol, m.method);
        test.integration.error_estimate = true;
        if (m.fixed_step) test = with_fixed_step(test, m.method, 1e-4);
        const auto record = run(test);
        const auto exact = run(shear(set, e, p0, rows, 1e-13));
        double largest = 0;
        for (std::size_t i = 0; i < exact.rows(); ++i) largest = std::max(largest, norm(stress_at(exact, i)));
        const double truth = path_error(record, exact, largest);
        CAPTURE(truth, record.global_error_estimate);
        // a run ten times coarser is ten times worse (twice the step: 2^order - 1 times the error itself)
        CHECK(truth <= record.global_error_estimate * (m.order == 1 ? 1.1 : 1));
        CHECK(record.global_error_estimate < 200 * std::max(truth, 1e-12));
        if (!m.fixed_step) CHECK(truth < 100 * rtol);
        if (m.fixed_step) break;
      }
    }
  }
}

TEST_CASE("A programme of rates is walked from kink to kink", "[integrators]") {
  // the skeleton does not know time: after the same strain the stress of a ramp is that of a constant rate
  element::RateProgramme ramp{{{10, 10, .005}, {10, 500, .002}, {500, 20, .001}}};
  std::vector<double> times, strains;
  for (const double t : {.002, .005, .0061, .007, .0075, .008, .01}) {
    times.push_back(t);
    strains.push_back(ramp.strain(t));
  }
  for (const Method method : {Method::dp54, Method::bdf}) {
    auto test = shear(T2, .908, 500, times, 1e-11, method);
    test.control.rate = ramp;
    test.columns.shear_rate = true;
    const auto with_ramp = run(test), constant = run(shear(T2, .908, 500, strains, 1e-13));
    REQUIRE(with_ramp.status == Status::done);
    CHECK(path_error(with_ramp, constant, 500) < 1e-9);
    CHECK(value(with_ramp, 4, "shear_rate") == Approx(500).epsilon(1e-14));
  }
}

TEST_CASE("A reversal of the rate costs neither digits nor the run", "[integrators]") {
  // |D| has a kink that costs digits unless the integrator starts anew there. The same strains in four runs,
  // each from the end of the one before, know no kink at all.
  element::RateProgramme cycles{{{1, 1, .01}, {-1, -1, .02}, {1, 1, .02}, {-1, -1, .01}}};
  auto test = shear(T1, .8, 1e5, {.01, .03, .05, .06}, 1e-11);
  test.control.rate = cycles;
  const auto record = run(test);
  REQUIRE(record.status == Status::done);
  SymTensor<double> sigma = isotropic(-1e5);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& piece = cycles.pieces[i];
    sigma = stress_at(run(path(law_of(T1, .8), .8, piece.from * simple_shear_flow, sigma, {piece.over}, 1e-13)), 1);
    CHECK(distance(stress_at(record, i + 1), sigma) < 1e-9);
  }
  CHECK(pressure(sigma) < 0.5 * 1e5);  // cyclic softening: it was a path worth testing
}
