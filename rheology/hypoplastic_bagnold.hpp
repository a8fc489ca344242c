// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "bagnold.hpp"
#include "hypoplastic.hpp"

namespace grainlaw {

/// Frictional contacts and collisions at once: the stress is the sum, whatever the regime.
///
///     sigma = sigma_h + sigma_v,   sigma_h from Hypoplastic (history),   sigma_v from Bagnold (rate)
///
/// Source   Peng, Guo, Wu & Wang, Acta Geotechnica 11 (2016) 1231, Eqs 2 and 13.
/// Inputs, state, valid range and failures are those of the two parts; the state is that of the skeleton.
template <class Critical = CriticalState, class Form = StressForm, class Collisions = Bagnold>
struct HypoplasticBagnold {
  using Skeleton = Hypoplastic<Critical, Form>;
  Skeleton skeleton;
  [[no_unique_address]] Collisions collisions;

  template <class R>
  using State = typename Skeleton::template State<R>;

  static constexpr std::string_view name = "hypoplastic_bagnold";
  static constexpr std::string_view source = "Peng, Guo, Wu & Wang, Acta Geotechnica 11 (2016) 1231, Eqs 3-7, 12, 13";
  static constexpr std::string_view valid = "that of hypoplastic, with k_v of the solid fraction at hand";

  constexpr auto parts() { return std::tie(skeleton, collisions); }
  constexpr auto parts() const { return std::tie(skeleton, collisions); }

  template <class R>
  constexpr SymTensor<R> stress(const Flow<R>& flow, const State<R>& state) const noexcept {
    if constexpr (on<Collisions>) {
      return skeleton.stress(flow, state) + collisions.collisional(flow);
    } else {
      return skeleton.stress(flow, state);
    }
  }
  template <class R>
  constexpr State<R> rate(const Flow<R>& flow, const State<R>& state) const noexcept {
    return skeleton.rate(flow, state);
  }
  template <class R>
  constexpr State<R> start(const Flow<R>& flow, const SymTensor<R>& sigma) const noexcept {
    if constexpr (on<Collisions>) {
      return skeleton.start(flow, sigma - collisions.collisional(flow));
    } else {
      return skeleton.start(flow, sigma);
    }
  }
  template <class R>
  constexpr Admitted<State<R>, R> admit(const Flow<R>& flow, const State<R>& state) const noexcept {
    return skeleton.admit(flow, state);
  }
  template <class R>
  constexpr R wave_speed(const Flow<R>& flow, const State<R>& state, const R& density) const noexcept {
    const R c = skeleton.wave_speed(flow, state, density);
    if constexpr (on<Collisions>) {
      const R v = collisions.wave_speed(flow, {}, density);
      return real::sqrt<R>(c * c + v * v);
    } else {
      return c;
    }
  }
  template <class R>
  constexpr R viscosity(const Flow<R>& flow, const State<R>& state) const noexcept {
    if constexpr (on<Collisions>) {
      return collisions.viscosity(flow, {});
    } else {
      return skeleton.viscosity(flow, state);
    }
  }
  template <class R, class Sink>
  constexpr void observe(const Flow<R>& flow, const State<R>& state, Sink&& sink) const {
    if constexpr (on<Collisions>) {
      const R total = pressure(stress(flow, state)), collisional = pressure(collisions.collisional(flow));
      sink("collisional_fraction", "-", real::select<R>(total > R(0), collisional / total, R(0)));
      skeleton.observe(flow, state, sink);
      collisions.observe(flow, {}, sink);
    } else {
      skeleton.observe(flow, state, sink);
    }
  }
};

}  // namespace grainlaw
