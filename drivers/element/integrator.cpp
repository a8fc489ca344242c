// SPDX-License-Identifier: BSD-3-Clause
// The only file that knows SUNDIALS.
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "ode.hpp"

namespace grainlaw::element {

const std::vector<MethodInfo>& methods() {
  static const std::vector<MethodInfo> list{
      {Method::bdf, "bdf", 5, false, "CVODE, variable-order BDF with Newton: long and stiff paths"},
      {Method::adams, "adams", 12, false, "CVODE, variable-order Adams with fixed-point iteration: smooth paths"},
      {Method::bs32, "bs32", 3, false, "ARKODE, Bogacki-Shampine 3(2)"},
      {Method::dp54, "dp54", 5, false, "ARKODE, Dormand-Prince 5(4)"},
      {Method::ck54, "ck54", 5, false, "ARKODE, Cash-Karp 5(4)"},
      {Method::fehlberg54, "fehlberg54", 5, false, "ARKODE, Fehlberg 5(4)"},
      {Method::zonneveld43, "zonneveld43", 4, false, "ARKODE, Zonneveld 4(3)"},
      {Method::euler, "euler", 1, true, "explicit Euler with a fixed step"},
      {Method::midpoint, "midpoint", 2, true, "explicit midpoint with a fixed step (the papers' predictor-corrector)"},
      {Method::heun, "heun", 2, true, "Heun with a fixed step"},
      {Method::rk4, "rk4", 4, true, "classical Runge-Kutta with a fixed step"}};
  return list;
}

const MethodInfo& info(Method method) {
  return *std::find_if(methods().begin(), methods().end(), [&](const auto& m) { return m.method == method; });
}

namespace {

constexpr long steps_per_call = 5000;  // then it is asked whether the time still moves
constexpr int most_retries = 12;       // each one divides the step by four: 4^12 = 1.7e7

/// Which family of SUNDIALS calls a method needs.
enum class Family { cvode, erk };

Family family(Method method) { return method == Method::bdf || method == Method::adams ? Family::cvode : Family::erk; }

/// Tables for which ERKStep of SUNDIALS 6.4.1 keeps its order; in others it reuses a stage that it must not.
ARKODE_ERKTableID table(Method method) {
  switch (method) {
    case Method::bs32:
      return ARKODE_BOGACKI_SHAMPINE_4_2_3;
    case Method::ck54:
      return ARKODE_CASH_KARP_6_4_5;
    case Method::fehlberg54:
      return ARKODE_FEHLBERG_6_4_5;
    case Method::zonneveld43:
      return ARKODE_ZONNEVELD_5_3_4;
    default:
      return ARKODE_DORMAND_PRINCE_7_4_5;
  }
}

/// What SUNDIALS hands back to its callbacks.
struct User {
  const Ode* ode;
  std::function<int(double, const double*, double*)> evaluate;
};

int derivative_of(realtype t, N_Vector y, N_Vector dydt, void* user) {
  return static_cast<const User*>(user)->evaluate(t, NV_DATA_S(y), NV_DATA_S(dydt));
}

int weights_of(N_Vector y, N_Vector weights, void* user) {
  const Ode& ode = *static_cast<const User*>(user)->ode;
  double* w = NV_DATA_S(weights);
  ode.tolerance(ode.self, NV_DATA_S(y), w);
  for (int i = 0; i < ode.size; ++i) {
    if (!(w[i] > 0)) return -1;
    w[i] = 1 / w[i];
  }
  return 0;
}

/// SUNDIALS prints its warnings to stderr by default; ours come from the return value.
void quiet(int /*code*/, const char* /*module*/, const char* /*function*/, char* /*message*/, void* /*data*/) {}

void check(int flag, const char* call) {
  if (flag < 0) throw std::runtime_error(fmt::format("SUNDIALS: {} returned {}", call, flag));
}

std::string words(Family kind, int flag) {
  if (kind == Family::cvode) {
    switch (flag) {
      case CV_TOO_MUCH_WORK:
        return "too many steps";
      case CV_TOO_MUCH_ACC:
        return "the tolerance is below what double precision can give";
      case CV_ERR_FAILURE:
        return "the error test failed again and again: the solution is not smooth here";
      case CV_CONV_FAILURE:
        return "the Newton iteration did not converge";
      case CV_RHSFUNC_FAIL:
      case CV_FIRST_RHSFUNC_ERR:
      case CV_REPTD_RHSFUNC_ERR:
      case CV_UNREC_RHSFUNC_ERR:
        return "the law has no rate at the states tried";
      default:
        return fmt::format("CVODE returned {}", flag);
    }
  }
  switch (flag) {
    case ARK_TOO_MUCH_WORK:
      return "too many steps";
    case ARK_TOO_MUCH_ACC:
      return "the tolerance is below what double precision can give";
    case ARK_ERR_FAILURE:
      return "the error test failed again and again: the solution is not smooth here";
    case ARK_RHSFUNC_FAIL:
    case ARK_FIRST_RHSFUNC_ERR:
    case ARK_REPTD_RHSFUNC_ERR:
    case ARK_UNREC_RHSFUNC_ERR:
      return "the law has no rate at the states tried";
    default:
      return fmt::format("ARKODE returned {}", flag);
  }
}

}  // namespace

struct Integrator::Sundials {
  Sundials(const Ode& ode, Method method, std::function<int(double, const double*, double*)> evaluate)
      : user{&ode, std::move(evaluate)}, kind(family(method)) {
    if (SUNContext_Create(nullptr, &context) != 0) throw std::runtime_error("SUNDIALS: no context");
    y = N_VNew_Serial(ode.size, context);
    N_VEnableFusedOps_Serial(y, SUNTRUE);  // vectors of seven numbers: the calls cost more than the sums
    N_VConst(0, y);
    switch (kind) {
      case Family::cvode:
        memory = CVodeCreate(method == Method::bdf ? CV_BDF : CV_ADAMS, context);
        check(CVodeInit(memory, derivative_of, 0, y), "CVodeInit");
        check(CVodeSetUserData(memory, &user), "CVodeSetUserData");
        CVodeSetErrHandlerFn(memory, quiet, nullptr);
        check(CVodeWFtolerances(memory, weights_of), "CVodeWFtolerances");
        CVodeSetMaxNumSteps(memory, steps_per_call);
        if (method == Method::bdf) {
          matrix = SUNDenseMatrix(ode.size, ode.size, context);
          linear = SUNLinSol_Dense(y, matrix, context);
          check(CVodeSetLinearSolver(memory, linear, matrix), "CVodeSetLinearSolver");
        } else {
          nonlinear = SUNNonlinSol_FixedPoint(y, 0, context);
          check(CVodeSetNonlinearSolver(memory, nonlinear), "CVodeSetNonlinearSolver");
        }
        break;
      case Family::erk:
        memory = ERKStepCreate(derivative_of, 0, y, context);
        check(ERKStepSetTableNum(memory, table(method)), "ERKStepSetTableNum");
        check(ERKStepSetUserData(memory, &user), "ERKStepSetUserData");
        ERKStepSetErrHandlerFn(memory, quiet, nullptr);
        check(ERKStepWFtolerances(memory, weights_of), "ERKStepWFtolerances");
        ERKStepSetMaxNumSteps(memory, steps_per_call);
        break;
    }
  }

  ~Sundials() {
    if (kind == Family::cvode) CVodeFree(&memory);
    if (kind == Family::erk) ERKStepFree(&memory);
    if (linear) SUNLinSolFree(linear);
    if (nonlinear) SUNNonlinSolFree(nonlinear);
    if (matrix) SUNMatDestroy(matrix);
    N_VDestroy(y);
    SUNContext_Free(&context);
  }
  Sundials(const Sundials&) = delete;
  Sundials& operator=(const Sundials&) = delete;

  void restart(double t, double t_end, double first_step, double largest_step) {
    // a stop time may survive a restart in this version, so it is set anew every time
    switch (kind) {
      case Family::cvode:
        check(CVodeReInit(memory, t, y), "CVodeReInit");
        CVodeSetInitStep(memory, first_step);
        CVodeSetMaxStep(memory, largest_step);
        CVodeSetStopTime(memory, t_end);
        break;
      case Family::erk:
        check(ERKStepReInit(memory, derivative_of, t, y), "ERKStepReInit");
        ERKStepSetInitStep(memory, first_step);
        ERKStepSetMaxStep(memory, largest_step);
        ERKStepSetStopTime(memory, t_end);
        break;
    }
    base = Counters{};
  }

  int evolve(double t, double* reached) {
    return kind == Family::cvode ? CVode(memory, t, y, reached, CV_NORMAL)
                                 : ERKStepEvolve(memory, t, y, reached, ARK_NORMAL);
  }

  double last_step() const {
    double h = 0;
    if (kind == Family::cvode) CVodeGetLastStep(memory, &h);
    if (kind == Family::erk) ERKStepGetLastStep(memory, &h);
    return h;
  }

  /// Adds what happened since the last call.
  void add_to(Counters& totals) {
    Counters now;
    long from_jacobian = 0;
    switch (kind) {
      case Family::cvode:
        CVodeGetNumRhsEvals(memory, &now.rhs_evaluations);
        if (linear) CVodeGetNumLinRhsEvals(memory, &from_jacobian);
        CVodeGetNumSteps(memory, &now.steps);
        CVodeGetNumErrTestFails(memory, &now.rejected);
        break;
      case Family::erk:
        ERKStepGetNumRhsEvals(memory, &now.rhs_evaluations);
        ERKStepGetNumSteps(memory, &now.steps);
        ERKStepGetNumErrTestFails(memory, &now.rejected);
        break;
    }
    now.rhs_evaluations += from_jacobian;
    totals.rhs_evaluations += now.rhs_evaluations - base.rhs_evaluations;
    totals.steps += now.steps - base.steps;
    totals.rejected += now.rejected - base.rejected;
    base = now;
  }

  User user;
  Family kind;
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  void* memory = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  SUNNonlinearSolver nonlinear = nullptr;
  Counters base;
};

Integrator::Integrator(const Ode& problem, const IntegratorSettings& chosen) : ode(problem), settings(chosen) {
  if (ode.size > 0 && !info(settings.method).fixed_step) {
    sundials = std::make_unique<Sundials>(
        ode, settings.method, [this](double t, const double* y, double* dydt) { return evaluate(t, y, dydt); });
  }
  work.resize(std::size_t(ode.size) * 6);
}

int Integrator::evaluate(double t, const double* y, double* dydt) {
  if (++evaluations % 4096 == 0 && settings.heartbeat && !settings.heartbeat(t, last_step())) stop = true;
  if (stop) return -1;
  return ode.derivative(ode.self, t, y, dydt) == 0 ? 0 : 1;
}

Integrator::~Integrator() = default;

double Integrator::last_step() const { return sundials ? sundials->last_step() : last_fixed; }

void Integrator::start(double t, const double* y, double t_end) {
  reached = t;
  end = t_end;
  if (!sundials) return;
  std::copy(y, y + ode.size, NV_DATA_S(sundials->y));
  sundials->restart(t, t_end, std::min(settings.first_step, t_end - t), 0);
}

bool Integrator::advance(double t, double* y) {
  if (t <= reached) return true;
  if (ode.size == 0) {
    reached = t;
    return true;
  }
  return sundials ? adaptive_advance(t, y) : fixed_advance(t, y);
}

bool Integrator::adaptive_advance(double t, double* y) {
  std::copy(y, y + ode.size, work.begin());  // to begin again from here if a trial state is inadmissible
  const double t_from = reached;
  double largest = t - t_from, at = t_from;
  for (int attempt = 0;; ++attempt) {
    const double before = at;
    const int flag = sundials->evolve(t, &at);
    sundials->add_to(totals);
    if (flag >= 0) {
      std::copy(NV_DATA_S(sundials->y), NV_DATA_S(sundials->y) + ode.size, y);
      reached = t;
      return true;
    }
    if (stop) {
      reached = at;
      failure_text = "stopped";
      return false;
    }
    // the same number in CVODE and ARKODE
    if (flag == ARK_TOO_MUCH_WORK && at - before > 1e-6 * (t - t_from)) continue;
    // Explicit ARKODE cannot recover from a trial state that the law refuses: start again with smaller steps.
    const bool inadmissible =
        flag == ARK_UNREC_RHSFUNC_ERR || flag == ARK_REPTD_RHSFUNC_ERR || flag == ARK_RHSFUNC_FAIL;
    if (sundials->kind == Family::cvode || !inadmissible || attempt == most_retries) {
      std::copy(NV_DATA_S(sundials->y), NV_DATA_S(sundials->y) + ode.size, y);
      reached = at;
      failure_text = words(sundials->kind, flag);
      return false;
    }
    ++totals.retries;
    largest /= 4;
    std::copy(work.begin(), work.begin() + ode.size, NV_DATA_S(sundials->y));
    sundials->restart(t_from, end, largest / 1024, largest);
  }
}

bool Integrator::fixed_advance(double t, double* y) {
  const std::size_t n = std::size_t(ode.size);
  double *k1 = work.data(), *k2 = k1 + n, *k3 = k2 + n, *k4 = k3 + n, *trial = k4 + n, *good = trial + n;
  const auto rate = [&](double at, const double* state, double* k) {
    ++totals.rhs_evaluations;
    return evaluate(at, state, k) == 0;
  };
  const auto step_from = [&](double h, const double* k) {
    for (std::size_t i = 0; i < n; ++i) trial[i] = y[i] + h * k[i];
    return trial;
  };
  const double t_from = reached;
  // the last step to a row is shortened by less than one step, so that rows lie where they were asked for
  const long steps = std::max(1L, long(std::ceil((t - t_from) / settings.fixed_step * (1 - 1e-12))));
  for (long s = 0; s < steps; ++s) {
    const double at = t_from + (t - t_from) * double(s) / double(steps), h = (t - t_from) / double(steps);
    std::copy(y, y + n, good);
    bool fine = rate(at, y, k1);
    switch (settings.method) {
      case Method::euler:
        for (std::size_t i = 0; i < n; ++i) y[i] += h * k1[i];
        break;
      case Method::midpoint:
        fine = fine && rate(at + h / 2, step_from(h / 2, k1), k2);
        for (std::size_t i = 0; i < n; ++i) y[i] += h * k2[i];
        break;
      case Method::heun:
        fine = fine && rate(at + h, step_from(h, k1), k2);
        for (std::size_t i = 0; i < n; ++i) y[i] += h * (k1[i] + k2[i]) / 2;
        break;
      default:
        fine = fine && rate(at + h / 2, step_from(h / 2, k1), k2) && rate(at + h / 2, step_from(h / 2, k2), k3) &&
               rate(at + h, step_from(h, k3), k4);
        for (std::size_t i = 0; i < n; ++i) y[i] += h * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]) / 6;
        break;
    }
    ++totals.steps;
    last_fixed = h;
    fine = fine && std::all_of(y, y + n, [](double v) { return std::isfinite(v); });
    if (!fine || (ode.acceptable && !ode.acceptable(ode.self, at + h, good, y))) {
      std::copy(good, good + n, y);
      reached = at;
      failure_text = stop    ? "stopped"
                     : !fine ? "the law has no rate at the states tried"
                             : "the fixed step is beyond the stability limit of this law";
      return false;
    }
  }
  reached = t;
  return true;
}

}  // namespace grainlaw::element
