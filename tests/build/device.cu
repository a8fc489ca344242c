// SPDX-License-Identifier: BSD-3-Clause
// The laws in a kernel: compiled where there is a device compiler, never run by the tests.
#include "rheology/laws.hpp"

using namespace grainlaw;

template <class L, class R>
__global__ void step(L law, const Flow<R>* flow, const typename L::template State<R>* state,
                     typename L::template State<R>* rate, SymTensor<R>* stress, unsigned* reasons, R* speed, int n) {
  const int i = int(blockIdx.x * blockDim.x + threadIdx.x);
  if (i >= n) return;
  const auto admitted = law.admit(flow[i], state[i]);
  rate[i] = law.rate(flow[i], admitted.state);
  stress[i] = law.stress(flow[i], admitted.state);
  reasons[i] = unsigned(admitted.reasons);
  speed[i] = law.wave_speed(flow[i], admitted.state, R(1600)) + law.viscosity(flow[i], admitted.state);
}

#define LAW(L, R)                                                                                                    \
  template __global__ void step<L, R>(L, const Flow<R>*, const L::State<R>*, L::State<R>*, SymTensor<R>*, unsigned*, \
                                      R*, int);
using Sand = HypoplasticBagnold<>;
using LogarithmicSand = HypoplasticBagnold<CriticalState, LogForm>;
LAW(Sand, double)
LAW(Sand, float)
LAW(LogarithmicSand, double)
LAW(Elastic, double)
LAW(Newtonian, float)
LAW(Bagnold, double)
