// SPDX-License-Identifier: BSD-3-Clause
// Element tests against two independent integrations of the same equations (a Python DOP853 at 1e-13 and a long-double
// Runge-Kutta code with Richardson extrapolation), and against algebra.
#include <catch2/catch.hpp>

#include "tests/paths.hpp"

using namespace grainlaw;
using namespace grainlaw::testing;

namespace {

// rtol is the error of one step; some hundred steps of an attracting path stay within a hundred of them
constexpr double rtol = 1e-11, ode = 1e-9;

struct Point {
  double gamma;
  SymTensor<double> sigma;
};
struct Case {
  const Set& set;
  double e, p0;
  std::vector<Point> points;
};
SymTensor<double> plane(double xx, double yy, double zz, double xz) { return {xx, yy, zz, 0, xz, 0}; }

const std::vector<Case> undrained{
    {T1,
     .890,
     1e5,
     {{.01, plane(-37565.51289847, -35373.79242557, -37669.85760281, 13973.30353099)},
      {.1, plane(-13009.03261009, -10580.96730049, -13096.02951624, 6319.696820035)},
      {1, plane(-3743.519947276, -3024.515207555, -3769.454506637, 1848.229909294)}}},
    {T1,
     .865,
     1e5,
     {{.01, plane(-39747.54725026, -37408.55921233, -39860.83692371, 15029.9237005)},
      {.1, plane(-21121.57021691, -17101.73843243, -21266.27280781, 10376.38714558)},
      {1, plane(-17725.03327763, -14314.39128945, -17848.11306118, 8760.596999252)}}},
    {T1,
     .845,
     1e5,
     {{.01, plane(-41609.8133257, -39145.37296295, -41730.93607299, 15947.67099836)},
      {.1, plane(-30183.01568014, -24373.23018838, -30392.68809126, 14920.89325815)},
      {1, plane(-30293.0403679, -24464.05994869, -30503.39076707, 14972.3467543)}}},
    {T1,
     .800,
     1e5,
     {{.01, plane(-46227.50465909, -43453.8405211, -46368.82732431, 18285.55520481)},
      {.1, plane(-59715.32957354, -48101.55410162, -60135.21238744, 29662.115215)},
      {1, plane(-61958.75993465, -50036.66845609, -62388.99241461, 30623.14072487)}}},
    {T1,
     .750,
     1e5,
     {{.01, plane(-52175.55637021, -49010.09794431, -52344.49917866, 21424.93137312)},
      {.1, plane(-104387.466766, -84212.20469798, -105115.8006092, 51655.38387558)},
      {1, plane(-104532.1527636, -84418.09804374, -105258.0085968, 51665.05636538)}}},
    {T1,
     .700,
     1e5,
     {{.01, plane(-59193.75676385, -55580.6062656, -59397.56363458, 25310.7817005)},
      {.1, plane(-159297.2442688, -128679.9837199, -160402.1924268, 78691.38993703)},
      {1, plane(-159187.9911249, -128557.0715506, -160293.369029, 78678.72531776)}}},
    {T2,
     1.169,
     500,
     {{.01, plane(-168.670467505, -154.147079806, -169.0728624067, 56.54731649857)},
      {.1, plane(-8.048691801988, -6.450170741508, -8.086724125555, 3.276931346191)},
      {1, plane(-1.226840925064e-11, -9.829531393163e-12, -1.232645069806e-11, 4.997467013456e-12)}}},
    {T2,
     1.070,
     500,
     {{.01, plane(-182.4885080441, -166.5314045588, -182.9399297789, 62.59366936096)},
      {.1, plane(-23.64444236211, -18.71323052953, -23.76364138735, 9.926441740781)},
      {1, plane(-1.257278232042e-06, -9.945188952613e-07, -1.26363385129e-06, 5.28463964165e-07)}}},
    {T2,
     .984,
     500,
     {{.01, plane(-195.4738011511, -178.1647855737, -195.9730075235, 68.41707570264)},
      {.1, plane(-60.79867421608, -47.58047872248, -61.12278749592, 26.20726395108)},
      {1, plane(-0.03249763696982, -0.02540332644073, -0.03267183544767, 0.01404325374574)}}},
    {T2,
     .908,
     500,
     {{.01, plane(-207.7729154719, -189.1819050884, -208.3188753957, 74.05562397023)},
      {.1, plane(-140.4425966947, -108.8118311656, -141.2281236615, 61.92065140641)},
      {1, plane(-98.6995284675, -76.42021486612, -99.25327918367, 43.57878638707)},
      {10, plane(-83.25673402042, -64.44791806273, -83.72436727217, 36.77967021343)}}}};

}  // namespace

TEST_CASE("Undrained simple shear follows the reference path in both state forms", "[paths]") {
  for (const StateForm form : {StateForm::logarithmic, StateForm::stress}) {
    for (const auto& c : undrained) {
      std::vector<double> rows;
      for (const auto& p : c.points) rows.push_back(p.gamma);
      const RunRecord record = run(shear(c.set, c.e, c.p0, rows, rtol, Method::dp54, form));
      REQUIRE(record.status == Status::done);
      CHECK(record.state_form == (form == StateForm::stress ? "stress" : "logarithmic"));
      for (std::size_t i = 0; i < c.points.size(); ++i) {
        CAPTURE(c.set.name, c.e, c.points[i].gamma, record.state_form);
        CHECK(distance(stress_at(record, i + 1), c.points[i].sigma) < ode);
        CHECK(value(record, i + 1, "shear_strain") == Approx(c.points[i].gamma).epsilon(1e-15));
      }
    }
  }
}

TEST_CASE("Every error-controlled method meets the reference path", "[paths]") {
  for (const auto& m : element::methods()) {
    if (m.fixed_step) continue;
    CAPTURE(m.name);
    const auto& c = undrained[3];  // T1, e = 0.80
    const RunRecord record = run(shear(c.set, c.e, c.p0, {.01, .1, 1}, rtol, m.method));
    REQUIRE(record.status == Status::done);
    for (std::size_t i = 0; i < 3; ++i) CHECK(distance(stress_at(record, i + 1), c.points[i].sigma) < ode);
  }
}

TEST_CASE("Peaks and minima of undrained shear lie where the reference has them", "[paths]") {
  struct Expected {
    bool maximum;
    double gamma, value, p, zz;  // 0: not printed
  };
  const struct {
    const Set& set;
    double e, p0, until;
    const char* column;
    std::vector<Expected> expected;
  } rows[]{
      {T1, .890, 1e5, .2, "shear_stress", {{true, 0.0077777514, 14160.953785, 42167.894067, -42762.711170}}},
      {T1, .865, 1e5, .2, "shear_stress", {{true, 0.0088594638, 15068.582402, 41368.991138, -42109.260515}}},
      {T1,
       .845,
       1e5,
       .2,
       "shear_stress",
       {{true, 0.0103432850, 15950.106563, 40231.428978, -41170.429449}, {false, 0.0530677387, 14875.269872, 0, 0}}},
      {T1,
       .830,
       1e5,
       .2,
       "shear_stress",
       {{true, 0.0131025827, 16777.330048, 0, 0}, {false, 0.0201289969, 16723.355170, 0, 0}}},
      {T1, .825, 1e5, .2, "shear_stress", {}},
      {T1, .820, 1e5, .2, "shear_stress", {}},
      {T1, .800, 1e5, .2, "shear_stress", {}},
      {T1, .750, 1e5, .2, "shear_stress", {{true, 0.1135937540, 51690.708694, 0, 0}}},
      {T1, .700, 1e5, .1, "shear_stress", {{true, 0.0651356732, 79774.053505, 0, 0}}},
      {T1, .845, 1e5, .2, "pressure", {{false, 0.0626905682, 28253.350871, 0, 0}}},
      {T1, .825, 1e5, .1, "pressure", {{false, 0.0293388346, 33654.172581, 0, 0}}},
      {T1, .820, 1e5, .1, "pressure", {{false, 0.0272215872, 34805.627152, 0, 0}}},
      {T1, .800, 1e5, .1, "pressure", {{false, 0.0217078631, 39114.306748, 0, 0}}},
      {T1, .750, 1e5, .05, "pressure", {{false, 0.0150051873, 48820.514122, 0, 0}}},
      {T1, .700, 1e5, .05, "pressure", {{false, 0.0114477737, 57733.522004, 0, 0}}},
      {T2, 1.169, 500, .2, "shear_stress", {{true, 0.0057450665, 61.99626264, 232.1163634, -234.9284674}}},
      {T2, 1.070, 500, .2, "shear_stress", {{true, 0.0063794197, 65.9722909, 229.2466172, -232.6520097}}},
      {T2, 0.984, 500, .2, "shear_stress", {{true, 0.0071687575, 70.08184862, 225.4740235, -229.6504206}}},
      {T2, 0.908, 500, .2, "shear_stress", {{true, 0.0082913308, 74.48544867, 219.846572, -225.1395876}}}};
  for (const auto& row : rows) {
    CAPTURE(row.set.name, row.e, row.column);
    // rows of 1e-3 lie densely against every extremum; the tolerance is near round-off because a flat extremum moves by
    // (error of the slope)/(curvature)
    const auto test = shear(row.set, row.e, row.p0, equal_rows(row.until, 200), 1e-13);
    const auto found = extrema(test, row.column);
    REQUIRE(found.size() == row.expected.size());
    const auto columns = make_point(test).columns;
    const auto at = [&](const element::Extremum& e, std::string_view name) {
      for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i].name == name) return e.row[i];
      }
      return std::nan("");
    };
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto& want = row.expected[i];
      CAPTURE(want.gamma);
      CHECK(found[i].maximum == want.maximum);
      // one unit of the last printed decimal; and the noise of the difference quotient that locates an extremum, an ulp
      // of ln|tr| (1.8e-15 from 8 to 16) over 1e-5 of two rows, divided by the curvature
      const double d = .02 * want.gamma;
      const auto three = run(shear(row.set, row.e, row.p0, {want.gamma - d, want.gamma, want.gamma + d}, 1e-13));
      const double curvature =
          std::abs(value(three, 1, row.column) - 2 * value(three, 2, row.column) + value(three, 3, row.column)) /
          (d * d);
      const double noise = 1.8e-15 * want.value / (1e-5 * 2 * row.until / 200);
      CHECK(std::abs(at(found[i], "shear_strain") - want.gamma) < 1e-10 + noise / curvature);
      CHECK(found[i].value == Approx(want.value).epsilon(ode));
      // off the extremum the other columns carry the error of its place: 5e-11 of strain and a slope of 50 p0
      if (want.p > 0) CHECK(at(found[i], "pressure") == Approx(want.p).epsilon(5e-9));
      if (want.zz < 0) CHECK(at(found[i], "stress_zz") == Approx(want.zz).epsilon(5e-9));
    }
  }
  // the minimum of p at e = 0.80 comes with tau = 20065.340791
  const auto test = shear(T1, .8, 1e5, equal_rows(.1, 200), 1e-13);
  const auto record = run([&] {
    auto t = test;
    t.row_times = {0, 0.0217078631};
    t.until.time = 0.0217078631;
    return t;
  }());
  CHECK(last(record, "shear_stress") == Approx(20065.340791).epsilon(5e-9));
}

TEST_CASE("The peak of undrained shear vanishes at a void ratio of 0.82720", "[paths]") {
  // reference: 0.82720(1). Rows of 1e-4 resolve the pair of extrema, some 6e-4 apart 2e-5 away from the threshold.
  CHECK(extrema(shear(T1, .82718, 1e5, equal_rows(.03, 300)), "shear_stress").empty());
  CHECK(extrema(shear(T1, .82722, 1e5, equal_rows(.03, 300)), "shear_stress").size() == 2);
}

TEST_CASE("Undrained shear ends in the steady state that algebra predicts", "[paths]") {
  const struct {
    const Set& set;
    double e, tr;
    SymTensor<double> sigma;
    double p;
  } rows[]{{T1, .89, 8665.830191, plane(-3078.968236, -2486.513819, -3100.348136, 1521.781225), 2888.610064},
           {T1, .865, 49886.1505, plane(-17724.54219, -14313.98953, -17847.61879, 8760.361734), 16628.71683},
           {T1, .845, 85260.49115, plane(-30293.04039, -24464.05997, -30503.39079, 14972.34676), 28420.16372},
           {T1, .83, 113381.7363, plane(-40284.51481, -32532.97699, -40564.24453, 19910.63681), 37793.91211},
           {T1, .825, 123086.9428, plane(-43732.77329, -35317.72231, -44036.44721, 21614.93988), 41028.98094},
           {T1, .82, 132967.873, plane(-47243.46639, -38152.88858, -47571.51804, 23350.10128), 44322.62433},
           {T1, .8, 174384.4208, plane(-61958.75993, -50036.66846, -62388.99241, 30623.14072), 58128.14027},
           {T1, .75, 294208.2594, plane(-104532.1528, -84418.09804, -105258.0086, 51665.05637), 98069.4198},
           {T1, .7, 448038.4317, plane(-159187.9911, -128557.0716, -160293.369, 78678.72532), 149346.1439},
           {T2, .908, 231.4263992, plane(-83.25579175, -64.44718773, -83.72341974, 36.77925513), 77.14213307}};
  for (const auto& row : rows) {
    CAPTURE(row.set.name, row.e);
    const Steady end = steady(row.set, row.e);
    CHECK(end.t == Approx(row.tr).epsilon(1e-9));  // ten digits printed
    CHECK(distance(end.sigma, row.sigma) < 1e-9);
    CHECK(pressure(end.sigma) == Approx(row.p).epsilon(1e-9));
    // independent of the pressure at the start; the slowest mode decays like exp(-1.1 gamma), so 40 are enough
    for (const double p0 : {0.05 * row.p, 3 * row.p}) {
      const auto record = run(shear(row.set, row.e, p0, {40}, rtol, Method::bdf));
      CHECK(distance(stress_at(record, 1), end.sigma) < ode);
    }
  }
  for (const double e : {1.169, 1.070, 0.984}) CHECK(steady(T2, e).t == 0);  // these liquefy completely
}

TEST_CASE("Near zero pressure undrained shear grows or decays exponentially", "[paths]") {
  const struct {
    const Set& set;
    double e, slope;
  } rows[]{{T2, .984, -8.25502441}, {T2, 1.070, -18.58584458}, {T2, 1.169, -30.22650152},
           {T2, .908, 1.04998397},  {T1, .89, 1.57893913},     {T1, .98, -23.47872103}};
  for (const auto& row : rows) {
    CAPTURE(row.set.name, row.e);
    // from 1e-30 Pa, far below any pressure that e_crt could feel; the direction has settled after gamma = 3
    const auto record = run(shear(row.set, row.e, 1e-30, {3, 4}));
    const double slope = value(record, 2, "ln_trace") - value(record, 1, "ln_trace");
    CHECK(std::abs(slope - row.slope) < 1.5e-8);  // eight decimals, and twice rtol |ln tr| over the interval
  }
  // ln(|tr|/kPa) of T2, e = 0.984, from 500 Pa
  const auto record = run(shear(T2, .984, 500, {1, 10, 50}));
  const auto ln_kPa = [&](std::size_t row) { return value(record, row, "ln_trace") - std::log(1000.0); };
  // the trace of the reference row at gamma = 1 above; the second list of the reference prints 9.30935657, 5e-8 off its
  // own row, so it is met to seven decimals only
  CHECK(std::abs(ln_kPa(1) - std::log((0.03249763696982 + 0.02540332644073 + 0.03267183544767) / 1e3)) < ode);
  CHECK(std::abs(ln_kPa(1) + 9.3093566) < 1e-7);
  CHECK(std::abs(ln_kPa(2) + 83.604635) < 1e-6);  // six decimals
  CHECK(std::abs(ln_kPa(3) + 413.805612) < 1e-6);
}

TEST_CASE("The statements of the paper on undrained shear are those of the law", "[paths]") {
  // Sect. 4.1: 0.890 and 0.865 liquefy or soften, 0.845 ends slightly below its peak, denser ones have no peak to speak
  // of. Percentages from the peaks and steady states above: 89, 42, 6.1, 0, 0.05, 1.4.
  const struct {
    double e, loss;
    const char* response;
  } rows[]{{.890, 87, "liquefaction"}, {.865, 42, "softening"}, {.845, 6.1, "limited liquefaction"},
           {.80, 0, "dilative"},       {.75, 0.05, "dilative"}, {.70, 1.4, "dilative"}};
  for (const auto& row : rows) {
    CAPTURE(row.e);
    const auto record = run(shear(T1, row.e, 1e5, equal_rows(1, 1000), 1e-9));
    CHECK(record.response == row.response);
    const double loss = 100 * (1 - last(record, "shear_stress") / record.peak.value);
    CHECK(std::abs(loss - row.loss) < (row.loss < 1 ? 0.005 : row.loss < 10 ? 0.05 : 0.5));  // digits of the percentage
  }
  // residual strength of e = 0.890 at gamma = 0.2, 0.5, 1 in kPa (two decimals)
  const auto record = run(shear(T1, .89, 1e5, {.2, .5, 1}));
  CHECK(std::abs(value(record, 1, "shear_stress") / 1e3 - 4.27) < .005);
  CHECK(std::abs(value(record, 2, "shear_stress") / 1e3 - 2.52) < .005);
  CHECK(std::abs(value(record, 3, "shear_stress") / 1e3 - 1.85) < .005);
}

TEST_CASE("The residual stresses of Table 3 are met within the rounding of its coefficients", "[paths]") {
  const double xz_printed = 36.5, zz_printed = 83.2;
  const Steady end = steady(T2, .908);
  CHECK(end.sigma.xz == Approx(36.77925513).epsilon(1e-9));
  CHECK(-end.sigma.zz == Approx(83.72341974).epsilon(1e-9));
  CHECK(std::abs(end.sigma.xz / xz_printed - 1) < 0.01);
  CHECK(std::abs(-end.sigma.zz / zz_printed - 1) < 0.01);
  double xz[2]{1e9, 0}, zz[2]{1e9, 0};
  for (int corner = 0; corner < 8; ++corner) {
    Set set = T2;
    set.c2 += (corner & 1) ? .05 : -.05;
    set.c3 += (corner & 2) ? .05 : -.05;
    set.c4 += (corner & 4) ? .05 : -.05;
    const Steady s = steady(set, .908);
    xz[0] = std::min(xz[0], s.sigma.xz), xz[1] = std::max(xz[1], s.sigma.xz);
    zz[0] = std::min(zz[0], -s.sigma.zz), zz[1] = std::max(zz[1], -s.sigma.zz);
  }
  CHECK((xz[0] < xz_printed && xz_printed < xz[1]));
  CHECK((zz[0] < zz_printed && zz_printed < zz[1]));
  CHECK(std::abs(xz[0] - 35.5) < .05);  // the band, one decimal
  CHECK(std::abs(xz[1] - 38.1) < .05);
  CHECK(std::abs(zz[0] - 80.7) < .05);
  CHECK(std::abs(zz[1] - 86.7) < .05);

  // what the printed numbers do not come from; two decimals
  const Calibration c = calibrate(150, 0, 23 * std::numbers::pi / 180, 0);
  Set exact = T2;
  exact.c2 = c.c2, exact.c3 = c.c3, exact.c4 = c.c4;
  const auto check = [](const Steady& s, double want_zz, double want_xz) {
    CHECK(std::abs(-s.sigma.zz - want_zz) < .005);
    CHECK(std::abs(s.sigma.xz - want_xz) < .005);
  };
  check(steady(exact, .908), 85.46, 37.54);                              // coefficients before rounding
  check(steady(T2, 1 / .524 - 1), 79.77, 35.04);                         // e from the solid fraction instead
  check(steady(T2, .908, {0, 0, .5, 0, 0, 0, .5, 0, 0}), 83.96, 36.99);  // without the spin
  Set mean = T2;
  mean.p3 /= 3, mean.q3 /= 3;
  check(steady(mean, .908), 251.17, 110.34);  // the mean stress in place of the trace
}

TEST_CASE("The end of undrained shear does not remember its start", "[paths]") {
  const Steady end = steady(T2, .908);
  for (const SymTensor<double>& start :
       {isotropic(-5.0), isotropic(-1500.0), SymTensor<double>{-250, -250, -500, 0, 0, 0}}) {
    const auto law = law_of(T2, .908);
    const auto record = run(path(law, .908, simple_shear_flow, start, {5, 40}, rtol, Method::bdf));
    CHECK(distance(stress_at(record, 2), end.sigma) < ode);
  }
  const auto record = run(shear(T2, .908, 500, {5}));  // gamma = 5: 83.913 and 36.862
  CHECK(std::abs(-last(record, "stress_zz") - 83.913) < 5e-4);
  CHECK(std::abs(last(record, "shear_stress") - 36.862) < 5e-4);
}

TEST_CASE("Drained simple shear ends at one void ratio whatever it began with", "[paths]") {
  const struct {
    const Set& set;
    double p0, e0, e_star, ratio;
  } rows[]{{T4, 1000, .98, 0.8956538207, .49424185},
           {T4, 1000, .80, 0.8956538207, .49424185},
           {T1, 1e5, .70, 0.7555579138, .49084205},
           {T2, 500, .984, 0.8689456778, .43929471}};
  for (const auto& row : rows) {
    CAPTURE(row.set.name, row.e0);
    const auto record = run(drained_shear(row.set, row.e0, row.p0, {1, 40}, rtol, Method::bdf));
    REQUIRE(record.status == Status::done);
    CHECK(std::abs(last(record, "void_ratio") - row.e_star) < 1e-9);            // ten decimals; ODE tolerance 1e-9
    CHECK(std::abs(last(record, "shear_stress") / row.p0 - row.ratio) < 6e-9);  // eight decimals, ODE tolerance
    CHECK(value(record, 1, "stress_zz") == -row.p0);                            // held exactly, not to a tolerance
    // algebra: the critical void ratio of the mode at |tr| = p0/r_zz
    const auto law = law_of(row.set, 1);
    const auto state = stationary_state(law, simple_shear_flow);
    const double e_star = critical_void_ratio(law.critical, state.I_star, row.p0 / state.r.zz);
    CHECK(std::abs(last(record, "void_ratio") - e_star) < 1e-9);
  }
  const struct {
    const Set& set;
    double p0, e0, gamma, ratio;
  } peaks[]{{T4, 1000, .80, .0463, .582017}, {T1, 1e5, .70, .0503, .574171}};
  for (const auto& row : peaks) {
    CAPTURE(row.set.name);
    const auto found = extrema(drained_shear(row.set, row.e0, row.p0, equal_rows(.2, 200)), "shear_stress");
    REQUIRE(found.size() == 1);
    CHECK(found[0].maximum);
    // the reference is the largest of rows some 1e-3 apart: the path has that value there (six decimals), and the
    // located peak is at most curvature (1e-3/2)^2/2 = 5e-6 above it (curvature 37 p0, measured)
    CHECK(std::abs(last(run(drained_shear(row.set, row.e0, row.p0, {row.gamma})), "shear_stress") / row.p0 -
                   row.ratio) < 5e-7);
    CHECK(found[0].value / row.p0 > row.ratio);
    CHECK(found[0].value / row.p0 < row.ratio + 5e-6);
  }
}

TEST_CASE("With the density factor frozen at 1 simple shear contracts for ever", "[paths]") {
  const struct {
    const Set& set;
    double contraction, ratio;
  } rows[]{{T1, -.0954, .4252}, {T2, -.1154, .3735}, {T4, -.0941, .4287}, {PILE, -.1255, .3489}};
  for (const auto& row : rows) {
    CAPTURE(row.set.name);
    Set set = row.set;
    set.q1 = 1, set.q2 = 0;  // a = 1, so I_e = 1
    const auto record = run(drained_shear(set, .9, 1000, {1, 2}));
    const double slope = value(record, 2, "volumetric_strain") - value(record, 1, "volumetric_strain");
    CHECK(std::abs(slope - row.contraction) < 5e-5);  // four decimals
    CHECK(std::abs(last(record, "shear_stress") / 1000 - row.ratio) < 5e-5);
  }
}

TEST_CASE("Drained triaxial compression holds its cell pressure exactly and ends in the critical state", "[paths]") {
  // (K, I*) of isochoric triaxial compression
  const struct {
    const Set& set;
    double e0, K, I_star;
  } rows[]{{T1, .7, 2.45445912, 1.00002984}, {T2, .9, 2.28259072, .99991685}, {T4, .98, 2.46432317, 1.00025131}};
  for (const auto& row : rows) {
    CAPTURE(row.set.name);
    auto test = path(law_of(row.set, row.e0), row.e0, {0, 0, 0, 0, 0, 0, 0, 0, -1}, isotropic(-1000.0), {.1, 1, 8},
                     rtol, Method::bdf, StateForm::stress);
    test.kind = element::Kind::triaxial;
    test.columns.axial = true;
    test.control.held = {0, 1};
    test.control.held_stress = test.initial_stress;
    const auto record = run(test);
    REQUIRE(record.status == Status::done);
    for (std::size_t i = 0; i < record.rows(); ++i) {
      CHECK(value(record, i, "stress_xx") == -1000);
      CHECK(value(record, i, "stress_yy") == -1000);
      CHECK(value(record, i, "stress_xz") == 0);
    }
    CHECK(std::abs(last(record, "stress_zz") / -1000 - row.K) < 1e-8);  // eight decimals
    CHECK(std::abs(last(record, "I_e") - row.I_star) < 1e-8);
    CHECK(last(record, "axial_strain") == Approx(-8).epsilon(1e-12));
  }
}
