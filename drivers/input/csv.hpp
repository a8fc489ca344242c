// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "source.hpp"

namespace grainlaw::input {

/// A table with one header line; lines that begin with # are comments. Cells that are no number become NaN, so that a
/// column of labels may stand beside the numbers.
struct Csv {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  std::vector<std::optional<Mark>> no_number;  ///< of each column, where the first such cell stands

  /// Index of a column, or -1.
  int find(const std::string& name) const;
  /// Index of a column that has a number in every row; an InputError otherwise.
  int numbers(const std::string& name, const Mark& asked_at) const;
};

/// Reads a table; an unreadable, empty or ragged one is an InputError that names the line.
Csv read_csv(const std::filesystem::path& file);

}  // namespace grainlaw::input
