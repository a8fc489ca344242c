// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <vector>

#include "element_test.hpp"
#include "sweep.hpp"

namespace grainlaw::element {

/// Reads `compare` and `expect` of one run into the file: data files are opened, columns and units are checked.
void read_results(const SingleRun& single, ElementTest& test, const std::filesystem::path& beside,
                  const std::vector<SingleRun>& runs, ElementFile& file);

}  // namespace grainlaw::element
