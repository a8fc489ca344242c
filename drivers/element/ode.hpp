// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace grainlaw::element {

/// y' = f(t, y) without its law: what an integrator needs to know.
struct Ode {
  int size = 0;
  void* self = nullptr;
  /// 0 when done; anything else: this state is inadmissible, try a smaller step.
  int (*derivative)(void* self, double t, const double* y, double* dydt) = nullptr;
  /// The error per step that is allowed in each component at this state.
  void (*tolerance)(void* self, const double* y, double* allowed) = nullptr;
  /// Whether a fixed step from one state to the next can be believed.
  bool (*acceptable)(void* self, double t, const double* before, const double* y) = nullptr;
};

enum class Method { bdf, adams, bs32, dp54, ck54, fehlberg54, zonneveld43, euler, midpoint, heun, rk4 };

struct MethodInfo {
  Method method;
  std::string name;
  int order;
  bool fixed_step;
  std::string description;
};
const std::vector<MethodInfo>& methods();
const MethodInfo& info(Method method);

struct Counters {
  long rhs_evaluations = 0;
  long steps = 0;
  long rejected = 0;
  long retries = 0;  ///< restarts after an inadmissible trial state
};

struct IntegratorSettings {
  Method method = Method::dp54;
  double fixed_step = 0;  ///< [s]
  double first_step = 0;  ///< largest first step after a start [s]; 0: the integrator's own guess
  /// Called every few thousand evaluations with the present time and step; false asks for an orderly end.
  std::function<bool(double t, double step)> heartbeat = {};
};

/// Integrates an Ode piece by piece; one thread, not copied, not moved; between two calls of `start` the right-hand
/// side must be smooth.
class Integrator {
 public:
  Integrator(const Ode& ode, const IntegratorSettings& settings);
  ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// Forgets the history and begins at (t, y); the solution will not look beyond t_end.
  void start(double t, const double* y, double t_end);
  /// Brings y to time t <= t_end. False when it cannot; failure() then says why and t_reached() where.
  bool advance(double t, double* y);
  const std::string& failure() const { return failure_text; }
  bool stopped() const { return stop; }  ///< by the heartbeat
  double t_reached() const { return reached; }
  double last_step() const;
  const Counters& counters() const { return totals; }

 private:
  struct Sundials;
  /// 0 when done, 1 to try a smaller step, -1 to give up: what SUNDIALS wants to hear.
  int evaluate(double t, const double* y, double* dydt);
  bool fixed_advance(double t, double* y);
  bool adaptive_advance(double t, double* y);

  Ode ode;
  IntegratorSettings settings;
  std::unique_ptr<Sundials> sundials;
  Counters totals;
  std::string failure_text;
  double reached = 0, end = 0, last_fixed = 0;
  unsigned long evaluations = 0;
  bool stop = false;
  std::vector<double> work;
};

}  // namespace grainlaw::element
