// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstring>

#include "law.hpp"

namespace grainlaw {

template <class State>
struct Advanced {
  State state;
  unsigned reasons;  ///< what admit found at the end, and too_many_steps
  int rates;         ///< evaluations of law.rate
};

/// One step of a host that owns its time stepping: integrates the state over dt with L and the compaction linear in
/// time, in as many sub-steps as the relative tolerance asks for (Bogacki-Shampine 3(2), rotation unsplit).
///
///     d(state)/dt = law.rate(flow(t), state),   flow(t) = old + (new - old) t/dt
///
/// Source   Bogacki & Shampine, Appl. Math. Lett. 2 (1989) 321.
/// Inputs   flows at both ends, dt >= 0 [s] (0 is legal and returns the state; NaN or a
///          negative one is flagged not_finite), tolerance of a sub-step relative to
///          the stress, or to 1 for dimensionless states.
/// Output   the admitted state.   Fails   too_many_steps after max_steps sub-steps: the state reached so far.
template <Law<double> L>
Advanced<typename L::template State<double>> advance(const L& law, const Flow<double>& old_flow,
                                                     const Flow<double>& new_flow,
                                                     const typename L::template State<double>& start, double dt,
                                                     double tolerance = 1e-6, int max_steps = 100000) noexcept {
  using State = typename L::template State<double>;
  constexpr int n = count<State, double>;
  if constexpr (n == 0) {
    return {start, unsigned(law.admit(new_flow, start).reasons), 0};
  } else {
    using Numbers = std::array<double, n>;
    const auto flow_at = [&](double x) {
      return Flow<double>{(1 - x) * old_flow.L + x * new_flow.L,
                          old_flow.compaction + x * (new_flow.compaction - old_flow.compaction)};
    };
    int rates = 0;
    const auto rate = [&](double x, const Numbers& y) {
      ++rates;
      return std::bit_cast<Numbers>(law.rate(flow_at(x), std::bit_cast<State>(y)));
    };
    Numbers y = std::bit_cast<Numbers>(start);
    if (!(dt > 0)) {
      const unsigned wrong = dt == 0 ? 0u : unsigned(not_finite);
      return {start, unsigned(law.admit(new_flow, start).reasons) | wrong, 0};
    }
    double x = 0, h = 1;
    Numbers k1 = rate(0, y);
    for (int step = 0; step < max_steps; ++step) {
      h = std::fmin(h, 1 - x);
      Numbers y2, y3, next;
      for (int i = 0; i < n; ++i) y2[i] = y[i] + 0.5 * h * dt * k1[i];
      const Numbers k2 = rate(x + 0.5 * h, y2);
      for (int i = 0; i < n; ++i) y3[i] = y[i] + 0.75 * h * dt * k2[i];
      const Numbers k3 = rate(x + 0.75 * h, y3);
      for (int i = 0; i < n; ++i) next[i] = y[i] + h * dt * (2 * k1[i] + 3 * k2[i] + 4 * k3[i]) / 9;
      const Numbers k4 = rate(x + h, next);
      double error = 0, size = 0;
      for (int i = 0; i < n; ++i) {
        const double e = h * dt * (-5 * k1[i] / 72 + k2[i] / 12 + k3[i] / 9 - k4[i] / 8);
        error += e * e;
        size += next[i] * next[i];
      }
      const double scale = StressInState<L> ? std::sqrt(size) : 1.0;
      const double ratio = std::sqrt(error) / (tolerance * scale + std::numeric_limits<double>::min());
      if (ratio <= 1) {
        x = h >= 1 - x ? 1 : x + h;
        y = next;
        k1 = k4;
        if (x >= 1) {
          const auto admitted = law.admit(new_flow, std::bit_cast<State>(y));
          return {admitted.state, unsigned(admitted.reasons), rates};
        }
      }
      // NaN fails both comparisons and shrinks the step
      h *= ratio <= 1 ? std::fmin(5.0, 0.9 / std::cbrt(ratio + 1e-4))
                      : (ratio < 1e6 ? std::fmax(0.1, 0.9 / std::cbrt(ratio)) : 0.1);
      if (!(h > 1e-14)) break;
    }
    return {std::bit_cast<State>(y), unsigned(law.admit(new_flow, std::bit_cast<State>(y)).reasons) | too_many_steps,
            rates};
  }
}

}  // namespace grainlaw
