// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>

#include "harness.hpp"

using namespace grainlaw;
using namespace grainlaw::consistency;

namespace {

using Vector = Eigen::Vector3d;

Vector direction(Random& random) {
  const double z = random.uniform(-1, 1), angle = random.uniform(0, 6.283185307179586), r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}
Tensor<double> dyad(const Vector& g, const Vector& n) {
  return {g[0] * n[0], g[0] * n[1], g[0] * n[2], g[1] * n[0], g[1] * n[1],
          g[1] * n[2], g[2] * n[0], g[2] * n[1], g[2] * n[2]};
}
Vector traction(const SymTensor<double>& s, const Vector& n) {
  return {s.xx * n[0] + s.xy * n[1] + s.xz * n[2], s.xy * n[0] + s.yy * n[1] + s.yz * n[2],
          s.xz * n[0] + s.yz * n[1] + s.zz * n[2]};
}
/// The largest rho c^2 of a plane wave along n on top of a flow: eigenvalues of the acoustic tensor of the tangent.
template <class L>
double fastest(const L& law, const Flow<double>& flow, const typename L::template State<double>& y, const Vector& n) {
  Eigen::Matrix3d A;
  for (int j = 0; j < 3; ++j) A.col(j) = traction(tangent(law, flow, y, dyad(Vector::Unit(j), n)), n);
  double most = 0;
  for (const auto& e : Eigen::EigenSolver<Eigen::Matrix3d>(A, false).eigenvalues()) most = std::fmax(most, e.real());
  return most;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("wave_speed bounds every plane wave and is no more than three times too fast", "[waves]",
                        AllLaws) {
  const auto law = example_law<TestType>();
  Random random(51);
  double closest = 0, loosest = 1e300;
  for (int i = 0; i < 150; ++i) {
    // rates so slow that collisions, which carry no elastic wave, do not count
    const double p = random.decades(1e2, 1e6);
    const double compaction = random.compaction();
    const auto y = at_rest(law, compaction, random.stress(p, random.uniform(0, 0.95)));
    double most = 0;
    Flow<double> flow{{}, compaction};
    for (int loading = 0; loading < 12; ++loading) {
      flow.L = random.tensor(1e-6);
      for (int k = 0; k < 25; ++k) most = std::fmax(most, fastest(law, flow, y, direction(random)));
    }
    const double density = 1600, bound = law.wave_speed(flow, y, density), found = std::sqrt(most / density);
    if (found == 0) continue;
    closest = std::fmax(closest, found / bound);
    loosest = std::fmin(loosest, found / bound);
  }
  if (loosest > 1e299) {
    SUCCEED("no waves in this law");
    return;
  }
  // Measured, fastest wave over wave_speed: newtonian 0.95 to 1, elastic 0.69 (under a stress as large as the modulus)
  // to 1, hypoplastic in all its forms 0.67 to 0.99.
  INFO(TestType::name << ": the fastest wave is between " << loosest << " and " << closest << " of wave_speed");
  CHECK(closest <= 1 + 1e-12);  // roundings of the eigenvalues
  CHECK(loosest >= 1.0 / 3);    // the time step that a host gives away
}

TEMPLATE_LIST_TEST_CASE("viscosity bounds the slope of every shear stress", "[waves]", AllLaws) {
  using L = TestType;
  const auto law = example_law<L>();
  Random random(52);
  double closest = 0;
  for (int i = 0; i < 20000; ++i) {
    const Flow<double> flow = random.flow(1e-4, 1e3);
    const auto y = at_rest(law, flow.compaction, random.stress(1e4));
    const Vector n = direction(random);
    const Vector other = direction(random);
    const Vector g = n.cross(other).normalized();
    const typename L::template State<double> none{};
    const SymTensor<double> slope = stress_change(law, flow, Flow<double>{dyad(g, n), 0}, y, none);
    const double found = std::fabs(g.dot(traction(slope, n))), bound = law.viscosity(flow, y);
    if (found > bound * (1 + 1e-12) + 1e-12 * stiffness(law, flow, y) * 1e-9) {
      CAPTURE(i, found, bound);
      CHECK(found <= bound * (1 + 1e-12));  // roundings
    }
    if (bound > 0) closest = std::fmax(closest, found / bound);
  }
  // simple shear in its own plane reaches the bound; random flows come near it
  if (claims_of<L>().degree_in_L != 0) CHECK(closest > 0.5);
}
