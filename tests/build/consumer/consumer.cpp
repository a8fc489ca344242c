// SPDX-License-Identifier: BSD-3-Clause
// A program of another project: a dense sand sheared at constant volume from an isotropic stress.
#include <cstdio>

#include "rheology/advance.hpp"
#include "rheology/laws.hpp"

int main() {
  using namespace grainlaw;
  using Sand = HypoplasticBagnold<>;
  const Sand sand{{.c1 = -50,
                   .c2 = -629.6,
                   .c3 = -629.6,
                   .c4 = 1220.8,
                   .p_floor = 0,
                   .critical = {0.597, 0.53, 0.45, -1.8e-6, 1.0, -0.4, -1e-7, /*e_ref*/ 0.845}},
                  {.k_v = 0.01, .alpha_i = 0.6108652381980153}};
  const Flow<double> shear{.L = {0, 0, 0.01, 0, 0, 0, 0, 0, 0}, .compaction = 0};

  auto state = sand.start(shear, {-1e5, -1e5, -1e5, 0, 0, 0});
  unsigned reasons = 0;
  for (int step = 0; step < 100; ++step) {  // to a shear strain of 1
    const auto next = advance(sand, shear, shear, state, 1.0, 1e-9);
    state = next.state;
    reasons |= next.reasons;
  }
  std::printf("shear stress %.6f Pa, reasons %u\n", sand.stress(shear, state).xz, reasons);
}
