// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "tests/materials.hpp"

using namespace grainlaw;
using namespace grainlaw::testing;

namespace {

Eigen::Matrix3d matrix(const SymTensor<double>& a) {
  return (Eigen::Matrix3d() << a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz).finished();
}
Eigen::Matrix3d matrix(const Tensor<double>& a) {
  return (Eigen::Matrix3d() << a.xx, a.xy, a.xz, a.yx, a.yy, a.yz, a.zx, a.zy, a.zz).finished();
}

// Twelve products and sums of numbers below 1 (some tests: below 10): a few dozen roundings of 1.1e-16.
constexpr double rounding = 1e-14;

}  // namespace

TEST_CASE("Tensor functions agree with matrix algebra", "[tensor]") {
  Dice dice(1);
  for (int i = 0; i < 1000; ++i) {
    const Tensor<double> l = dice.tensor();
    const SymTensor<double> a = dice.symmetric_tensor(), b = dice.symmetric_tensor();
    const Eigen::Matrix3d L = matrix(l), A = matrix(a), B = matrix(b), W = (L - L.transpose()) / 2;
    const Eigen::Matrix3d S = A - A.trace() / 3 * Eigen::Matrix3d::Identity();
    CHECK((matrix(symmetric(l)) - (L + L.transpose()) / 2).norm() < rounding);
    CHECK((matrix(square(a)) - A * A).norm() < rounding);
    CHECK((matrix(spin_rate(l, a)) - (W * A - A * W)).norm() < rounding);
    CHECK((matrix(deviator(a)) - S).norm() < rounding);
    CHECK(std::abs(determinant(a) - A.determinant()) < rounding);
    CHECK(std::abs(contract(a, b) - (A * B).trace()) < rounding);
    CHECK(std::abs(norm(a) - A.norm()) < rounding);
    CHECK(std::abs(second_invariant(a) - 0.5 * (S * S).trace()) < rounding);
    CHECK(std::abs(pressure(a) + A.trace() / 3) < rounding);
    CHECK(std::abs(von_mises(a) - std::sqrt(1.5) * S.norm()) < rounding);
    CHECK(std::abs(shear_rate(a) - std::sqrt(2.0) * S.norm()) < rounding);
    const Tensor<double> q = rotation(l, 3);
    CHECK((matrix(rotated(a, q)) - matrix(q) * A * matrix(q).transpose()).norm() < rounding);
  }
}

TEST_CASE("Components are visited in the documented order", "[tensor]") {
  SymTensor<double> a{1, 2, 3, 4, 5, 6};
  Tensor<double> l{1, 2, 3, 4, 5, 6, 7, 8, 9};
  int k = 0;
  each(a, [&](double x) { CHECK(x == ++k); });  // xx yy zz yz xz xy
  k = 0;
  each(l, [&](double x) { CHECK(x == ++k); });  // rows
  CHECK(a.yz == 4);
  CHECK(a.xz == 5);
  CHECK(l.yx == 4);
}

TEST_CASE("The largest eigenvalue of a deviator is exact, double roots included", "[tensor]") {
  Dice dice(2);
  const auto check = [](const SymTensor<double>& a, double tolerance) {
    const SymTensor<double> s = deviator(a);
    const double size = norm(s);
    const double expected = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix(s)).eigenvalues()[2];
    const double J2 = 0.5 * contract(s, s), J3 = determinant(s);
    CHECK(std::abs(largest_of_deviator(J2, J3) - expected) < tolerance * size);
  };
  // A simple root of the cubic carries the rounding of J3 amplified by 1/(3 x^2 - J2): well below 1e-10 for random
  // states. A double root at the top (extension) is a root of a square: sqrt(1e-16) = 1e-8.
  for (int i = 0; i < 1000; ++i) {
    const Tensor<double> q = dice.turn();
    check(dice.symmetric_tensor(), 1e-7);
    check(rotated<double>({2, -1, -1, 0, 0, 0}, q), 1e-12);
    check(rotated<double>({-2, 1, 1, 0, 0, 0}, q), 1e-7);
  }
  CHECK(largest_of_deviator(3.0, 2.0) == Approx(2).epsilon(1e-15));  // diag(2, -1, -1): closed form
  CHECK(largest_of_deviator(1.0, 0.0) == Approx(1).epsilon(1e-15));  // diag(1, 0, -1)
  CHECK(largest_of_deviator(3.0, -2.0) == Approx(1).epsilon(1e-7));  // diag(1, 1, -2), double root
  CHECK(largest_of_deviator(0.0, 0.0) < 1e-100);
}

TEST_CASE("The finite rotation is the exponential of the spin", "[tensor]") {
  // closed form: W_xz = w turns x towards -z: exp(W t) = [cos, ., sin; ., 1, .; -sin, ., cos]
  const Tensor<double> l{0, 0, 2, 0, 0, 0, -2, 0, 0};
  const Tensor<double> q = rotation(l, 0.4);
  CHECK(q.xx == Approx(std::cos(0.8)).epsilon(1e-15));
  CHECK(q.xz == Approx(std::sin(0.8)).epsilon(1e-15));
  CHECK(q.zx == Approx(-std::sin(0.8)).epsilon(1e-15));
  CHECK(q.yy == 1);
  Dice dice(3);
  for (int i = 0; i < 1000; ++i) {
    const Tensor<double> w = dice.tensor();
    const Eigen::Matrix3d Q = matrix(rotation(w, dice(0, 10)));
    CHECK((Q * Q.transpose() - Eigen::Matrix3d::Identity()).norm() < rounding);
    CHECK(Q.determinant() == Approx(1).epsilon(rounding));
    // the series below an angle of 1e-4 meets the closed form: half of a step twice is the step
    const double dt = 1.5e-4;
    const Eigen::Matrix3d half = matrix(rotation(w, dt / 2));
    CHECK((half * half - matrix(rotation(w, dt))).norm() < rounding);
    // a strain in L does not turn anything
    const SymTensor<double> d = symmetric(w);
    CHECK((matrix(rotation({d.xx, d.xy, d.xz, d.xy, d.yy, d.yz, d.xz, d.yz, d.zz}, 1)) - Eigen::Matrix3d::Identity())
              .norm() == 0);
  }
}

TEST_CASE("The exponential is good to an ulp, clamped and never launders a NaN", "[tensor]") {
  Dice dice(4);
  double worst = 0, worst_float = 0;
  for (int i = 0; i < 100000; ++i) {
    const double x = dice(-700, 700);
    worst = std::max(worst, std::abs(real::exp(x) / std::exp(x) - 1));
    const float f = float(dice(-80, 80));
    worst_float = std::max(worst_float, double(std::abs(real::exp(f) / std::exp(f) - 1)));
  }
  CHECK(worst < 2 * 2.3e-16);       // "about 1 ulp" against a libm that is itself off by half of one
  CHECK(worst_float < 2 * 1.2e-7);  // the same in single precision
  CHECK(real::exp(0.0) == 1);
  CHECK(real::exp(-1e5) > 0);
  CHECK(real::exp(1e5) < unbounded);
  CHECK(std::isnan(real::exp(std::nan(""))));
  CHECK(std::isnan(real::at_least(std::nan(""), 1.0)));
  CHECK(std::isnan(real::at_most(std::nan(""), 1.0)));
}
