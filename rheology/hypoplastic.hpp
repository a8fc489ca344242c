// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "critical_state.hpp"

namespace grainlaw {

/// The six stress components as they are: what particle codes carry.
struct StressForm {
  template <class R>
  struct State {
    SymTensor<R> sigma;  ///< [Pa]
  };
  static constexpr std::string_view name = "stress";
};

/// sigma = tr (s + I/3) with ln|tr| and the trace-free s = dev(sigma)/tr: compression only, and it survives a
/// liquefaction over any number of decades. s_xx = -(s_yy + s_zz), so the trace cannot drift.
struct LogForm {
  template <class R>
  struct State {
    R ln_trace;            ///< ln of |tr sigma| in Pa
    R yy, zz, yz, xz, xy;  ///< of s [-]
    constexpr SymTensor<R> s() const { return {-(yy + zz), yy, zz, yz, xz, xy}; }
  };
  static constexpr std::string_view name = "logarithmic";
};

/// Wu-Bauer-Kolymbas hypoplasticity: one equation for loading and unloading, no yield surface, homogeneous of degree
/// one in the stress.
///
///     d(sigma)/dt = c1 tr D + c2 (sigma:D/tr) sigma + I_e |D| (c3 sigma^2 + c4 s^2)/tr + W sigma - sigma W
///     tr = tr(sigma) < 0,  s = dev(sigma),  |D| = sqrt(D:D)
///
/// Source   Peng, Guo, Wu & Wang, Acta Geotechnica 11 (2016) 1231, Eqs 3-7; Wu, Bauer & Kolymbas,
///          Mech. Mater. 23 (1996) 45. I_e multiplies the two norm terms only.
/// Inputs   L [1/s], compaction [-].   State   sigma [Pa], or ln|tr| [-] and dev(sigma)/tr [-]
/// Output   rate of the state [Pa/s] or [1/s]; stress = state, independent of L
/// Valid    compressive principal stresses. They stay compressive while I_e >= 9 |c1|/c4 (a theorem for the exact
///          flow; a step that is too large can leave the cone, and `admit` brings it back).
/// Fails    never: at zero stress the rate is zero. In tension the law is its own mirror image and a point would never
///          come back: project with `admit`.
template <class Critical = CriticalState, class Form = StressForm>
struct Hypoplastic {
  Constant c1, c2, c3, c4;
  Constant p_floor;  ///< [Pa]
  [[no_unique_address]] Critical critical;

  template <class R>
  using State = typename Form::template State<R>;

  static constexpr std::string_view name = "hypoplastic";
  static constexpr std::string_view source = "Peng, Guo, Wu & Wang, Acta Geotechnica 11 (2016) 1231, Eqs 3-7";
  static constexpr std::string_view valid = "compressive stress, e_min <= e, e_crt(|tr sigma|) > e_min";

  static constexpr auto parameters() {
    using P = Parameter<Hypoplastic>;
    return std::array{
        P{"c1", "-", "stiffness, -E/(3p(1+nu))", &Hypoplastic::c1, -1e4, -1e-6},
        P{"c2", "-", "stiffness along the stress", &Hypoplastic::c2, -1e6, 1e6},
        P{"c3", "-", "non-linear term in sigma^2", &Hypoplastic::c3, -1e6, 1e6},
        P{"c4", "-", "non-linear term in s^2", &Hypoplastic::c4, 1e-6, 1e6},
        P{"p_floor", "Pa", "smallest pressure that admit lets through", &Hypoplastic::p_floor, 0.0, 1e9, 0.0}};
  }
  constexpr auto parts() { return std::tie(critical); }
  constexpr auto parts() const { return std::tie(critical); }

  template <class R>
  constexpr SymTensor<R> stress(const Flow<R>& /*flow*/, const State<R>& state) const noexcept {
    return stress_of(state);
  }

  template <class R>
  constexpr State<R> rate(const Flow<R>& flow, const State<R>& state) const noexcept {
    const SymTensor<R> D = symmetric(flow.L);
    if constexpr (std::is_same_v<Form, StressForm>) {
      const R tr = trace(state.sigma);
      // no 0/0 at rest, and no square of a subnormal number: the law is written in sigma/tr
      const R inverse = real::select<R>(real::abs(tr) < real::tiny<R>(), R(0), R(1) / tr);
      const SymTensor<R> r = inverse * state.sigma;
      return {tr * relative_rate(r, deviator(r), D, density_factor(flow.compaction, real::abs(tr))) +
              spin_rate(flow.L, state.sigma)};
    } else {
      const SymTensor<R> s = state.s();
      const SymTensor<R> r = plus_isotropic<R>(s, Constant(1.0 / 3).as<R>());
      const SymTensor<R> B = relative_rate(r, s, D, density_factor(flow.compaction, real::exp(state.ln_trace)));
      const R growth = trace(B);
      const SymTensor<R> ds = deviator(B) - growth * s + spin_rate(flow.L, s);
      return {growth, ds.yy, ds.zz, ds.yz, ds.xz, ds.xy};
    }
  }

  /// A state whose stress is sigma; the logarithmic form needs tr(sigma) < 0 and gives NaN otherwise.
  template <class R>
  constexpr State<R> start(const Flow<R>& /*flow*/, const SymTensor<R>& sigma) const noexcept {
    if constexpr (std::is_same_v<Form, StressForm>) {
      return {sigma};
    } else {
      const R tr = trace(sigma);
      const SymTensor<R> s = (R(1) / tr) * deviator(sigma);
      return {real::log<R>(-tr), s.yy, s.zz, s.yz, s.xz, s.xy};
    }
  }

  /// Keeps p >= p_floor and every principal stress compressive: the deviator is scaled back onto 99.9 % of the cone.
  template <class R>
  constexpr Admitted<State<R>, R> admit(const Flow<R>& flow, const State<R>& state) const noexcept {
    if constexpr (std::is_same_v<Form, StressForm>) {
      const SymTensor<R> s = deviator(state.sigma);
      const R p = pressure(state.sigma);
      // -sigma is positive definite exactly when its three invariants are positive: no eigenvalues needed
      const R J2 = Constant(0.5) * contract(s, s), J3 = determinant(s);
      const mask_t<R> low = p < p_floor.as<R>();
      const mask_t<R> pulls = p < R(0) || !(Constant(3) * p * p > J2) || !(p * (p * p - J2) > J3);
      const mask_t<R> rest = J2 == R(0) && p >= p_floor.as<R>() && p >= R(0);  // zero stress is admissible
      const mask_t<R> broken = !(size_of(state.sigma) < real::largest_stress<R>()) || too_fast(flow);
      bits_t<R> reasons = real::flag<R>(low, pressure_floor) | real::flag<R>(pulls && !rest, tension) |
                          real::flag<R>(broken, not_finite);
      if constexpr (on<Critical>) {
        reasons =
            reasons | real::flag<R>(critical.outside(flow.compaction, R(Constant(3) * real::abs(p))), beyond_validity);
      }
      Admitted<State<R>, R> result{state, reasons};
      const mask_t<R> mend = (low || (pulls && !rest)) && !broken;
      if (real::any<R>(mend)) {
        // a little above the floor, so that the rounding of the trace does not put it below again
        const R q = real::select<R>(low, p_floor * R(1 + 16 * std::numeric_limits<scalar_t<R>>::epsilon()), p);
        const R keep = kept_deviator(q, J2, J3);
        result.state.sigma = choose<R>(mend, plus_isotropic<R>(keep * s, -q), state.sigma);
      }
      return result;
    } else {
      const SymTensor<R> s = state.s();
      const R third = Constant(1.0 / 3).as<R>();
      // eigenvalues of sigma/tr = 1/3 + s must be positive: those of -s stay below 1/3
      const R J2 = Constant(0.5) * contract(s, s), J3 = -determinant(s);
      const R lowest = p_floor.value > 0 ? R(static_cast<scalar_t<R>>(std::log(3 * p_floor.value)))
                                         : R(-std::numeric_limits<scalar_t<R>>::infinity());
      const mask_t<R> low = state.ln_trace < lowest;
      const mask_t<R> pulls = !(third > J2) || !(third * (third * third - J2) > J3);
      const mask_t<R> broken = !(state.ln_trace < largest_ln<R>()) || !real::is_finite(state.ln_trace) ||
                               !(size_of(s) < real::largest_stress<R>()) || too_fast(flow);
      bits_t<R> reasons =
          real::flag<R>(low, pressure_floor) | real::flag<R>(pulls, tension) | real::flag<R>(broken, not_finite);
      if constexpr (on<Critical>) {
        reasons =
            reasons | real::flag<R>(critical.outside(flow.compaction, real::exp(state.ln_trace)), beyond_validity);
      }
      Admitted<State<R>, R> result{state, reasons};
      if (real::any<R>((low || pulls) && !broken)) {
        const R keep = real::select<R>(pulls, kept_deviator(third, J2, J3), R(1));
        const SymTensor<R> k = keep * s;
        result.state = {real::select<R>(low && !broken, lowest, state.ln_trace), k.yy, k.zz, k.yz, k.xz, k.xy};
      }
      return result;
    }
  }

  /// Bound of sqrt(n.A(n).n/rho) over directions n, loading and unloading: the largest principal stress bounds
  /// each term of the tangent.
  template <class R>
  constexpr R wave_speed(const Flow<R>& flow, const State<R>& state, const R& density) const noexcept {
    const SymTensor<R> sigma = stress_of(state);
    const R t = real::abs(trace(sigma));
    const R s_max = Constant(1.1547005383792517) * real::sqrt(second_invariant(sigma));
    const R sigma_max = Constant(1.0 / 3) * t + s_max;
    const R I = density_factor(flow.compaction, t);
    const R inverse = real::select<R>(t < real::tiny<R>(), R(0), R(1) / t);
    const R linear =
        Constant(std::abs(c1.value)) * t + Constant(std::abs(c2.value)) * (sigma_max * inverse) * sigma_max;
    const R nonlinear =
        I * inverse *
        (Constant(std::abs(c3.value)) * sigma_max * sigma_max + Constant(std::abs(c4.value)) * s_max * s_max);
    return real::sqrt<R>((linear + real::abs(nonlinear) + Constant(2) * sigma_max) / density);
  }
  template <class R>
  constexpr R viscosity(const Flow<R>& /*flow*/, const State<R>& /*state*/) const noexcept {
    return R(0);
  }

  template <class R, class Sink>
  constexpr void observe(const Flow<R>& flow, const State<R>& state, Sink&& sink) const {
    const SymTensor<R> sigma = stress_of(state);
    if constexpr (std::is_same_v<Form, LogForm>) {
      sink("ln_trace", "-", state.ln_trace);
      if constexpr (on<Critical>) critical.observe(flow.compaction, real::exp(state.ln_trace), sink);
    } else {
      const R t = real::abs(trace(sigma));
      sink("ln_trace", "-", real::log<R>(t));
      if constexpr (on<Critical>) critical.observe(flow.compaction, t, sink);
    }
  }

  /// The objective rate divided by the trace: B = c1 D + c2 (r:D) r + I_e |D| (c3 r^2 + c4 s^2), r = sigma/tr.
  template <class R>
  constexpr SymTensor<R> relative_rate(const SymTensor<R>& r, const SymTensor<R>& s, const SymTensor<R>& D,
                                       const R& I_e) const {
    const R n = I_e * real::sqrt(contract(D, D));
    return c1 * D + (c2 * contract(r, D)) * r + (n * c3.as<R>()) * square(r) + (n * c4.as<R>()) * square(s);
  }

  template <class R>
  constexpr R density_factor([[maybe_unused]] const R& compaction, [[maybe_unused]] const R& t) const {
    if constexpr (on<Critical>) {
      return critical.I_e(compaction, t);
    } else {
      return R(1);
    }
  }

 private:
  /// Just below the logarithm of largest_stress.
  template <class R>
  static constexpr R largest_ln() {
    return R(sizeof(scalar_t<R>) == 8 ? scalar_t<R>(230) : scalar_t<R>(27.5f));
  }
  template <class R>
  static constexpr mask_t<R> too_fast(const Flow<R>& flow) {
    return !(size_of(flow.L) < real::largest_rate<R>()) || !(real::abs(flow.compaction) < real::largest_stress<R>());
  }
  template <class R>
  static constexpr SymTensor<R> stress_of(const State<R>& state) {
    if constexpr (std::is_same_v<Form, StressForm>) {
      return state.sigma;
    } else {
      return -real::exp(state.ln_trace) * plus_isotropic<R>(state.s(), Constant(1.0 / 3).as<R>());
    }
  }
  /// The factor on a deviator with invariants J2, J3 that keeps its largest eigenvalue below q.
  template <class R>
  static constexpr R kept_deviator(const R& q, const R& J2, const R& J3) {
    const R largest = real::at_least<R>(largest_of_deviator(J2, J3), real::tiny<R>());
    const R bound = Constant(0.999) * q;
    return real::select<R>(bound < largest, bound / largest, R(1));
  }
};

}  // namespace grainlaw
