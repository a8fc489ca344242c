// SPDX-License-Identifier: BSD-3-Clause
// The law of another project does what its few lines say; the consistency tests hold it to everything else.
#include <catch2/catch.hpp>

#include "coulomb.hpp"

using example::Coulomb;
using namespace grainlaw;

TEST_CASE("the example law is Coulomb friction at the pressure of its equation of state") {
  const Coulomb law{0.5, 1e-9, 1e6};
  const Flow<double> shear{{0, 0, 2, 0, 0, 0, 0, 0, 0}, 0.01};
  const SymTensor<double> sigma = law.stress(shear, {});
  // p = K c = 10 kPa and tau = mu p = 5 kPa, but for (g0/gamma_dot)^2/2 = 1e-19
  CHECK(pressure(sigma) == Approx(1e4).epsilon(1e-15));
  CHECK(sigma.xz == Approx(5e3).epsilon(1e-15));
  CHECK(sigma.xy == 0.0);
}

TEST_CASE("the example law creeps below its smallest rate and does not pull") {
  const Coulomb law{0.5, 1.0, 1e6};
  // far below g0 it is a fluid of viscosity mu p/g0; the relative difference is (gamma_dot/g0)^2/2 = 5e-13
  const Flow<double> creep{{0, 0, 1e-6, 0, 0, 0, 0, 0, 0}, 0.01};
  CHECK(law.stress(creep, {}).xz == Approx(0.5 * 1e4 * 1e-6).epsilon(1e-12));
  const Flow<double> expanded{{0, 0, 1, 0, 0, 0, 0, 0, 0}, -0.01};
  CHECK(norm(law.stress(expanded, {})) == 0.0);
}
