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

template <class P, class T>
P load(const T* p, std::size_t i, std::size_t n) {
  constexpr std::size_t lanes = std::size_t(RealTraits<P>::lanes);
  if (i + lanes <= n) return P::load(p + i);
  T padded[lanes];
  for (std::size_t k = 0; k < lanes; ++k) padded[k] = p[i + k < n ? i + k : n - 1];
  return P::load(padded);
}
template <class P, class T>
void store(const P& x, T* p, std::size_t i, std::size_t n) {
  constexpr std::size_t lanes = std::size_t(RealTraits<P>::lanes);
  if (i + lanes <= n) {
    x.store(p + i);
  } else {
    for (std::size_t k = 0; i + k < n; ++k) p[i + k] = x[int(k)];
  }
}

template <class P, class T>
Flow<P> load_flow(const FlowColumns<T>& c, std::size_t i, std::size_t n) {
  Flow<P> flow;
  int k = 0;
  each(flow.L, [&](P& x) { x = load<P>(c.at[std::size_t(k++)], i, n); });
  flow.compaction = load<P>(c.at[9], i, n);
  return flow;
}
template <class State, class P, class C>
State load_state(const C& c, std::size_t i, std::size_t n) {
  if constexpr (std::is_empty_v<State>) {
    return {};
  } else {
    constexpr int size = count<State, P>;
    std::array<P, std::size_t(size)> numbers;
    for (int k = 0; k < size; ++k) numbers[std::size_t(k)] = load<P>(c.at[std::size_t(k)], i, n);
    State state;
    __builtin_memcpy(&state, &numbers, sizeof state);
    return state;
  }
}
template <class P, class State, class C>
void store_state(const State& state, const C& c, std::size_t i, std::size_t n) {
  if constexpr (!std::is_empty_v<State>) {
    constexpr int size = count<State, P>;
    std::array<P, std::size_t(size)> numbers;
    __builtin_memcpy(&numbers, &state, sizeof state);
    for (int k = 0; k < size; ++k) store(numbers[std::size_t(k)], c.at[std::size_t(k)], i, n);
  }
}

/// rate[i] = law.rate(flow[i], state[i]) for n points.
template <class T, class L>
void rate(const L& shared, const FlowColumns<T>& flow, const StateColumns<L, T>& state, const StateColumns<L, T>& out,
          std::size_t n) noexcept {
  using P = PackOf<T>;
  const L law = shared;  // a copy on the stack cannot alias the columns
  for (std::size_t i = 0; i < n; i += std::size_t(RealTraits<P>::lanes)) {
    const auto y = load_state<typename L::template State<P>, P>(state, i, n);
    store_state<P>(law.rate(load_flow<P, T>(flow, i, n), y), out, i, n);
  }
}

/// stress[i] = law.stress(flow[i], state[i]) for n points; columns in the order xx yy zz yz xz xy.
template <class T, class L>
void stress(const L& shared, const FlowColumns<T>& flow, const StateColumns<L, T>& state, const Columns<T, 6>& out,
            std::size_t n) noexcept {
  using P = PackOf<T>;
  const L law = shared;
  for (std::size_t i = 0; i < n; i += std::size_t(RealTraits<P>::lanes)) {
    const auto y = load_state<typename L::template State<P>, P>(state, i, n);
    auto sigma = law.stress(load_flow<P, T>(flow, i, n), y);
    int k = 0;
    each(sigma, [&](const P& x) { store(x, out.at[std::size_t(k++)], i, n); });
  }
}

/// Replaces every state by the admitted one and returns how often each reason fired (indexed as reason_names).
template <class T, class L>
std::array<std::size_t, reason_names.size()> admit(const L& shared, const FlowColumns<T>& flow,
                                                   const StateColumns<L, T>& state, std::size_t n) noexcept {
  using P = PackOf<T>;
  const L law = shared;
  std::array<std::size_t, reason_names.size()> fired{};
  constexpr std::size_t lanes = std::size_t(RealTraits<P>::lanes);
  for (std::size_t i = 0; i < n; i += lanes) {
    const auto y = load_state<typename L::template State<P>, P>(state, i, n);
    const auto admitted = law.admit(load_flow<P, T>(flow, i, n), y);
    unsigned long long seen = 0;
    for (std::size_t k = 0; k < lanes; ++k) seen |= admitted.reasons[int(k)];
    if (seen == 0) continue;
    for (std::size_t k = 0; k < lanes && i + k < n; ++k) {
      for (std::size_t bit = 0; bit < fired.size(); ++bit) fired[bit] += (admitted.reasons[int(k)] >> bit) & 1;
    }
    store_state<P>(admitted.state, state, i, n);
  }
  return fired;
}

}  // namespace grainlaw::batch
