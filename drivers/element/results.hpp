// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <vector>

#include "element_test.hpp"
#include "run.hpp"

namespace grainlaw::element {

struct ExpectationResult {
  Expectation expectation;
  double got = 0;
  double difference = 0;  ///< relative or absolute, as `within` is
  bool met = false;
};

struct ComparisonResult {
  Comparison comparison;
  std::vector<double> x, y;  ///< the data in SI, in the signs of the run
  std::string y_unit;
  std::size_t used = 0;  ///< points inside the range of the run
  double rms = 0;        ///< of run - data over those points
  double largest = 0;    ///< largest |data|
  double peak = 0, residual = 0;
  std::string response;  ///< class of the data by the rule that the run goes through
};

ExpectationResult evaluate(const Expectation& expectation, const RunRecord& record);
ComparisonResult evaluate(const Comparison& comparison, const RunRecord& record);

/// One line of the table on the terminal and on top of the report.
struct ResultRow {
  std::string run, peak, residual, response, reference, difference;
};
ResultRow summarise(const ElementTest& test, const RunRecord& record,
                    const std::vector<ExpectationResult>& expectations,
                    const std::vector<ComparisonResult>& comparisons);

/// "14.97 kPa": a quantity in the unit that reads best.
std::string readable(double value, const std::string& unit);

}  // namespace grainlaw::element
