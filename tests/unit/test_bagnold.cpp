// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "tests/materials.hpp"

using namespace grainlaw;
using namespace grainlaw::testing;

namespace {

constexpr double degree = std::numbers::pi / 180;
const Bagnold beads{0.0065, 27 * degree};  // Table 3, C = 0.524, and Table 2 of Peng et al.
SymTensor<double> stress_in(const Bagnold& law, const Tensor<double>& L) {
  return law.stress(Flow<double>{L, 0}, Bagnold::State<double>{});
}

}  // namespace

TEST_CASE("The collisional stress has its reference values", "[bagnold]") {
  // two independent codes, 14 digits; 1e-12: rounding of a handful of products
  CHECK(distance(stress_in(beads, general_flow), {-0.015104799153919, -0.028324804196782, -0.018409800414635,
                                                  0.0070231276790212, 0.0033050012607158, 0.0016525006303579}) < 1e-12);
  const double p = 5.1027873143134;
  CHECK(distance(stress_in(beads, {0, 0, 20, 0, 0, 0, 0, 0, 0}), {-p, -p, -p, 0, 2.6, 0}) < 1e-12);
  CHECK(second_invariant(symmetric(general_flow)) == Approx(0.403958333333333).epsilon(1e-14));  // all digits printed
  // simple shear, gamma_dot = 3, k_v = 1, tan alpha = 1: Eqs 8 and 9 give 9 and 9; other readings of the norm do not
  const auto nine = stress_in({1, 45 * degree}, {0, 0, 3, 0, 0, 0, 0, 0, 0});
  CHECK(distance(nine, {-9, -9, -9, 0, 9, 0}) < 1e-15);
}

TEST_CASE("The collisional stress is quadratic in the rate, blind to dilation and spin", "[bagnold]") {
  const auto base = stress_in(beads, general_flow);
  CHECK(identical(stress_in(beads, 128.0 * general_flow), 16384.0 * base));  // powers of two: exact
  CHECK(distance(stress_in(beads, 100.0 * general_flow), 1e4 * base) < 1e-15);
  const Tensor<double> spin_and_dilation{5, 3, 0, -3, 5, 0, 0, 0, 5};
  CHECK(distance(stress_in(beads, general_flow + spin_and_dilation), base) < 1e-14);  // cancellation against 5
  CHECK(norm(stress_in(beads, {})) == 0);
  CHECK(norm(stress_in(beads, {1, 0, 0, 0, 1, 0, 0, 0, 1})) < 1e-30);  // quadratic in the rounding of D'
  Dice dice(1);
  for (int i = 0; i < 200; ++i) {
    const Tensor<double> L = dice.tensor(), q = dice.turn();
    const SymTensor<double> D = rotated(symmetric(L), q);
    const Tensor<double> turned{D.xx, D.xy, D.xz, D.xy, D.yy, D.yz, D.xz, D.yz, D.zz};
    CHECK(distance(stress_in(beads, turned), rotated(stress_in(beads, L), q)) < 1e-14);  // objectivity, rounding
  }
}

TEST_CASE("The collisional viscosity is the slope of the flow curve", "[bagnold]") {
  const Flow<double> flow{{0, 0, 20, 0, 0, 0, 0, 0, 0}, 0};
  CHECK(beads.viscosity(flow, Bagnold::State<double>{}) == Approx(2 * 0.0065 * 20).epsilon(1e-15));  // d(k_v g^2)/dg
  // sqrt(p/rho), p from the reference row above
  CHECK(beads.wave_speed(flow, Bagnold::State<double>{}, 570.0) ==
        Approx(std::sqrt(5.1027873143134 / 570)).epsilon(1e-13));
}

TEST_CASE("Bagnold's formula gives the collisional coefficients of the printed table", "[bagnold]") {
  // rho_s = 1095 kg/m^3, d = 1 mm; solid fractions and printed k_v of Table 3
  const double C[]{0.461, 0.483, 0.504, 0.524}, printed[]{0.0018, 0.0027, 0.0041, 0.0065};
  const struct {
    double A, C_max, k_v[4];
  } rows[]{{0.016410707396549498, 0.6114, {0.00184503, 0.00268898, 0.00406225, 0.00645434}},
           {0.01585, 0.6093, {0.00182835, 0.00267772, 0.00407176, 0.00652903}},
           {0.016, 0.61, {0.00182984, 0.00267549, 0.00405942, 0.00648909}}};
  for (const auto& row : rows) {
    for (int i = 0; i < 4; ++i) {
      CAPTURE(row.A, C[i]);
      const double k_v = bagnold_coefficient(row.A, 1095, 1e-3, C[i], row.C_max);
      CHECK(std::abs(k_v - row.k_v[i]) <= 0.5e-8);  // half a unit of the reference's last digit
      CHECK(std::abs(k_v - printed[i]) <= 0.5e-4);  // half a unit of the paper's last digit
    }
  }
  CHECK(bagnold_coefficient(0.016, 1095, 1e-3, 0.61, 0.61) == unbounded);
  CHECK(bagnold_coefficient(0.016, 1095, 1e-3, 0.62, 0.61) == unbounded);
  // closed form: C = C_max/8 gives a spacing of 2 - 1 = 1 diameter, k_v = A rho d^2
  CHECK(bagnold_coefficient(0.5, 1000, 2, 0.075, 0.6) == Approx(2000).epsilon(1e-14));
}

TEST_CASE("The unified law adds collisions to the skeleton", "[bagnold]") {
  const HypoplasticBagnold<> both{law_of(T2, 0.908), beads};
  const SymTensor<double> sigma{-300, -220, -410, 35, 120, -20};
  const Flow<double> flow{general_flow, 0};
  const HypoplasticBagnold<>::State<double> state{sigma};
  CHECK(identical(both.stress(flow, state), sigma + beads.collisional(flow)));
  CHECK(identical(both.rate(flow, state).sigma, both.skeleton.rate(flow, {sigma}).sigma));
  CHECK(distance(both.stress(flow, both.start(flow, sigma)), sigma) < 1e-15);  // start is the inverse of stress
  const HypoplasticBagnold<CriticalState, LogForm> log_form{law_of<LogForm>(T2, 0.908), beads};
  CHECK(distance(log_form.stress(flow, log_form.start(flow, sigma)), sigma) < 1e-14);  // exp(log(x)): |ln x| ulps
  // an absent part costs nothing
  STATIC_REQUIRE(sizeof(HypoplasticBagnold<CriticalState, StressForm, NoCollisions>) == sizeof(Hypoplastic<>));
  STATIC_REQUIRE(sizeof(Hypoplastic<NoCriticalState>) == 5 * sizeof(double));
}
