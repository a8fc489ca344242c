// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "tests/materials.hpp"

using namespace grainlaw;
using namespace grainlaw::testing;

namespace {

constexpr double degree = std::numbers::pi / 180;
// references printed with 12 digits: half a unit of the last one, at worst
constexpr double digits12 = 5e-12;

}  // namespace

TEST_CASE("Calibration gives the reference coefficients", "[calibration]") {
  const struct {
    double E, nu, phi, psi, c1, c2, c3, c4;
  } rows[]{{150, 0, 24.9, 0, -50, -629.617283964, -629.617283964, 1220.78603494},
           {150, 0, 23, 0, -50, -746.546890332, -746.546890332, 1855.12905077},
           {200, 0, 25, 0, -66.6666666667, -832.877667239, -832.877667239, 1594.54849287},
           {150, 0, 22, 0, -50, -832.133454087, -832.133454087, 2369.88240679},
           {150, 0.2, 30, 0, -41.6666666667, -644.371762301, -299.859426774, -736.057392426},
           {300, 0.3, 35, 5, -76.9230769231, -2003.44295066, -546.53122472, -2672.41884456}};
  for (const auto& row : rows) {
    CAPTURE(row.E, row.nu, row.phi, row.psi);
    const Calibration c = calibrate(row.E, row.nu, row.phi * degree, row.psi * degree);
    CHECK(c.c1 == Approx(-row.E / (3 * (1 + row.nu))).epsilon(1e-15));  // closed form
    CHECK(c.c1 == Approx(row.c1).epsilon(digits12));
    CHECK(c.c2 == Approx(row.c2).epsilon(digits12));
    CHECK(c.c3 == Approx(row.c3).epsilon(digits12));
    CHECK(c.c4 == Approx(row.c4).epsilon(digits12));
    CHECK(c.usable == (row.c4 > 0));
  }
}

TEST_CASE("Calibration reproduces the printed sets to their last digit", "[calibration]") {
  const struct {
    const Set& set;
    double E, phi;
  } rows[]{{T1, 150, 24.9}, {T2, 150, 23}, {T4, 200, 25}, {PILE, 150, 22}};
  const double half = 0.05 * (1 + 1e-9);  // half a unit of the printed digit, and its own rounding
  for (const auto& [set, E, phi] : rows) {
    CAPTURE(set.name);
    const Calibration c = calibrate(E, 0, phi * degree, 0);
    // Table 2 prints c2 = c3 = -746.6 where -746.547 rounds to -746.5: a slip of the last digit, allowed there alone
    const double slip = &set == &T2 ? 0.053125 : half;
    CHECK(std::abs(c.c1 - set.c1) <= half);
    CHECK(std::abs(c.c2 - set.c2) <= slip);
    CHECK(std::abs(c.c3 - set.c3) <= slip);
    CHECK(std::abs(c.c4 - set.c4) <= half);
  }
  CHECK(std::abs(calibrate(150, 0, 23 * degree, 0).c2 - T2.c2) > half);  // it is a slip, not a rounding
}

TEST_CASE("A calibrated law has the tangents and the critical state asked for", "[calibration]") {
  for (const auto& [nu, phi, psi] : {std::array{0.0, 25.0, 0.0}, {0.05, 25.0, 0.0}, {0.0, 24.0, 4.0}}) {
    CAPTURE(nu, phi, psi);
    const Calibration c = calibrate(180, nu, phi * degree, psi * degree);
    REQUIRE(c.usable);
    const Hypoplastic<NoCriticalState> law{c.c1, c.c2, c.c3, c.c4, 0, {}};
    const auto rate = [&](double axial, double lateral, double d_axial, double d_lateral) {
      return law
          .rate(Flow<double>{{d_lateral, 0, 0, 0, d_lateral, 0, 0, 0, d_axial}, 0},
                {SymTensor<double>{lateral, lateral, axial, 0, 0, 0}})
          .sigma;
    };
    // drained triaxial compression from p = 1: the lateral strain is nu times the axial one, and d(axial) = E
    const auto first = rate(-1, -1, -1, nu);
    CHECK(first.zz == Approx(-180).epsilon(1e-12));  // algebra of a 3x3 system of condition 1e2-3e2
    CHECK(std::abs(first.xx) < 180e-12);
    // stationary at K = (1 + sin phi)/(1 - sin phi) with the dilatancy of psi
    const double K = (1 + std::sin(phi * degree)) / (1 - std::sin(phi * degree));
    const double d = 0.5 * (1 + std::sin(psi * degree)) / (1 - std::sin(psi * degree));
    CHECK(norm(rate(-K, -1, -1, d)) < 1e-12 * std::abs(c.c2) * K);  // the same, scaled with the terms that cancel
    const FailurePoint f = failure_point(law, 0);
    REQUIRE(f.found);
    CHECK(f.r[0] / f.r[1] == Approx(K).epsilon(1e-12));
    CHECK(-f.flow[1] / f.flow[0] == Approx(d).epsilon(1e-11));  // flow amplifies the rounding of the radius
  }
}

TEST_CASE("The range of useful calibrations is the documented one", "[calibration]") {
  // c4 against nu at phi = 25 deg and against phi at nu = 0, and the I_e of the cone guarantee; digits as printed
  const double E = 150;
  // the series in nu is at c1 = -50: E = 150 (1 + nu)
  CHECK(std::abs(calibrate(E * 1.05, 0.05, 25 * degree, 0).c4 - 773) < 0.5);
  CHECK(std::abs(calibrate(E * 1.10, 0.10, 25 * degree, 0).c4 - 287) < 1);  // 287.54, printed without its decimals
  CHECK(calibrate(E * 1.15, 0.15, 25 * degree, 0).c4 < 0);
  const struct {
    double phi, c4, I_e;
  } rows[]{{22, 2370, 0.19}, {25, 1196, 0.38}, {30, 491, 0.92}, {35, 249, 1.81}, {40, 151, 2.98}};
  for (const auto& row : rows) {
    CAPTURE(row.phi);
    const Calibration c = calibrate(E, 0, row.phi * degree, 0);
    CHECK(std::abs(c.c4 - row.c4) < 0.5);
    CHECK(std::abs(guaranteed_I_e(c.c1, c.c4) - row.I_e) < 0.005);
  }
  const auto c_at = [&](double phi) { return calibrate(E, 0, phi * degree, 0); };
  CHECK(guaranteed_I_e(-50, c_at(27.43).c4) < 0.6);
  CHECK(guaranteed_I_e(-50, c_at(27.45).c4) > 0.6);
  CHECK(guaranteed_I_e(-50, c_at(30.56).c4) < 1);
  CHECK(guaranteed_I_e(-50, c_at(30.58).c4) > 1);
  CHECK(c_at(30.56).c3 + c_at(30.56).c4 > 0);
  CHECK(c_at(30.58).c3 + c_at(30.58).c4 < 0);
  for (const auto& [set, least] : {std::pair{T1, 0.369}, {T2, 0.243}, {T4, 0.377}, {PILE, 0.190}}) {
    const double slack = least - guaranteed_I_e(set.c1, set.c4);  // the reference is rounded up, to the safe side
    CHECK((slack >= 0 && slack < 1e-3));
  }
}

TEST_CASE("Simple shear flows for ever at its own stress ratio and density factor", "[calibration]") {
  const struct {
    const Set& set;
    double xx, yy, zz, xz, I_star, ratio, angle, mobilised;
  } rows[]{{T1, 0.355299857915, 0.286933134422, 0.357767007663, 0.175607090263, 0.911749509489, 0.490842046644,
            26.1437457635, 29.51},
           {T2, 0.359750624954, 0.278478116349, 0.361771258697, 0.158924199036, 0.893189713238, 0.439294706851,
            23.7156298605, 26.14},
           {T4, 0.355335570016, 0.287459642195, 0.357204787788, 0.176545554602, 0.913065229887, 0.494241848479,
            26.3005095203, 29.71},
           {PILE, 0.361475208059, 0.275238813451, 0.363285978490, 0.150445374326, 0.885343926598, 0.414123812187,
            22.4956106273, 24.53}};
  const double printed = 1e-12;  // twelve decimals, and the last bits of Newton's solution
  for (const auto& row : rows) {
    CAPTURE(row.set.name);
    const auto law = law_of(row.set, 1);
    const StationaryState state = stationary_state(law, simple_shear_flow);
    REQUIRE(state.found);
    const SymTensor<double>& r = state.r;
    CHECK(std::abs(r.xx - row.xx) < printed);
    CHECK(std::abs(r.yy - row.yy) < printed);
    CHECK(std::abs(r.zz - row.zz) < printed);
    CHECK(std::abs(-r.xz - row.xz) < printed);  // sigma_xz/|tr| = -r_xz
    CHECK(r.yz == Approx(0).margin(printed));
    CHECK(r.xy == Approx(0).margin(printed));
    CHECK(std::abs(state.I_star - row.I_star) < printed);
    CHECK(std::abs(-r.xz / r.zz - row.ratio) < 3 * printed);                // divided by 0.36
    CHECK(std::abs(std::atan(-r.xz / r.zz) / degree - row.angle) < 2e-10);  // ten decimals of a degree
    const double centre = 0.5 * (r.xx + r.zz), radius = std::hypot(0.5 * (r.xx - r.zz), r.xz);
    CHECK(std::abs(std::asin(radius / centre) / degree - row.mobilised) < 5e-3);  // two decimals
    // it is stationary by the law itself, at a density factor I*
    const auto rate = frozen(row.set, state.I_star).rate(Flow<double>{simple_shear_flow, 0}, {-1.0 * r}).sigma;
    CHECK(norm(rate) < 1e-12 * row.set.c4);  // terms of size c4 cancel
    // multiples of the flow share the state: the law is homogeneous in the rate
    CHECK(distance(stationary_state(law, 7.0 * simple_shear_flow).r, r) < 1e-12);
  }
  CHECK(std::abs(stationary_state(law_of(T2, 1), simple_shear_flow).r.xx /
                     stationary_state(law_of(T2, 1), simple_shear_flow).r.zz -
                 0.994415) < 5e-7);  // sign of the spin
}

TEST_CASE("Triaxial critical states are the reference ones", "[calibration]") {
  const struct {
    const Set& set;
    double K1, d1, K_c, I_c, K_e, I_e, phi_c, phi_e;
  } rows[]{{T1, 2.45454835, .50003633, 2.45445912, 1.00002984, .35955606, .77161225, 24.901, 28.10},
           {T2, 2.28238468, .49989623, 2.28259072, .99991685, .42831035, .69028661, 22.997, 23.59},
           {T4, 2.46508297, .50030576, 2.46432317, 1.00025131, .35580695, .77591419, 25.012, 28.37},
           {PILE, 2.19811889, .50006456, 2.19800407, 1.00005053, .46451359, .64472481, 22.002, 21.45}};
  const double printed = 5e-9 * (1 + 1e-6);  // half a unit of the eighth decimal
  for (const auto& row : rows) {
    CAPTURE(row.set.name);
    const auto law = law_of(row.set, 1);
    const FailurePoint failure = failure_point(law, 0);  // I_e = 1, compression along the first direction
    REQUIRE(failure.found);
    const double K = failure.r[0] / failure.r[1];
    CHECK(std::abs(K - row.K1) < printed);
    CHECK(std::abs(-failure.flow[1] / failure.flow[0] - row.d1) < printed);
    CHECK(failure.r[1] == Approx(failure.r[2]).epsilon(1e-14));
    CHECK(std::abs(std::asin((K - 1) / (K + 1)) / degree - row.phi_c) < 5e-4);  // three decimals
    const auto compression = stationary_state(law, triaxial_compression_flow);
    const auto extension = stationary_state(law, triaxial_extension_flow);
    REQUIRE(compression.found);
    REQUIRE(extension.found);
    CHECK(std::abs(compression.r.zz / compression.r.xx - row.K_c) < printed);
    CHECK(std::abs(compression.I_star - row.I_c) < printed);
    const double K_e = extension.r.zz / extension.r.xx;
    CHECK(std::abs(K_e - row.K_e) < printed);
    CHECK(std::abs(extension.I_star - row.I_e) < printed);
    CHECK(std::abs(std::asin((1 - K_e) / (1 + K_e)) / degree - row.phi_e) < 5e-3);  // two decimals
    // the same states are points of the failure surface at their own I_e
    const FailurePoint at_extension = failure_point(law, std::numbers::pi / 3, extension.I_star);
    CHECK(at_extension.r[2] / at_extension.r[0] < 1);
    CHECK(at_extension.flow[0] + at_extension.flow[1] + at_extension.flow[2] == Approx(0).margin(1e-9));  // isochoric
  }
}

TEST_CASE("A void ratio above the threshold of the mode liquefies completely", "[calibration]") {
  for (const auto& [set, threshold] : {std::pair{T1, 0.8955001553}, {T2, 0.9165076972}, {T4, 0.8967599576}}) {
    CAPTURE(set.name);
    const auto law = law_of(set, 1);
    const double I_star = stationary_state(law, simple_shear_flow).I_star;
    CHECK(std::abs(critical_void_ratio(law.critical, I_star, 0) - threshold) < 1e-10);  // ten decimals
    // the definition: I_e at that void ratio is I*
    CHECK(law_of(set, threshold).critical.I_e(0.0, 0.0) == Approx(I_star).epsilon(1e-9));
    CHECK(critical_void_ratio(law.critical, 1.0, 1000) == Approx(law.critical.e_crt(1000.0)).epsilon(1e-15));
  }
}
