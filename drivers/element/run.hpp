// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "element_test.hpp"
#include "point.hpp"

namespace grainlaw::element {

enum class Status { done, failed, interrupted };

/// A local maximum or minimum of a column, located by a root of its time derivative.
struct Extremum {
  std::string column, unit;
  bool maximum = true;
  double value = 0;
  std::vector<double> row;  ///< every column at that instant
};

/// What one run produced.
struct RunRecord {
  std::string name;
  Status status = Status::done;
  std::string failure;
  std::vector<Column> columns;
  std::vector<double> values;  ///< rows x columns
  std::string method, state_form;
  Counters counters;
  double solver_ms = 0;               ///< wall time of the integration alone, without output
  double global_error_estimate = -1;  ///< of the stress, relative to its largest size on the path; -1: not asked for
  std::array<std::size_t, reason_names.size()> admit{};  ///< how often admit would have fired, over the rows
  Extremum peak;                                         ///< of the main quantity
  std::vector<Extremum> peaks;                           ///< of the columns that the test asked for
  std::string response;                                  ///< liquefaction, softening, limited liquefaction, dilative

  std::size_t rows() const { return columns.empty() ? 0 : values.size() / columns.size(); }
  double at(std::size_t row, std::size_t column) const { return values[row * columns.size() + column]; }
  /// Index of a column by its name without unit, or -1.
  int column(std::string_view name) const;
  std::vector<double> series(std::string_view name) const;
};

struct Hooks {
  /// Called with every row as soon as it exists; writing them is the caller's business.
  std::function<void(const RunRecord&, const double* row)> row;
  /// Called now and then with the share of the run that is done and the present step [s].
  std::function<void(double share, double step)> progress;
  /// True asks for an orderly end.
  std::function<bool()> interrupted;
};

RunRecord run(const ElementTest& test, const Hooks& hooks = {});

/// Every extremum of a column along the path, each located by a root of its derivative.
std::vector<Extremum> extrema(const ElementTest& test, const std::string& column);

/// The law behind a test, its type erased.
AnyPoint make_point(const ElementTest& test);

/// What the law says at one point: columns and values of a `point` test.
void evaluate_point(const ElementTest& test, std::vector<Column>& columns, std::vector<double>& values);

}  // namespace grainlaw::element
