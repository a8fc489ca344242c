// SPDX-License-Identifier: BSD-3-Clause
#include "results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../input/csv.hpp"
#include "classify.hpp"

namespace grainlaw::element {

namespace {

/// y at x by linear interpolation along the path, at the first crossing; NaN outside.
double interpolate(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  for (std::size_t i = 0; i < xs.size(); ++i) {
    if (xs[i] == x) return ys[i];
    if (i > 0 && (xs[i - 1] - x) * (xs[i] - x) < 0)
      return ys[i - 1] + (ys[i] - ys[i - 1]) * (x - xs[i - 1]) / (xs[i] - xs[i - 1]);
  }
  // the last bit of a sum of steps must not hide the end of the path
  const double slack = 1e-12 * std::max(std::abs(x), 1e-300);
  if (!xs.empty() && std::abs(xs.back() - x) <= slack) return ys.back();
  if (!xs.empty() && std::abs(xs.front() - x) <= slack) return ys.front();
  return std::nan("");
}

/// The same at the last crossing: where a run waits at one x, its settled value is the one to compare.
double interpolate_last(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  for (std::size_t i = xs.size(); i-- > 0;) {
    if (xs[i] == x) return ys[i];
    if (i > 0 && (xs[i - 1] - x) * (xs[i] - x) < 0) return interpolate({xs[i - 1], xs[i]}, {ys[i - 1], ys[i]}, x);
  }
  return interpolate(xs, ys, x);
}

/// A value of the data in the unit, sign and measure of the run.
double in_si(const Axis& axis, const std::vector<double>& column, std::size_t i) {
  const double raw = column[i] - (axis.relative_to_first ? column.front() : 0);
  const double value = raw * axis.factor + axis.offset;
  return axis.engineering ? std::log1p(value) : value;
}

}  // namespace

ExpectationResult evaluate(const Expectation& e, const RunRecord& record) {
  ExpectationResult result{e, std::nan(""), std::nan(""), false};
  const int c = record.column(e.column);
  if (c < 0 || record.rows() == 0) return result;
  switch (e.at) {
    case Expectation::At::end:
      result.got = record.at(record.rows() - 1, std::size_t(c));
      break;
    case Expectation::At::peak: {
      const auto named = std::find_if(record.peaks.begin(), record.peaks.end(),
                                      [&](const Extremum& p) { return p.column == e.column; });
      if (record.peak.column == e.column) {
        result.got = record.peak.value;
      } else if (named != record.peaks.end()) {
        result.got = named->value;
      }
      break;
    }
    case Expectation::At::value:
      result.got = interpolate(record.series(e.at_column), record.series(e.column), e.at_value);
      break;
  }
  const double off = result.got - e.value;
  result.difference = e.relative ? off / std::abs(e.value) : off;
  if (e.relative && e.value == 0) result.difference = off == 0 ? 0 : std::copysign(unbounded, off);
  result.met = std::abs(result.difference) <= e.within;
  return result;
}

ComparisonResult evaluate(const Comparison& c, const RunRecord& record) {
  ComparisonResult result;
  result.comparison = c;
  const input::Csv csv = input::read_csv(c.file);
  const auto& xs = csv.columns[std::size_t(csv.find(c.x.data))];
  const auto& ys = csv.columns[std::size_t(csv.find(c.y.data))];
  const int where = c.where_column.empty() ? -1 : csv.find(c.where_column);
  const auto run_x = record.series(c.x.run), run_y = record.series(c.y.run);
  if (const int column = record.column(c.y.run); column >= 0) result.y_unit = record.columns[std::size_t(column)].unit;
  double squares = 0;
  std::vector<double> sizes;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    // written decimals of a key column: equal to round-off of a decimal
    if (where >= 0 && std::abs(csv.columns[std::size_t(where)][i] - c.where_value) > 1e-9 * std::abs(c.where_value))
      continue;
    const double x = in_si(c.x, xs, i), y = in_si(c.y, ys, i);
    result.x.push_back(x);
    result.y.push_back(y);
    result.largest = std::max(result.largest, std::abs(y));
    sizes.push_back(std::abs(y));
    const double model = interpolate_last(run_x, run_y, x);
    if (std::isnan(model)) continue;
    ++result.used;
    squares += (model - y) * (model - y);
  }
  result.rms = result.used > 0 ? std::sqrt(squares / double(result.used)) : std::nan("");
  if (sizes.size() > 2) {
    // a class belongs to the main quantity along the strain path
    const bool classified =
        !record.response.empty() && c.y.run == record.peak.column && c.x.run.find("strain") != std::string::npos;
    if (classified) result.response = classify(sizes);
    result.peak = sizes[classified ? peak_index(sizes) : largest_index(sizes)];
    result.residual = sizes.back();
  }
  return result;
}

std::string readable(double value, const std::string& unit) {
  if (unit == "Pa" && std::abs(value) >= 1e3) return fmt::format("{:.4g} kPa", value / 1e3);
  if (unit == "-" || unit.empty()) return fmt::format("{:.4g}", value);
  return fmt::format("{:.4g} {}", value, unit);
}

ResultRow summarise(const ElementTest& test, const RunRecord& record,
                    const std::vector<ExpectationResult>& expectations,
                    const std::vector<ComparisonResult>& comparisons) {
  ResultRow row;
  row.run = record.name;
  const int c = record.column(test.main_quantity);
  if (record.status != Status::done) {
    row.response = record.status == Status::failed ? "FAILED" : "interrupted";
  }
  if (c < 0 || record.rows() == 0) {
    row.reference = "-";
    return row;
  }
  const std::string unit = record.columns[std::size_t(c)].unit;
  const double residual = record.at(record.rows() - 1, std::size_t(c));
  row.peak = readable(record.peak.value, unit);
  row.residual = readable(residual, unit);
  if (row.response.empty()) row.response = record.response.empty() ? "-" : record.response;
  for (const auto& m : comparisons) {
    if (m.comparison.run != record.name || m.comparison.y.run != test.main_quantity || m.used == 0) continue;
    if (test.has_response_class() && m.response.empty()) continue;
    if (m.comparison.role == "model") continue;
    row.reference = fmt::format("{}: peak {}, end {}{}{}", m.comparison.label, readable(m.peak, unit),
                                readable(m.residual, unit), m.response.empty() ? "" : ", ", m.response);
    row.difference =
        fmt::format("rms {:.0f} %{}{}", 100 * m.rms / m.largest, m.response == record.response ? "" : ", class differs",
                    m.comparison.role == "fitted"        ? ", e0 fitted"
                    : m.comparison.role == "calibration" ? ", calibration"
                                                         : "");
    return row;
  }
  for (const auto& e : expectations) {
    const auto& x = e.expectation;
    if (x.run != record.name || x.column != test.main_quantity || std::isnan(e.got)) continue;
    const std::string value = readable(x.value, unit);
    switch (x.at) {
      case Expectation::At::end:
        row.reference = "residual " + value;
        break;
      case Expectation::At::peak:
        row.reference = "peak " + value;
        break;
      case Expectation::At::value:
        row.reference = fmt::format("{} at {} = {}", value, x.at_column, readable(x.at_value, x.at_unit));
        break;
    }
    if (!x.relative) {
      row.difference = readable(e.difference, unit);
    } else if (std::abs(e.difference) < 5e-5) {  // a percentage would show nothing
      row.difference = std::abs(e.difference) < 1e-14 ? "0" : fmt::format("{:+.1e}", e.difference);
    } else {
      row.difference = fmt::format("{:+.2f} %", 100 * e.difference);
    }
    return row;
  }
  row.reference = "-";
  return row;
}

}  // namespace grainlaw::element
