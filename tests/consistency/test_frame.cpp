// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "harness.hpp"

using namespace grainlaw;
using namespace grainlaw::consistency;

namespace {

// The tensor algebra of these tests is Eigen's, not the library's own.
Eigen::Matrix3d matrix(const Tensor<double>& a) {
  Eigen::Matrix3d m;
  m << a.xx, a.xy, a.xz, a.yx, a.yy, a.yz, a.zx, a.zy, a.zz;
  return m;
}
Eigen::Matrix3d matrix(const SymTensor<double>& a) {
  Eigen::Matrix3d m;
  m << a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz;
  return m;
}
Tensor<double> tensor(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}
SymTensor<double> symmetric_tensor(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(1, 1), m(2, 2), m(1, 2), m(0, 2), m(0, 1)};
}
Tensor<double> turned(const Tensor<double>& a, const Eigen::Matrix3d& Q) {
  return tensor(Q * matrix(a) * Q.transpose());
}
SymTensor<double> turned(const SymTensor<double>& a, const Eigen::Matrix3d& Q) {
  return symmetric_tensor(Q * matrix(a) * Q.transpose());
}

/// A law and its mirror or rotated image: stress, rate and admitted stress must be images of each other.
template <class L>
void check_image(const L& law, const Flow<double>& flow, const SymTensor<double>& sigma, const Eigen::Matrix3d& Q,
                 double roundings) {
  const auto y = at_rest(law, flow.compaction, sigma);
  const Flow<double> flow2{turned(flow.L, Q), flow.compaction};
  const auto y2 = at_rest(law, flow.compaction, turned(sigma, Q));
  const double per_stress = roundings * stress_size(law, flow, y);
  const double per_rate = roundings * stiffness(law, flow, y) * size(flow.L);
  const auto near = [](const SymTensor<double>& a, const SymTensor<double>& b, double tolerance) {
    const double d = distance<double>(a, b);
    HOLDS(d <= tolerance);
  };
  near(law.stress(flow2, y2), turned(law.stress(flow, y), Q), per_stress);
  near(stress_rate(law, flow2, y2), turned(stress_rate(law, flow, y), Q), per_rate);
  const auto a = law.admit(flow, y), a2 = law.admit(flow2, y2);
  HOLDS(a.reasons == a2.reasons);
  // away from the apex the return map keeps a smooth function of the invariants
  near(law.stress(flow2, a2.state), turned(law.stress(flow, a.state), Q), per_stress);
}

}  // namespace

// A rounding of the rotated input is amplified by the coefficients of the law, which the stiffness measures; the
// rest are the few dozen operations of the formulas and of the two rotations.
constexpr double rotation_roundings = 200 * eps;

TEMPLATE_LIST_TEST_CASE("a rotated experiment gives the rotated result", "[frame]", AllLaws) {
  const auto law = example_law<TestType>();
  Random random(21);
  for (int i = 0; i < 3000; ++i) {
    const Flow<double> flow = random.flow(1e-6, 1e3);
    const auto q =
        Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))
            .normalized();
    // inside the cone, or well outside: the corner of the return map itself has no derivative
    const double fraction = random.below(4) == 0 ? random.uniform(1.1, 3) : random.uniform(0, 0.9);
    CAPTURE(i);
    check_image(law, flow, random.stress(random.decades(1e-2, 1e7), fraction), q.toRotationMatrix(),
                rotation_roundings);
  }
}

TEMPLATE_LIST_TEST_CASE("an observer who spins sees the stress turn and nothing else", "[frame]", AllLaws) {
  const auto law = example_law<TestType>();
  Random random(22);
  for (int i = 0; i < 3000; ++i) {
    const Flow<double> flow = random.flow(1e-6, 1e3);
    const auto y = at_rest(law, flow.compaction, random.stress(random.decades(1e-2, 1e7)));
    const Eigen::Matrix3d any = matrix(random.tensor(size(flow.L) * random.decades(1e-2, 1e2)));
    const Eigen::Matrix3d spin = (any - any.transpose()) / 2;
    const Flow<double> spinning{tensor(matrix(flow.L) + spin), flow.compaction};
    const double rates = size(flow.L) + spin.cwiseAbs().maxCoeff();
    CAPTURE(i);
    // what turns is the stress that is carried along: the one that is left when the flow stops
    const Eigen::Matrix3d carried = matrix(law.stress(Flow<double>{{}, flow.compaction}, y));
    const Eigen::Matrix3d turning = spin * carried - carried * spin;
    const Eigen::Matrix3d got = matrix(stress_rate(law, spinning, y)) - matrix(stress_rate(law, flow, y));
    // D itself carries the rounding of L + spin, hence the size of both rates together
    const double tolerance = rotation_roundings * stiffness(law, flow, y) * rates;
    const double d = (got - turning).cwiseAbs().maxCoeff();
    HOLDS(d <= tolerance);
    const double moved = distance<double>(law.stress(spinning, y), law.stress(flow, y));
    const double allowed = rotation_roundings * (stress_size(law, flow, y) + law.viscosity(spinning, y) * rates);
    HOLDS(moved <= allowed);
  }
}

TEMPLATE_LIST_TEST_CASE("mirror images are exact and permuted axes permute the result", "[frame]", AllLaws) {
  const auto law = example_law<TestType>();
  Random random(23);
  for (int i = 0; i < 1000; ++i) {
    const Flow<double> flow = random.flow(1e-6, 1e3);
    const double fraction = random.below(4) == 0 ? random.uniform(1.1, 3) : random.uniform(0, 0.9);
    const SymTensor<double> sigma = random.stress(random.decades(1e-2, 1e7), fraction);
    CAPTURE(i);
    for (int axis = 0; axis < 3; ++axis) {
      // signs change and sums do not: not one rounding differs
      Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
      mirror(axis, axis) = -1;
      check_image(law, flow, sigma, mirror, 0);
    }
    for (int turn = 0; turn < 5; ++turn) {
      // sums run in another order
      constexpr int order[5][3] = {{0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
      Eigen::Matrix3d permutation = Eigen::Matrix3d::Zero();
      for (int k = 0; k < 3; ++k) permutation(k, order[turn][k]) = 1;
      check_image(law, flow, sigma, permutation, 100 * eps);
    }
  }
}
