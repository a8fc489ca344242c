// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// A law on a point under a programme of control, seen as an ordinary differential equation.
#include <Eigen/LU>
#include <array>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "element_test.hpp"
#include "rheology/law.hpp"

namespace grainlaw::element {

struct Column {
  std::string name, unit;
  std::string header() const { return name + " [" + unit + "]"; }
};

/// What comes with every row besides its columns.
struct RowInfo {
  SymTensor<double> stress;
  unsigned reasons;  ///< of admit; nothing is changed by looking
};

/// What a run needs from a law, whatever the law: the type behind it is chosen once.
struct AnyPoint {
  Ode ode;
  std::vector<double> initial;
  std::vector<Column> columns;
  std::function<RowInfo(double t, const double* y, double* row)> observe;
  std::function<SymTensor<double>(double t, const double* y)> stress;
  std::string state_form;
  std::shared_ptr<void> owner;
};

/// Unknowns y: the state without the stress components that are held, then the logarithmic strains of the components
/// of L that are free. Held stresses are exact by construction: they never become unknowns.
///
/// With a stress in the state, the free components solve  d(sigma_held)/dt = target'  at every evaluation; in a law
/// without history they solve sigma_held(L) = target. Where a law adds a rate-dependent stress to its history
/// (Bagnold), the history carries the rest of the held total, and only the change of that part caused by the prescribed
/// ramp enters its rate: the part caused by the change of the free components themselves is left out. It vanishes in
/// steady flow and is of the order of d(sigma_v)/dt over the skeleton's stiffness otherwise.
template <class L>
class Point {
 public:
  using State = typename L::template State<double>;
  static constexpr int state_size = count<State, double>;
  static constexpr bool carries_stress = StressInState<L>;

  Point(const L& chosen, const ElementTest& test) : law(chosen), control(test.control), spec(&test) {
    for (int i = 0; i < state_size; ++i) {
      const bool is_held =
          carries_stress && std::find(control.held.begin(), control.held.end(), i) != control.held.end();
      if (!is_held) kept.push_back(i);
    }
    guess.assign(control.held.size(), 0);
    rtol = test.integration.rtol;
    atol = test.integration.atol;
    if constexpr (carries_stress) {
      const Flow<double> moving{control.rate.largest() * control.pattern, test.compaction};
      proportional = norm(law.rate(moving, State{}).sigma) == 0;
      // a test that starts from zero stress still needs a scale: that of a strain of 1e-6
      const double stiffness = norm(law.rate(moving, State{test.initial_stress}).sigma) / control.rate.largest();
      smallest_tolerance = std::max(1e-6 * rtol * stiffness, std::numeric_limits<double>::min());
    }
  }

  int size() const { return int(kept.size() + control.held.size()); }

  std::vector<double> initial() {
    // the initial stress is that of the specimen at rest, before anything moves
    const Flow<double> flow{{}, spec->compaction};
    const State state = law.start(flow, spec->initial_stress);
    std::vector<double> y(std::size_t(size()), 0.0);
    const auto numbers = as_numbers(state);
    for (std::size_t i = 0; i < kept.size(); ++i) y[i] = numbers[std::size_t(kept[i])];
    return y;
  }

  int derivative(double t, const double* y, double* dydt) {
    Flow<double> flow;
    State state;
    if (!resolve(t, y, flow, state)) return 1;
    const auto rate = as_numbers(law.rate(flow, state));
    for (std::size_t i = 0; i < kept.size(); ++i) {
      dydt[i] = rate[std::size_t(kept[i])];
      if (!std::isfinite(dydt[i])) return 1;
    }
    for (std::size_t k = 0; k < control.held.size(); ++k) dydt[kept.size() + k] = guess[k];
    return 0;
  }

  /// The flow and the state at (t, y), the free components of L solved for. False when there is no solution.
  bool resolve(double t, const double* y, Flow<double>& flow, State& state) {
    std::array<double, std::size_t(state_size > 0 ? state_size : 1)> numbers{};
    for (std::size_t i = 0; i < kept.size(); ++i) numbers[std::size_t(kept[i])] = y[i];
    if constexpr (state_size > 0) std::memcpy(&state, numbers.data(), sizeof state);
    const double rate = control.rate.at(t);
    flow.L = rate * control.pattern;
    double volumetric = trace(control.pattern) * control.rate.strain(t);
    for (std::size_t k = 0; k < control.held.size(); ++k) volumetric += y[kept.size() + k];
    flow.compaction = spec->compaction + (1 + spec->compaction) * std::expm1(-volumetric);
    return control.held.empty() || solve_free(t, flow, state);
  }

  void tolerance(const double* y, double* allowed) const {
    if constexpr (!carries_stress && state_size > 0) {
      // dimensionless logarithmic state: an absolute error in ln|tr| is a relative error of the stress. An absolute
      // stress tolerance loosens it where the stress is small, but never beyond 1e-6.
      const double stress = std::exp(std::min(y[0], 700.0));
      const double allow = std::min(rtol + (atol > 0 ? atol / stress : 0), std::max(rtol, 1e-6));
      for (std::size_t i = 0; i < kept.size(); ++i) allowed[i] = allow + 1e-13 * std::abs(y[i]);
    } else {
      double squares = 0;
      for (std::size_t i = 0; i < kept.size(); ++i) squares += y[i] * y[i];
      const double allow = rtol * std::sqrt(squares) + atol;
      for (std::size_t i = 0; i < kept.size(); ++i)
        allowed[i] =
            std::max(allow, norm(spec->initial_stress) > 0 ? std::numeric_limits<double>::min() : smallest_tolerance);
    }
    for (std::size_t i = kept.size(); i < std::size_t(size()); ++i)
      allowed[i] = rtol * 1e-2;  // strains of order 0.01-1
  }

  /// A fixed step is not believed when it leaves the states that the law admits (a particle code would mend them and go
  /// on), nor when a stress that grows in proportion to itself more than doubles: an explicit step beyond its stability
  /// limit does the one or the other.
  bool acceptable(double t, const double* before, const double* y) {
    Flow<double> flow;
    State state;
    if (!resolve(t, y, flow, state)) return false;
    if ((unsigned(law.admit(flow, state).reasons) & (tension | pressure_floor | not_finite)) != 0) return false;
    if constexpr (carries_stress) {
      if (!proportional) return true;
      double change = 0, size = 0;
      for (std::size_t i = 0; i < kept.size(); ++i) {
        change += (y[i] - before[i]) * (y[i] - before[i]);
        size += before[i] * before[i];
      }
      return change <= size;
    } else if constexpr (state_size > 0) {
      return std::abs(y[0] - before[0]) <= 0.6931471805599453;  // ln 2
    }
    return true;
  }

  SymTensor<double> stress(double t, const double* y) {
    Flow<double> flow;
    State state;
    if (!resolve(t, y, flow, state)) return isotropic(std::numeric_limits<double>::quiet_NaN());
    return law.stress(flow, state);
  }

  /// Calls sink(name, unit, value) for every column of a row.
  template <class Sink>
  RowInfo row(double t, const double* y, Sink&& sink) {
    Flow<double> flow{};
    State state{};
    const bool solved = resolve(t, y, flow, state);
    if (!solved) at_rest(flow, state);
    const SymTensor<double> sigma = law.stress(flow, state);
    const Columns& show = spec->columns;
    sink("time", "s", t);
    if (show.spin) sink("revolutions", "-", control.rate.strain(t) / (2 * 3.14159265358979323846));
    if (show.shear_strain) sink("shear_strain", "-", control.pattern.xz * control.rate.strain(t));
    if (show.shear_rate) sink("shear_rate", "1/s", flow.L.xz);
    sink("stress_xx", "Pa", sigma.xx);
    sink("stress_yy", "Pa", sigma.yy);
    sink("stress_zz", "Pa", sigma.zz);
    sink("stress_yz", "Pa", sigma.yz);
    sink("stress_xz", "Pa", sigma.xz);
    sink("stress_xy", "Pa", sigma.xy);
    sink("pressure", "Pa", pressure(sigma));
    sink("q", "Pa", show.axial ? -(sigma.zz - sigma.xx) : von_mises(sigma));
    sink("shear_stress", "Pa", sigma.xz);
    const auto strain = [&](int i, double along) {
      double e = along * control.rate.strain(t);
      for (std::size_t k = 0; k < control.held.size(); ++k) {
        if (control.held[k] == i) e += y[kept.size() + k];
      }
      return e;
    };
    const double xx = strain(0, control.pattern.xx), yy = strain(1, control.pattern.yy),
                 zz = strain(2, control.pattern.zz);
    if (show.axial) {
      sink("axial_strain", "-", zz);
      sink("lateral_strain", "-", xx);
    }
    if (show.axial || show.volumetric) sink("volumetric_strain", "-", xx + yy + zz);
    if (show.excess_pore_pressure) {
      // the total stress that a drained specimen would keep: lateral in the triaxial cell, vertical in simple shear
      const double u = show.axial ? sigma.xx - spec->initial_stress.xx : sigma.zz - spec->initial_stress.zz;
      sink("excess_pore_pressure", "Pa", u);
    }
    law.observe(flow, state, sink);
    return {sigma, solved ? unsigned(law.admit(flow, state).reasons) : unsigned(not_finite)};
  }

  static AnyPoint erase(const L& law, const ElementTest& test, std::string form) {
    auto point = std::make_shared<Point>(law, test);
    AnyPoint any;
    any.ode.size = point->size();
    any.ode.self = point.get();
    any.ode.derivative = [](void* self, double t, const double* y, double* dydt) {
      return static_cast<Point*>(self)->derivative(t, y, dydt);
    };
    any.ode.tolerance = [](void* self, const double* y, double* allowed) {
      static_cast<Point*>(self)->tolerance(y, allowed);
    };
    any.ode.acceptable = [](void* self, double t, const double* before, const double* y) {
      return static_cast<Point*>(self)->acceptable(t, before, y);
    };
    any.initial = point->initial();
    point->row(0, any.initial.data(), [&](std::string_view name, std::string_view unit, double) {
      any.columns.push_back({std::string(name), std::string(unit)});
    });
    any.observe = [p = point.get()](double t, const double* y, double* row) {
      return p->row(t, y, [&](std::string_view, std::string_view, double value) { *row++ = value; });
    };
    any.stress = [p = point.get()](double t, const double* y) { return p->stress(t, y); };
    any.state_form = std::move(form);
    any.owner = point;
    return any;
  }

 private:
  static std::array<double, std::size_t(state_size > 0 ? state_size : 1)> as_numbers(const State& state) {
    std::array<double, std::size_t(state_size > 0 ? state_size : 1)> numbers{};
    if constexpr (state_size > 0) std::memcpy(numbers.data(), &state, sizeof state);
    return numbers;
  }
  static double component(const SymTensor<double>& a, int i) { return i == 0 ? a.xx : i == 1 ? a.yy : a.zz; }
  static double& component(SymTensor<double>& a, int i) { return i == 0 ? a.xx : i == 1 ? a.yy : a.zz; }
  static double& diagonal(Tensor<double>& a, int i) { return i == 0 ? a.xx : i == 1 ? a.yy : a.zz; }

  /// The same state without motion, where no motion holds the stresses.
  void at_rest(Flow<double>& flow, State& state) const {
    flow.L = {};
    if constexpr (carries_stress) {
      for (const int i : control.held) component(state.sigma, i) = component(control.held_stress, i);
    }
  }

  /// What is left of the held components' equations with free components w; sets flow and state accordingly.
  void mismatch(double t, const double* w, const Flow<double>& base, Flow<double>& flow, State& state,
                double* f) const {
    flow = base;
    for (std::size_t k = 0; k < control.held.size(); ++k) diagonal(flow.L, control.held[k]) += w[k];
    if constexpr (carries_stress) {
      const SymTensor<double> added = law.stress(flow, state) - state.sigma;  // the rate-dependent part
      for (const int i : control.held)
        component(state.sigma, i) = component(control.held_stress, i) - component(added, i);
      SymTensor<double> drift{};
      const double slope = control.rate.slope(t), now = control.rate.at(t);
      if (slope != 0 && norm(added) > 0) {
        const double dt = 1e-6 * std::max(std::abs(now), std::abs(slope)) / std::abs(slope);
        Flow<double> later = flow;
        later.L = flow.L + (slope * dt) * control.pattern;
        drift = (1 / dt) * ((law.stress(later, state) - state.sigma) - (law.stress(flow, state) - state.sigma));
      }
      const SymTensor<double> rate = law.rate(flow, state).sigma;
      for (std::size_t k = 0; k < control.held.size(); ++k) {
        f[k] = component(rate, control.held[k]) + component(drift, control.held[k]);
      }
    } else {
      const SymTensor<double> sigma = law.stress(flow, state);
      for (std::size_t k = 0; k < control.held.size(); ++k) {
        f[k] = component(sigma, control.held[k]) - component(control.held_stress, control.held[k]);
      }
    }
  }

  /// Newton for at most three unknowns, from the last solution.
  bool solve_free(double t, Flow<double>& flow, State& state) {
    const std::size_t n = control.held.size();
    const Flow<double> base = flow;
    // at a reversal the ramp passes zero to round-off only
    const double loading = norm(symmetric(base.L)),
                 rest = 1e-13 * control.rate.largest() * norm(symmetric(control.pattern));
    const double scale = loading > rest ? loading : 0;
    if (scale == 0 && carries_stress) {
      std::fill(guess.begin(), guess.end(), 0.0);
      double f[3];
      mismatch(t, guess.data(), base, flow, state, f);
      return true;
    }
    const double unit = scale > 0 ? scale : 1;
    // rows beyond n stay those of the identity
    Eigen::Vector3d w = Eigen::Vector3d::Zero(), f = w, g = w;
    Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
    std::copy(guess.begin(), guess.end(), w.data());
    // the last solution may belong to a much faster flow
    if constexpr (carries_stress) w = w.cwiseMax(-5 * unit).cwiseMin(5 * unit);
    for (int iteration = 0; iteration < 60; ++iteration) {
      mismatch(t, w.data(), base, flow, state, f.data());
      for (Eigen::Index c = 0; c < Eigen::Index(n); ++c) {
        const double h = 1e-7 * unit;
        Eigen::Vector3d trial = w;
        trial[c] += h;
        Flow<double> nearby;
        mismatch(t, trial.data(), base, nearby, state, g.data());
        J.col(c) = (g - f) / h;
      }
      // far steps come from the kink of |D|; a few loading rates at a time bring the iteration home
      const double far = carries_stress ? 5 * unit : std::numeric_limits<double>::max();
      const Eigen::Vector3d step = J.partialPivLu().solve(f).cwiseMax(-far).cwiseMin(far);
      if (!step.allFinite()) return false;
      w -= step;
      if (!(w.lpNorm<Eigen::Infinity>() < 1e12 * unit)) return false;
      if (step.lpNorm<Eigen::Infinity>() <= 1e-13 * std::max(unit, w.lpNorm<Eigen::Infinity>())) break;
    }
    mismatch(t, w.data(), base, flow, state, f.data());
    // the last digits of the difference quotient may dance: accept what is converged to nine
    const double size = std::max(unit, w.lpNorm<Eigen::Infinity>());
    if (!((f.cwiseAbs().array() / (J.diagonal().cwiseAbs().array() * size)).maxCoeff() < 1e-9)) return false;
    std::copy(w.data(), w.data() + n, guess.begin());
    return true;
  }

  L law;
  Control control;
  const ElementTest* spec;
  std::vector<int> kept;
  std::vector<double> guess;
  double rtol = 0, atol = 0, smallest_tolerance = std::numeric_limits<double>::min();
  bool proportional = false;  ///< the rate vanishes with the stress
};

}  // namespace grainlaw::element
