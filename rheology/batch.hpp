// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// A law over many points held as columns (structure of arrays), one pack of lanes at a time. The arithmetic is the
// law's own; a tail that does not fill a pack runs on a padded one, so every point sees the same instructions.
#include <cstddef>

#include "law.hpp"
#include "pack.hpp"

namespace grainlaw::batch {

/// Columns of n numbers each; a host points them at its own arrays.
template <class T, int N>
struct Columns {
  std::array<T*, N> at{};
};
template <class T>
using FlowColumns = Columns<const T, 10>;  ///< L in row order (xx xy xz yx yy yz zx zy zz), compaction
template <class L, class T>
using StateColumns = Columns<T, count<typename L::template State<T>, T>>;

template <class T>
using PackOf = Pack<T, pack_bytes / int(sizeof(T))>;

/// One compiled body for full packs and for the tail: with contraction (fused multiply-add) two copies of the same
/// formula may round differently, and a point's result must not depend on where in a batch it stands.
#if defined(__clang__)
#define GRAINLAW_ONE_BODY __attribute__((noinline))
#else
#define GRAINLAW_ONE_BODY __attribute__((noipa))
#endif

template <class P, class T>
Flow<P> load_flow(const FlowColumns<T>& c, std::size_t i) {
  Flow<P> flow;
  std::size_t k = 0;
  each(flow.L, [&](P& x) { x = P::load(c.at[k++] + i); });
  flow.compaction = P::load(c.at[9] + i);
  return flow;
}
template <class State, class P, class C>
State load_state(const C& c, std::size_t i) {
  State state{};
  if constexpr (!std::is_empty_v<State>) {
    std::array<P, std::size_t(count<State, P>)> numbers;
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = P::load(c.at[k] + i);
    __builtin_memcpy(&state, &numbers, sizeof state);
  }
  return state;
}
template <class P, class State, class C>
void store_state(const State& state, const C& c, std::size_t i) {
  if constexpr (!std::is_empty_v<State>) {
    std::array<P, std::size_t(count<State, P>)> numbers;
    __builtin_memcpy(&numbers, &state, sizeof state);
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k].store(c.at[k] + i);
  }
}

/// The last points of a batch, copied out and padded with the last one to a full pack; `put_back` returns results.
template <class T, int N>
class Tail {
 public:
  static constexpr std::size_t lanes = std::size_t(RealTraits<PackOf<T>>::lanes);
  Tail(const auto& columns, std::size_t first, std::size_t n) : begin(first), length(n - first) {
    for (std::size_t k = 0; k < std::size_t(N); ++k) {
      for (std::size_t i = 0; i < lanes; ++i) padded[k][i] = columns.at[k][begin + (i < length ? i : length - 1)];
    }
  }
  explicit Tail(std::size_t first, std::size_t n) : begin(first), length(n - first) {}
  template <class C>
  C columns() {
    C c;
    for (std::size_t k = 0; k < std::size_t(N); ++k) c.at[k] = padded[k];
    return c;
  }
  void put_back(const auto& columns) const {
    for (std::size_t k = 0; k < std::size_t(N); ++k) {
      for (std::size_t i = 0; i < length; ++i) columns.at[k][begin + i] = padded[k][i];
    }
  }

 private:
  std::size_t begin, length;
  T padded[N > 0 ? N : 1][lanes];
};

template <class T, class L>
GRAINLAW_ONE_BODY void rate_of_packs(const L& shared, FlowColumns<T> flow, StateColumns<L, T> state,
                                     StateColumns<L, T> out, std::size_t n) noexcept {
  using P = PackOf<T>;
  const L law = shared;  // by value, like the columns: nothing that is stored can alias a copy on the stack
  for (std::size_t i = 0; i < n; i += std::size_t(RealTraits<P>::lanes)) {
    const auto y = load_state<typename L::template State<P>, P>(state, i);
    store_state<P>(law.rate(load_flow<P, T>(flow, i), y), out, i);
  }
}

/// rate[i] = law.rate(flow[i], state[i]) for n points.
template <class T, class L>
void rate(const L& law, const FlowColumns<T>& flow, const StateColumns<L, T>& state, const StateColumns<L, T>& out,
          std::size_t n) noexcept {
  constexpr int size = int(StateColumns<L, T>{}.at.size());
  using StateTail = Tail<T, size>;
  const std::size_t full = n - n % StateTail::lanes;
  rate_of_packs<T>(law, flow, state, out, full);
  if (full == n) return;
  Tail<T, 10> flow_tail(flow, full, n);
  StateTail state_tail(state, full, n), out_tail(full, n);
  rate_of_packs<T>(law, flow_tail.template columns<FlowColumns<T>>(), state_tail.template columns<StateColumns<L, T>>(),
                   out_tail.template columns<StateColumns<L, T>>(), StateTail::lanes);
  out_tail.put_back(out);
}

template <class T, class L>
GRAINLAW_ONE_BODY void stress_of_packs(const L& shared, FlowColumns<T> flow, StateColumns<L, T> state,
                                       Columns<T, 6> out, std::size_t n) noexcept {
  using P = PackOf<T>;
  const L law = shared;
  for (std::size_t i = 0; i < n; i += std::size_t(RealTraits<P>::lanes)) {
    const auto y = load_state<typename L::template State<P>, P>(state, i);
    auto sigma = law.stress(load_flow<P, T>(flow, i), y);
    std::size_t k = 0;
    each(sigma, [&](const P& x) { x.store(out.at[k++] + i); });
  }
}

/// stress[i] = law.stress(flow[i], state[i]) for n points; columns in the order xx yy zz yz xz xy.
template <class T, class L>
void stress(const L& law, const FlowColumns<T>& flow, const StateColumns<L, T>& state, const Columns<T, 6>& out,
            std::size_t n) noexcept {
  using StateTail = Tail<T, int(StateColumns<L, T>{}.at.size())>;
  const std::size_t full = n - n % StateTail::lanes;
  stress_of_packs<T>(law, flow, state, out, full);
  if (full == n) return;
  Tail<T, 10> flow_tail(flow, full, n);
  StateTail state_tail(state, full, n);
  Tail<T, 6> out_tail(full, n);
  stress_of_packs<T>(law, flow_tail.template columns<FlowColumns<T>>(),
                     state_tail.template columns<StateColumns<L, T>>(), out_tail.template columns<Columns<T, 6>>(),
                     StateTail::lanes);
  out_tail.put_back(out);
}

using Counts = std::array<std::size_t, reason_names.size()>;

template <class T, class L>
GRAINLAW_ONE_BODY void admit_packs(const L& shared, FlowColumns<T> flow, StateColumns<L, T> state, std::size_t n,
                                   std::size_t counted_lanes, Counts& fired) noexcept {
  using P = PackOf<T>;
  const L law = shared;
  for (std::size_t i = 0; i < n; i += std::size_t(RealTraits<P>::lanes)) {
    const auto y = load_state<typename L::template State<P>, P>(state, i);
    const auto admitted = law.admit(load_flow<P, T>(flow, i), y);
    unsigned long long seen = 0;
    for (int k = 0; k < RealTraits<P>::lanes; ++k) seen |= admitted.reasons[k];
    if (seen == 0) continue;
    for (std::size_t k = 0; k < counted_lanes; ++k) {
      for (std::size_t bit = 0; bit < fired.size(); ++bit) fired[bit] += (admitted.reasons[int(k)] >> bit) & 1;
    }
    store_state<P>(admitted.state, state, i);
  }
}

/// Replaces every state by the admitted one and returns how often each reason fired (indexed as reason_names).
template <class T, class L>
Counts admit(const L& law, const FlowColumns<T>& flow, const StateColumns<L, T>& state, std::size_t n) noexcept {
  using StateTail = Tail<T, int(StateColumns<L, T>{}.at.size())>;
  Counts fired{};
  const std::size_t full = n - n % StateTail::lanes;
  admit_packs<T>(law, flow, state, full, StateTail::lanes, fired);
  if (full == n) return fired;
  Tail<T, 10> flow_tail(flow, full, n);
  StateTail state_tail(state, full, n);
  admit_packs<T>(law, flow_tail.template columns<FlowColumns<T>>(), state_tail.template columns<StateColumns<L, T>>(),
                 StateTail::lanes, n - full, fired);
  state_tail.put_back(state);
  return fired;
}

#undef GRAINLAW_ONE_BODY

}  // namespace grainlaw::batch
