// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "element_test.hpp"
#include "results.hpp"
#include "run.hpp"

namespace grainlaw::element {

/// The figures of a kind of test, in the form that the report draws: which columns, units, and the data beside them.
nlohmann::ordered_json figures(const ElementFile& file, const std::vector<RunRecord>& records,
                               const std::vector<ComparisonResult>& comparisons,
                               const std::vector<std::string>& comparison_files);

}  // namespace grainlaw::element
