// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "rheology/laws.hpp"
#include "tests/materials.hpp"

using namespace grainlaw;
using namespace grainlaw::testing;

namespace {

constexpr Tensor<double> dilation{1, 0, 0, 0, 1, 0, 0, 0, 1};

SymTensor<double> stress_rate(const Set& set, double e, const SymTensor<double>& sigma, const Tensor<double>& L) {
  return law_of(set, e).rate(Flow<double>{L, 0}, {sigma}).sigma;
}
/// The stress rate that the logarithmic state implies: sigma = -T (s + I/3), T = exp(ln|tr|).
SymTensor<double> stress_rate_of_log(const Set& set, double e, const SymTensor<double>& sigma,
                                     const Tensor<double>& L) {
  const auto law = law_of<LogForm>(set, e);
  const Flow<double> flow{L, 0};
  const auto k = law.rate(flow, law.start(flow, sigma));
  return k.ln_trace * sigma + trace(sigma) * k.s();
}
/// Smallest principal compression, relative to the pressure.
double least_compression(const SymTensor<double>& a) {
  const Eigen::Matrix3d m = (Eigen::Matrix3d() << a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz).finished();
  return -Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m).eigenvalues()[2] / pressure(a);
}

const SymTensor<double> dense_sand{-1.2e5, -.9e5, -1.5e5, 1.1e4, 2.5e4, -.8e4};
const SymTensor<double> beads{-300, -220, -410, 35, 120, -20};

}  // namespace

TEST_CASE("The stress rate has its reference values in both state forms", "[hypoplastic]") {
  const Tensor<double> none{};
  const struct {
    const char* name;
    const Set& set;
    double e;
    SymTensor<double> sigma;
    Tensor<double> L;
    double I_e;
    SymTensor<double> rate;
  } rows[]{
      {"E1 simple shear",
       T1,
       .845,
       isotropic(-1e5),
       simple_shear_flow,
       1.104906284718989,
       {16396604.10015572, 16396604.10015572, 16396604.10015572, 0, 7500000, 0}},
      {"E2 general",
       T1,
       .80,
       dense_sand,
       general_flow,
       1.079304332265153,
       {26365866.81977183, -341565.3739431518, 32763912.7143366, 3711175.043728492, -4778157.33629431,
        4849263.811405651}},
      {"E3 beads",
       T2,
       .984,
       beads,
       general_flow,
       0.9339600954319592,
       {47245.38309222639, -15101.70390351417, 68134.20606623853, 9368.275470374666, -24437.52288531921,
        9999.663716824293}},
      {"E4 triaxial",
       T4,
       .98,
       {-1000, -1000, -2500, 0, 0, 0},
       triaxial_compression_flow,
       1.00233311412565,
       {-9087.887418522712, -9087.887418522712, -9116.554784900879, 0, 0, 0}},
      {"E5 expansion", T1, .845, isotropic(-1e5), dilation, 1.104906284718989, isotropic(118123313.559808)},
      {"E6 compression", T1, .845, isotropic(-1e5), -1.0 * dilation, 1.104906284718989, isotropic(-37796686.44019195)},
      {"E7 spin",
       T1,
       .80,
       dense_sand,
       {0, 0, 2, 0, 0, 0, -2, 0, 0},
       1.079304332265153,
       {100000, 0, -100000, 16000, -60000, 22000}},
      {"E8 rest", T1, .80, dense_sand, none, 1.079304332265153, {}}};
  for (const auto& row : rows) {
    CAPTURE(row.name);
    // algebra of some hundred operations on numbers that partly cancel: 1e-12 of the rate (two codes agree to 1e-13)
    const double allowed = 1e-12 * norm(row.rate);
    CHECK(norm(stress_rate(row.set, row.e, row.sigma, row.L) - row.rate) <= allowed);
    CHECK(norm(stress_rate_of_log(row.set, row.e, row.sigma, row.L) - row.rate) <= allowed);
    CHECK(law_of(row.set, row.e).critical.I_e(0.0, -trace(row.sigma)) == Approx(row.I_e).epsilon(1e-14));
  }
}

TEST_CASE("The density factor has its reference values", "[hypoplastic]") {
  const struct {
    const Set& set;
    double tr, e, I_e, a, e_crt, D_c;
  } rows[]{{T1, -300000.0, 0.89, 1.19437726220378, 0.611821786580597, 0.792236713568295, -0.500742327838387},
           {T1, -300000.0, 0.7, 0.816610912823558, 0.611821786580597, 0.792236713568295, 0.472435290896403},
           {T1, -1000.0, 0.89, 0.906662508249489, 0.600039998000067, 0.979190728562797, 0.233367064915972},
           {T2, -1500.0, 1.169, 1.0223984210179, 0.76463466515472, 1.11634153724835, -0.0951644855969158},
           {T2, -231.4263992147, 0.908, 0.893189713237522, 0.760720965294129, 1.18617541499525, 0.446383808317234},
           {T4, -4500.0, 0.98, 1.00233311412565, 0.600179959506074, 0.977778003977193, -0.00583541065817539}};
  for (const auto& row : rows) {
    CAPTURE(row.set.name, row.tr, row.e);
    const auto critical = law_of(row.set, row.e).critical;
    const double t = -row.tr;
    CHECK(critical.I_e(0.0, t) == Approx(row.I_e).epsilon(2e-14));  // printed with 15 digits; an ulp of exp
    CHECK(critical.a(t) == Approx(row.a).epsilon(2e-14));
    CHECK(critical.e_crt(t) == Approx(row.e_crt).epsilon(2e-14));
    CHECK(std::abs(critical.D_c(0.0, t) - row.D_c) < 1e-14);  // e_crt - e cancels: absolute
    // closed form: rho/rho_ref = (1 + e_ref)/(1 + e), so half the compaction to e = 0.6 is found from e_ref
    CHECK(critical.void_ratio((1 + row.e) / 1.6 - 1) == Approx(0.6).epsilon(1e-14));
    CHECK(critical.void_ratio(0.0) == row.e);
  }
}

TEST_CASE("The density factor is clamped and reported outside its range", "[hypoplastic]") {
  const Flow<double> rest{};
  // below e_min D_c stays 1, so that I_e = a
  const auto dense = law_of(T1, 0.55);
  CHECK(dense.critical.D_c(0.0, 1e5) == 1);
  CHECK(dense.critical.I_e(0.0, 1e5) == Approx(dense.critical.a(1e5)).epsilon(1e-15));
  CHECK(dense.admit(rest, {isotropic(-1e5)}).reasons == beyond_validity);
  CHECK(law_of(T1, 0.6).admit(rest, {isotropic(-1e5)}).reasons == 0);
  // the pole e_crt = e_min: |tr| = 1058.086 kPa (T1) and 1731.414 kPa (T4), seven digits printed
  for (const auto& [set, pole] : {std::pair{T1, 1058.086e3}, {T4, 1731.414e3}}) {
    const auto law = law_of(set, 0.8);
    CHECK(law.critical.e_crt(pole) == Approx(set.e_min).epsilon(1e-6));
    CHECK(law.admit(rest, {isotropic(-0.99 * pole / 3)}).reasons == 0);
    CHECK(law.admit(rest, {isotropic(-1.01 * pole / 3)}).reasons == beyond_validity);
    CHECK(std::isfinite(law.critical.I_e(0.0, pole)));
    CHECK(std::isfinite(law.critical.I_e(0.0, 10 * pole)));
  }
}

TEST_CASE("Isotropic strain changes the pressure at the reference rates", "[hypoplastic]") {
  // closed form at I_e = 1: d ln p/d|eps_v| = +-(c1 + c2/3) + c3/(3 sqrt 3); the reference prints integers
  const struct {
    const Set& set;
    double expansion, compression;
  } rows[]{{T1, -381, 139}, {T2, -443, 155}, {T4, -505, 184}};
  for (const auto& [set, expansion, compression] : rows) {
    CAPTURE(set.name);
    const auto law = frozen(set, 1);
    const auto growth = [&](double sign) {  // the volume changes by 3 in unit time
      return law.rate(Flow<double>{sign * dilation, 0}, {isotropic(-1.0)}).sigma.xx / (-1.0 * 3);
    };
    const double linear = set.c1 + set.c2 / 3, nonlinear = set.c3 / (3 * std::sqrt(3.0));
    CHECK(growth(1) == Approx(linear + nonlinear).epsilon(1e-13));
    CHECK(growth(-1) == Approx(-linear + nonlinear).epsilon(1e-13));
    CHECK(std::abs(growth(1) - expansion) < 0.5);
    CHECK(std::abs(growth(-1) - compression) < 0.5);
  }
}

/// One compiled body: two inlined copies may contract multiplications and additions differently.
template <class L>
[[gnu::noinline]] typename L::template State<double> rate_of(const L& law, const Flow<double>& flow,
                                                             const typename L::template State<double>& state) {
  return law.rate(flow, state);
}

TEST_CASE("The rate is homogeneous, odd and objective", "[hypoplastic]") {
  Dice dice(10);
  double turning = 0, forms = 0;
  for (int i = 0; i < 1000; ++i) {
    const SymTensor<double> sigma = -dice(1, 1e5) * dice.compressive();
    const Tensor<double> L = dice.tensor();
    const Flow<double> flow{L, 0};
    const auto law = frozen(T1, 1.1);
    const auto rate = rate_of(law, flow, {sigma}).sigma;
    // degree 1 in the stress at equal I_e, and in the rate: exact for powers of two, whatever the pressure
    for (const double k : {0x1p-300, 0x1p-20, 0x1p20}) {
      const SymTensor<double> scaled = k * sigma;
      CHECK(identical(rate_of(law, flow, {scaled}).sigma, k * rate));
    }
    const Flow<double> fast{4.0 * L, 0};
    CHECK(identical(rate_of(law_of(T1, .8), fast, {sigma}).sigma, 4.0 * rate_of(law_of(T1, .8), flow, {sigma}).sigma));
    CHECK(identical(rate_of(law, flow, {-1.0 * sigma}).sigma, -1.0 * rate));
    // Q, Omega: sigma' = Q sigma Q^T, L' = Q L Q^T + Omega => rate' = Q rate Q^T + Omega sigma' - sigma' Omega
    const Tensor<double> q = dice.turn(), w = dice.tensor();
    const Tensor<double> omega{0, w.xy, w.xz, -w.xy, 0, w.yz, -w.xz, -w.yz, 0};
    const SymTensor<double> D = rotated(symmetric(L), q);
    const auto mixed = [&](const Tensor<double>& a) {  // Q a Q^T of a general tensor, column by column
      const SymTensor<double> s = rotated(symmetric(a), q);
      const double x = 0.5 * (a.zy - a.yz), y = 0.5 * (a.xz - a.zx), z = 0.5 * (a.yx - a.xy);
      const double X = q.xx * x + q.xy * y + q.xz * z, Y = q.yx * x + q.yy * y + q.yz * z,
                   Z = q.zx * x + q.zy * y + q.zz * z;
      return Tensor<double>{s.xx, s.xy - Z, s.xz + Y, s.xy + Z, s.yy, s.yz - X, s.xz - Y, s.yz + X, s.zz};
    };
    const SymTensor<double> turned = rotated(sigma, q);
    const auto full = law_of(T1, .8);
    const Flow<double> seen{mixed(L) + omega, 0};
    const auto observed = full.rate(seen, {turned}).sigma;
    const auto expected = rotated<double>(full.rate(flow, {sigma}).sigma, q) + spin_rate(omega, turned);
    turning = std::max(turning, norm(observed - expected) / (norm(expected) + 1000 * norm(turned) * norm(D)));
    forms = std::max(forms, norm(stress_rate_of_log(T1, .8, sigma, L) - full.rate(flow, {sigma}).sigma) /
                                (1000 * norm(sigma) * norm(D)));
  }
  CHECK(turning < 1e-14);  // rounding, relative to the terms of size |c| |sigma| |D| that cancel
  CHECK(forms < 1e-14);
}

TEST_CASE("At rest and at zero stress nothing moves and nothing breaks", "[hypoplastic]") {
  const auto law = law_of(T1, .8);
  const Flow<double> flow{general_flow, 0};
  CHECK(norm(law.rate(flow, {}).sigma) == 0);
  CHECK(law.admit(flow, {}).reasons == 0);
  CHECK(norm(law.rate(flow, {isotropic(-1e-300)}).sigma) == 0);  // below the smallest number it divides by
  CHECK(law.viscosity(flow, {dense_sand}) == 0);
  CHECK(identical(law.stress(flow, {dense_sand}), dense_sand));
  const auto logarithmic = law_of<LogForm>(T1, .8);
  CHECK(distance(logarithmic.stress(flow, logarithmic.start(flow, dense_sand)), dense_sand) < 1e-14);  // |ln x| ulps
  CHECK(trace(logarithmic.start(flow, dense_sand).s()) == 0);  // by construction, exactly
}

TEST_CASE("Admit leaves admissible states alone, bit by bit", "[hypoplastic]") {
  Dice dice(11);
  const auto law = law_of(T1, .8);
  const auto logarithmic = law_of<LogForm>(T1, .8);
  const Flow<double> flow{};
  for (int i = 0; i < 2000; ++i) {
    const SymTensor<double> sigma = -std::exp(dice(-30, 12)) * dice.compressive();
    const auto admitted = law.admit(flow, {sigma});
    CHECK(admitted.reasons == 0);
    CHECK(identical(admitted.state.sigma, sigma));
    const auto start = logarithmic.start(flow, sigma);
    const auto kept = logarithmic.admit(flow, start);
    CHECK(kept.reasons == 0);
    CHECK(kept.state.ln_trace == start.ln_trace);
    CHECK(identical(kept.state.s(), start.s()));
  }
}

TEST_CASE("Admit brings any finite stress into the compressive cone and keeps its pressure", "[hypoplastic]") {
  Dice dice(12);
  Hypoplastic<> law = law_of(T1, .8);
  law.p_floor = 10;
  Hypoplastic<CriticalState, LogForm> logarithmic = law_of<LogForm>(T1, .8);
  logarithmic.p_floor = 10;
  const Flow<double> flow{};
  int tensile = 0, low = 0;
  const auto check = [&](const SymTensor<double>& sigma) {
    const auto admitted = law.admit(flow, {sigma});
    const SymTensor<double>& after = admitted.state.sigma;
    const double p = pressure(sigma), q = std::max(p, 10.0);
    const bool pulls = !(p > 0 && least_compression(sigma) > 0);
    tensile += pulls;
    low += p < 10;
    if (p > 0) CHECK(((admitted.reasons & tension) != 0) == pulls);  // p < 0 counts as pressure_floor, at least
    CHECK(((admitted.reasons & pressure_floor) != 0) == (p < 10));
    CHECK(pressure(after) == Approx(q).epsilon(1e-14));
    // "the deviator is scaled back onto 99.9 % of the cone": never beyond, and no further than that. 1e-6 covers the
    // half of the digits that a double eigenvalue has.
    CHECK(least_compression(after) > 0.001 - 1e-6);
    if (pulls && p >= 10) CHECK(least_compression(after) < 0.001 + 1e-6);
    const SymTensor<double> s = deviator(sigma), s_after = deviator(after);
    CHECK(norm(norm(s) * s_after - norm(s_after) * s) < 1e-11 * norm(s) * norm(s) + 1e-300);  // same direction
    if (trace(sigma) < 0) {
      const auto kept = logarithmic.admit(flow, logarithmic.start(flow, sigma));
      CHECK(((kept.reasons & tension) != 0) == pulls);
      CHECK(least_compression(logarithmic.stress(flow, kept.state)) > 0.001 - 1e-6);
    }
  };
  SECTION("random stresses") {
    for (int i = 0; i < 2000; ++i) check(std::exp(dice(0, 10)) * (dice.symmetric_tensor() + isotropic(dice(-1, .3))));
    CHECK(tensile > 500);
    CHECK(low > 200);
  }
  SECTION("axisymmetric stresses, whose deviators have double eigenvalues") {
    for (int i = 0; i < 1000; ++i) {
      const double p = dice(20, 1000), s = dice(1.01, 3) * p;                     // tensile beyond s = p
      check(rotated<double>({s - p, s - p, -2 * s - p, 0, 0, 0}, dice.turn()));   // two directions pull
      check(rotated<double>({-s - p, -s - p, 2 * s - p, 0, 0, 0}, dice.turn()));  // one direction pulls
    }
    CHECK(tensile == 2000);
  }
}

TEST_CASE("The wave speed bounds every direction of loading, and not absurdly", "[hypoplastic]") {
  Dice dice(13);
  double tightest = 0;
  for (const Set& set : {T1, T2, T4, PILE}) {
    for (int i = 0; i < 300; ++i) {
      const auto law = law_of(set, dice(0.7, 1.0));
      const SymTensor<double> sigma = -1000.0 * dice.compressive();
      const double c2 = std::pow(law.wave_speed(Flow<double>{}, {sigma}, 1500.0), 2);
      for (int k = 0; k < 30; ++k) {
        const Tensor<double> q = dice.turn();  // n and a: first and second row mixed
        const double t = dice(0, 6.3);
        const double n[3]{q.xx, q.xy, q.xz};
        const double a[3]{std::cos(t) * q.xx + std::sin(t) * q.yx, std::cos(t) * q.xy + std::sin(t) * q.yy,
                          std::cos(t) * q.xz + std::sin(t) * q.yz};
        const Tensor<double> L{a[0] * n[0], a[0] * n[1], a[0] * n[2], a[1] * n[0], a[1] * n[1],
                               a[1] * n[2], a[2] * n[0], a[2] * n[1], a[2] * n[2]};
        const auto r = law.rate(Flow<double>{L, 0}, {sigma}).sigma;
        const double stiffness = a[0] * (r.xx * n[0] + r.xy * n[1] + r.xz * n[2]) +
                                 a[1] * (r.xy * n[0] + r.yy * n[1] + r.yz * n[2]) +
                                 a[2] * (r.xz * n[0] + r.yz * n[1] + r.zz * n[2]);
        CHECK(stiffness <= c2 * 1500);
        tightest = std::max(tightest, stiffness / (c2 * 1500));
      }
    }
  }
  CHECK(tightest > 0.25);  // the square of the speed is at most four times too large where it matters most
}

namespace {

template <class L, class State>
void check_not_finite(const L& law, const Flow<double>& flow, const State& state) {
  CHECK((law.admit(flow, state).reasons & not_finite) != 0);
}

}  // namespace

TEST_CASE("Whatever is not finite is flagged by every law", "[hypoplastic]") {
  const double bad[]{std::nan(""), unbounded, -unbounded};
  const Flow<double> flow{general_flow, 0.01};
  const auto every_number = [&](const auto& law, const SymTensor<double>& sigma) {
    using L = std::decay_t<decltype(law)>;
    using State = typename L::template State<double>;
    CAPTURE(L::name);
    const State good = law.start(flow, sigma);
    CHECK((law.admit(flow, good).reasons & not_finite) == 0);
    if constexpr (constexpr int n = count<State, double>; n > 0) {
      for (int i = 0; i < n; ++i) {
        for (const double b : bad) {
          CAPTURE(i, b);
          auto numbers = std::bit_cast<std::array<double, std::size_t(n)>>(good);
          numbers[std::size_t(i)] = b;
          check_not_finite(law, flow, std::bit_cast<State>(numbers));
        }
      }
    } else {
      for (int i = 0; i < 9; ++i) {
        for (const double b : bad) {
          CAPTURE(i, b);
          Flow<double> broken = flow;
          int k = 0;
          each(broken.L, [&](double& x) { x = k++ == i ? b : x; });
          check_not_finite(law, broken, good);
        }
      }
    }
  };
  every_number(law_of(T1, .8), dense_sand);
  every_number(law_of<LogForm>(T1, .8), dense_sand);
  every_number(HypoplasticBagnold<>{law_of(T1, .8), {0.01, 0.6}}, dense_sand);
  every_number(HypoplasticBagnold<CriticalState, LogForm>{law_of<LogForm>(T1, .8), {0.01, 0.6}}, dense_sand);
  every_number(Elastic{1e6, 1e6}, dense_sand);
  every_number(Bagnold{0.01, 0.6}, dense_sand);
  every_number(Newtonian{1, 1e6}, dense_sand);
  for (const double b : bad)
    check_not_finite(Newtonian{1, 1e6}, Flow<double>{general_flow, b}, Newtonian::State<double>{});
}
