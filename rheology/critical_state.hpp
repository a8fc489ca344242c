// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "law.hpp"

namespace grainlaw {

/// Density and pressure dependence of a hypoplastic law: I_e > 1 for loose, I_e < 1 for dense packings.
///
///     t = |tr sigma|,   a = q1 + q2 exp(q3 t),   e_crt = p1 + p2 exp(p3 t)
///     I_e = (a - 1) D_c + 1,   D_c = (e_crt - e)/(e_crt - e_min)
///
/// Source   Peng, Guo, Wu & Wang, Acta Geotechnica 11 (2016) 1231, Eqs 5-7, read with |tr sigma| (full trace) and the
///          current void ratio e: the only reading that gives the paper's Table 3.
/// Inputs   compaction rho/rho_ref - 1 [-], t [Pa].   Output   I_e, D_c, e_crt, a [-]
/// Valid    e_min <= e and e_crt(t) > e_min. I_e = 1 is the critical state in triaxial compression only;
///          see critical_states.hpp for the other modes.
/// Fails    never: an empty space (compaction -1) has a large void ratio; where e < e_min, D_c is held at 1; near the
/// pole e_crt = e_min the difference is held at 1e-6.
///          Both are reported by `admit` as beyond_validity.
struct CriticalState {
  Constant e_min, p1, p2, p3, q1, q2, q3;
  Constant e_ref;  ///< void ratio at zero compaction [-], set by the host

  static constexpr double narrowest = 1e-6;  // of e_crt - e_min: keeps I_e finite at the pole

  static constexpr auto parameters() {
    using P = Parameter<CriticalState>;
    return std::array{P{"e_min", "-", "smallest void ratio", &CriticalState::e_min, 0.0, 5.0},
                      P{"p1", "-", "critical void ratio at infinite pressure", &CriticalState::p1, -5.0, 5.0},
                      P{"p2", "-", "e_crt(0) - p1", &CriticalState::p2, -5.0, 5.0},
                      P{"p3", "1/Pa", "decay of e_crt with |tr sigma|", &CriticalState::p3, -1.0, 0.0},
                      P{"q1", "-", "density factor a at infinite pressure", &CriticalState::q1, 0.0, 2.0},
                      P{"q2", "-", "a(0) - q1", &CriticalState::q2, -2.0, 2.0},
                      P{"q3", "1/Pa", "decay of a with |tr sigma|", &CriticalState::q3, -1.0, 0.0}};
  }

  template <Real R>
  constexpr R void_ratio(const R& compaction) const {
    const R c = real::at_least<R>(compaction, Constant(narrowest - 1).as<R>());
    return (e_ref - c) / (Constant(1) + c);
  }
  template <Real R>
  constexpr R a(const R& t) const {
    return q1 + q2 * real::exp<R>(q3 * t);
  }
  template <Real R>
  constexpr R e_crt(const R& t) const {
    return p1 + p2 * real::exp<R>(p3 * t);
  }
  template <Real R>
  constexpr R D_c(const R& compaction, const R& t) const {
    const R e_c = e_crt(t);
    const R width = real::at_least<R>(e_c - e_min, Constant(narrowest).as<R>());
    return real::at_most<R>((e_c - void_ratio(compaction)) / width, R(1));
  }
  template <Real R>
  constexpr R I_e(const R& compaction, const R& t) const {
    return (a(t) - Constant(1)) * D_c(compaction, t) + Constant(1);
  }
  template <Real R>
  constexpr mask_t<R> outside(const R& compaction, const R& t) const {
    return compaction < Constant(narrowest - 1).as<R>() || void_ratio(compaction) < e_min.as<R>() ||
           e_crt(t) < (e_min + Constant(narrowest).as<R>());
  }
  template <Real R, class Sink>
  constexpr void observe(const R& compaction, const R& t, Sink&& sink) const {
    sink("void_ratio", "-", void_ratio(compaction));
    sink("solid_fraction", "-", R(Constant(1) / (Constant(1) + void_ratio(compaction))));
    sink("e_crt", "-", e_crt(t));
    sink("a", "-", a(t));
    sink("D_c", "-", D_c(compaction, t));
    sink("I_e", "-", I_e(compaction, t));
  }
};

/// The law depends on neither density nor pressure: I_e = 1.
struct NoCriticalState {};

}  // namespace grainlaw
