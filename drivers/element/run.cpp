// SPDX-License-Identifier: BSD-3-Clause
#include "run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "classify.hpp"
#include "with_law.hpp"

namespace grainlaw::element {

int RunRecord::column(std::string_view wanted) const {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == wanted) return int(i);
  }
  return -1;
}

std::vector<double> RunRecord::series(std::string_view wanted) const {
  const int c = column(wanted);
  std::vector<double> list;
  if (c < 0) return list;
  list.reserve(rows());
  for (std::size_t r = 0; r < rows(); ++r) list.push_back(at(r, std::size_t(c)));
  return list;
}

AnyPoint make_point(const ElementTest& test) {
  AnyPoint point;
  with_law(test.material, test.void_ratio.value_or(0), test.integration.form, [&](const auto& law, std::string form) {
    point = Point<std::decay_t<decltype(law)>>::erase(law, test, std::move(form));
  });
  return point;
}

void evaluate_point(const ElementTest& test, std::vector<Column>& columns, std::vector<double>& values) {
  const AnyPoint point = make_point(test);
  columns = point.columns;
  values.resize(columns.size());
  point.observe(0, point.initial.data(), values.data());
  std::vector<double> rate(point.initial.size());
  if (test.integration.form != StateForm::logarithmic && rate.size() == 6) {  // the state is the stress
    point.ode.derivative(point.ode.self, 0, point.initial.data(), rate.data());
    static constexpr std::array names{"xx", "yy", "zz", "yz", "xz", "xy"};
    for (std::size_t i = 0; i < 6; ++i) {
      columns.push_back({fmt::format("rate_{}", names[i]), "Pa/s"});
      values.push_back(rate[i]);
    }
  }
}

namespace {

/// A clock that costs some 20 ns to read, so that the solver can be timed row by row, without the output.
double seconds() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

IntegratorSettings settings_for(const ElementTest& test, const std::function<bool(double, double)>& heartbeat) {
  // The first step spans a strain of 1e-5: small against every strain scale of a granular law, so that no first trial
  // can jump over its initial response.
  const Tensor<double>& l = test.control.pattern;
  const double rate =
      test.control.rate.largest() * std::sqrt(l.xx * l.xx + l.yy * l.yy + l.zz * l.zz + l.xz * l.xz + l.zx * l.zx);
  return {test.integration.method, test.integration.fixed_step, rate > 0 ? 1e-5 / rate : 0, heartbeat};
}

/// Walks an integrator over the rows, restarting at every kink of the programme.
class Walk {
 public:
  Walk(const ElementTest& test, const AnyPoint& point, const std::function<bool(double, double)>& heartbeat = {})
      : integrator(point.ode, settings_for(test, heartbeat)),
        y(point.initial),
        kinks(test.control.rate.kinks(test.until.time)),
        t_end(test.until.time) {
    begin(0);
  }
  bool to(double t) {
    while (next_kink < kinks.size() && kinks[next_kink] <= t) {
      const double kink = kinks[next_kink++];
      if (!integrator.advance(kink, y.data())) return false;
      begin(kink);
    }
    return integrator.advance(t, y.data());
  }
  void restart_from(double t, const std::vector<double>& state) {
    y = state;
    next_kink = std::size_t(std::upper_bound(kinks.begin(), kinks.end(), t) - kinks.begin());
    begin(t);
  }

  Integrator integrator;
  std::vector<double> y;

 private:
  void begin(double t) {
    const double stop = next_kink < kinks.size() ? kinks[next_kink] : t_end;
    integrator.start(t, y.data(), stop);
  }
  std::vector<double> kinks;
  double t_end;
  std::size_t next_kink = 0;
};

/// The instant in [t0, t1] where g changes sign: false position, the weight of the end that stays halved every time,
/// and a bisection now and then.
template <class G>
double root(double t0, double t1, double g0, double g1, const G& g) {
  for (int i = 0; i < 100 && t1 - t0 > 1e-14 * std::max(std::abs(t0), std::abs(t1)); ++i) {
    double t = (t0 * g1 - t1 * g0) / (g1 - g0);
    if (!(t > t0 && t < t1) || i % 8 == 7) t = 0.5 * (t0 + t1);
    const double value = g(t);
    if (value == 0) return t;
    if ((value > 0) == (g1 > 0)) {
      t1 = t;
      g1 = value;
      g0 *= 0.5;
    } else {
      t0 = t;
      g0 = value;
      g1 *= 0.5;
    }
    if (std::abs(t1 - t0) < 1e-13 * std::abs(t1)) break;
  }
  return 0.5 * (t0 + t1);
}

struct Path {
  std::vector<double> times;
  std::vector<std::vector<double>> states;
};

/// Time derivative of a column, along the direction that the law gives.
double column_rate(const AnyPoint& point, std::size_t column, double t, const std::vector<double>& y, double dt) {
  std::vector<double> dydt(y.size()), trial(y), row(point.columns.size());
  if (!y.empty() && point.ode.derivative(point.ode.self, t, y.data(), dydt.data()) != 0) return std::nan("");
  double values[2];
  for (const int side : {0, 1}) {
    const double h = side == 0 ? -dt : dt;
    for (std::size_t i = 0; i < y.size(); ++i) trial[i] = y[i] + h * dydt[i];
    point.observe(t + h, trial.data(), row.data());
    values[side] = row[column];
  }
  return (values[1] - values[0]) / (2 * dt);
}

/// The extremum of a column between two stored rows around row i.
Extremum locate(const ElementTest& test, const AnyPoint& point, const Path& path, std::size_t column, std::size_t i,
                bool maximum) {
  Extremum e{point.columns[column].name, point.columns[column].unit, maximum, 0,
             std::vector<double>(point.columns.size())};
  const double t0 = path.times[i - 1], t1 = path.times[i + 1];
  const double dt = 3e-4 * (t1 - t0);  // balances round-off against curvature
  Walk walk(test, point);
  const auto state_at = [&](double t) {
    walk.restart_from(t0, path.states[i - 1]);
    walk.to(t);
    return walk.y;
  };
  const auto slope = [&](double t) { return column_rate(point, column, t, state_at(t), dt); };
  const double g0 = column_rate(point, column, t0, path.states[i - 1], dt), g1 = slope(t1);
  double t = path.times[i];
  if (g0 * g1 < 0) t = root(t0, t1, g0, g1, slope);
  const auto y = state_at(t);
  point.observe(t, y.data(), e.row.data());
  e.value = e.row[column];
  return e;
}

std::vector<Extremum> located(const ElementTest& test, const AnyPoint& point, const Path& path, std::size_t column,
                              const std::vector<double>& v) {
  std::vector<Extremum> list;
  for (std::size_t i = 1; i + 1 < v.size(); ++i) {
    const bool top = v[i] > v[i - 1] && v[i] >= v[i + 1], bottom = v[i] < v[i - 1] && v[i] <= v[i + 1];
    if (top || bottom) list.push_back(locate(test, point, path, column, i, top));
  }
  return list;
}

std::string state_in_words(const RunRecord& record) {
  if (record.rows() == 0) return "no row was reached";
  std::string text;
  const std::size_t last = record.rows() - 1;
  for (const char* name :
       {"time", "shear_strain", "axial_strain", "pressure", "q", "shear_stress", "void_ratio", "ln_trace"}) {
    const int c = record.column(name);
    if (c < 0) continue;
    text += fmt::format("{}{} = {:.6g}{}{}", text.empty() ? "" : ", ", name, record.at(last, std::size_t(c)),
                        record.columns[std::size_t(c)].unit == "-" ? "" : " ",
                        record.columns[std::size_t(c)].unit == "-" ? "" : record.columns[std::size_t(c)].unit);
  }
  return text;
}

std::string cause_in_words(const ElementTest& test, const Integrator& integrator) {
  const bool refused = integrator.failure().find("stability") != std::string::npos || integrator.failure().empty();
  if (info(test.integration.method).fixed_step && refused) {
    return fmt::format(
        "the fixed step of {:.3g} s is beyond the stability limit of this law: make it smaller or use an "
        "error-controlled method",
        test.integration.fixed_step);
  }
  if (!test.control.held.empty()) {
    if (norm(test.initial_stress) == 0) return "no velocity gradient gives the prescribed stress";
    return "the prescribed stress cannot be held any more (loss of controllability): the skeleton has softened or lost "
           "its contacts; control the strain instead";
  }
  return integrator.failure();
}

/// Rows at which the companion run is compared: all of a short run, the first few and about a hundred of a long one.
bool compared(std::size_t row, std::size_t rows) { return row < 20 || row + 1 == rows || row % (rows / 100 + 1) == 0; }

/// Stress at some rows for another accuracy: ten times the tolerance, or half the fixed step.
std::vector<SymTensor<double>> companion(ElementTest test, const std::vector<double>& times,
                                         const std::function<bool(double, double)>& heartbeat) {
  test.integration.rtol *= 10;
  test.integration.atol *= 10;
  test.integration.fixed_step /= 2;
  const AnyPoint point = make_point(test);
  Walk walk(test, point, heartbeat);
  std::vector<SymTensor<double>> list;
  for (const double t : times) {
    if (!walk.to(t)) break;
    list.push_back(point.stress(t, walk.y.data()));
  }
  return list;
}

}  // namespace

namespace {

RunRecord run_point(const ElementTest& test, const Hooks& hooks) {
  RunRecord record;
  record.name = test.run;
  evaluate_point(test, record.columns, record.values);
  record.method = "none";
  record.state_form = "stress";
  if (hooks.row) hooks.row(record, record.values.data());
  if (std::any_of(record.values.begin(), record.values.end(), [](double v) { return !std::isfinite(v); })) {
    record.status = Status::failed;
    record.failure = "the law gives no finite value at this point";
  }
  return record;
}

/// One run in progress: the record, and what is needed to look back at the path.
class Progressing {
 public:
  Progressing(const ElementTest& t, const Hooks& h)
      : test(t),
        hooks(h),
        point(make_point(t)),
        walk(test, point, [this](double at, double step) { return beat(at, step); }) {
    record.name = test.run;
    record.columns = point.columns;
    record.method = info(test.integration.method).name;
    record.state_form = point.state_form;
    record.values.reserve(test.row_times.size() * point.columns.size());
    p0 = pressure_at(0, walk.y);
  }

  RunRecord finish() {
    for (std::size_t r = 0; r < test.row_times.size() && record.status == Status::done && !condition_met; ++r) row(r);
    record.solver_ms = 1e3 * solving;
    record.counters = walk.integrator.counters();
    if (test.integration.error_estimate && record.status == Status::done) estimate_error();
    find_peaks();
    return std::move(record);
  }

 private:
  bool beat(double t, double step) {
    if (hooks.progress) hooks.progress(test.until.time > 0 ? t / test.until.time : 1, step);
    return !(hooks.interrupted && hooks.interrupted());
  }
  double pressure_at(double t, const std::vector<double>& y) { return pressure(point.stress(t, y.data())); }

  void row(std::size_t r) {
    double t = test.row_times[r];
    const double from = seconds();
    const bool reached = walk.to(t);
    solving += seconds() - from;
    if (!reached) return end(walk.integrator.t_reached());
    if (test.until.pressure_ratio && r > 0) t = stop_at_pressure(t);
    if (!write(t, r) || !beat(t, walk.integrator.last_step())) end(t);
  }

  /// Appends a row; false when its values are not to be believed.
  bool write(double t, std::size_t r) {
    const std::size_t width = point.columns.size();
    record.values.resize(record.values.size() + width);
    double* values = record.values.data() + record.values.size() - width;
    const auto [sigma, why] = point.observe(t, walk.y.data(), values);
    for (std::size_t bit = 0; bit < record.admit.size(); ++bit) record.admit[bit] += (why >> bit) & 1;
    if (std::any_of(values, values + width, [](double v) { return std::isnan(v); })) {
      record.values.resize(record.values.size() - width);
      broken = true;
      return false;
    }
    path.times.push_back(t);
    path.states.push_back(walk.y);
    if (test.integration.error_estimate && compared(r, test.row_times.size())) {
      stresses.push_back(sigma);
      compared_times.push_back(t);
    }
    largest_stress = std::max(largest_stress, norm(sigma));
    if (hooks.row) hooks.row(record, values);
    broken = (why & not_finite) != 0;
    return !broken;
  }

  void end(double t) {
    if (!broken && hooks.interrupted && hooks.interrupted()) {
      record.status = Status::interrupted;
      record.failure = fmt::format("run '{}' was interrupted at t = {:.6g} s", record.name, t);
      return;
    }
    if (!broken && walk.integrator.failure().empty()) return;  // the heartbeat only asked
    record.status = Status::failed;
    record.failure = fmt::format("run '{}' stopped at t = {:.6g} s; last good state: {}; likely cause: {}", record.name,
                                 t, state_in_words(record), cause_in_words(test, walk.integrator));
  }

  /// The instant before t at which the pressure falls to the share asked for, or t.
  double stop_at_pressure(double t) {
    const auto excess = [&](double at) { return pressure_at(at, walk.y) - *test.until.pressure_ratio * p0; };
    const double after = excess(t), t0 = path.times.back();
    const auto start = path.states.back();
    const double before = pressure_at(t0, start) - *test.until.pressure_ratio * p0;
    if (!(before > 0 && after <= 0)) return t;
    const auto go = [&](double at) {
      walk.restart_from(t0, start);
      walk.to(at);
    };
    t = root(t0, t, before, after, [&](double at) {
      go(at);
      return excess(at);
    });
    go(t);
    condition_met = true;
    return t;
  }

  void estimate_error() {
    const auto other =
        companion(test, compared_times, [this](double, double) { return !(hooks.interrupted && hooks.interrupted()); });
    double worst = other.size() < stresses.size() ? largest_stress : 0;
    for (std::size_t i = 0; i < other.size(); ++i) worst = std::max(worst, norm(stresses[i] - other[i]));
    const auto& method = info(test.integration.method);
    if (method.fixed_step) {  // Richardson: the difference from half the step is a part of the error
      const double gain = std::pow(2.0, method.order);
      worst *= gain / (gain - 1);
    }
    record.global_error_estimate = largest_stress > 0 ? worst / largest_stress : 0;
    if (method.fixed_step && !(record.global_error_estimate < 0.5)) {
      record.status = Status::failed;
      record.failure = fmt::format(
          "run '{}' cannot be believed: half the step changes the stress by {:.3g} of its largest value; last state: "
          "{}; "
          "likely cause: {}",
          record.name, record.global_error_estimate, state_in_words(record), cause_in_words(test, walk.integrator));
    }
  }

  /// The largest size of a column, or the first peak of the main quantity of an undrained test.
  Extremum peak_of(const std::string& name) {
    const auto c = std::size_t(record.column(name));
    auto sizes = record.series(name);
    for (auto& x : sizes) x = std::abs(x);
    const bool first = name == test.main_quantity && test.has_response_class();
    const std::size_t top = first ? peak_index(sizes) : largest_index(sizes);
    if (name == test.main_quantity && first) record.response = classify(sizes);
    if (top > 0 && top + 1 < sizes.size()) return locate(test, point, path, c, top, record.at(top, c) > 0);
    const auto begin = record.values.begin() + std::ptrdiff_t(top * record.columns.size());
    return {record.columns[c].name, record.columns[c].unit, true, record.at(top, c),
            std::vector<double>(begin, begin + std::ptrdiff_t(record.columns.size()))};
  }

  void find_peaks() {
    if (record.rows() == 0) return;
    if (record.column(test.main_quantity) >= 0) record.peak = peak_of(test.main_quantity);
    for (const auto& name : test.peaks_wanted) record.peaks.push_back(peak_of(name));
  }

  const ElementTest& test;
  const Hooks& hooks;
  AnyPoint point;
  Walk walk;
  RunRecord record;
  Path path;
  std::vector<SymTensor<double>> stresses;
  std::vector<double> compared_times;
  double p0 = 0, largest_stress = 0, solving = 0;
  bool condition_met = false, broken = false;
};

}  // namespace

RunRecord run(const ElementTest& test, const Hooks& hooks) {
  if (test.kind == Kind::point) return run_point(test, hooks);
  return Progressing(test, hooks).finish();
}

std::vector<Extremum> extrema(const ElementTest& test, const std::string& column) {
  const AnyPoint point = make_point(test);
  Walk walk(test, point);
  Path path;
  std::vector<double> v, row(point.columns.size());
  std::size_t index = 0;
  while (index < point.columns.size() && point.columns[index].name != column) ++index;
  if (index == point.columns.size()) return {};
  for (const double t : test.row_times) {
    if (!walk.to(t)) break;
    point.observe(t, walk.y.data(), row.data());
    path.times.push_back(t);
    path.states.push_back(walk.y);
    v.push_back(row[index]);
  }
  return located(test, point, path, index, v);
}

}  // namespace grainlaw::element
