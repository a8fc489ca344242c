// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace grainlaw::element {

/// A table of numbers with one header line; lines that begin with # are comments.
struct Csv {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  int find(const std::string& name) const;
};

/// Reads a table; an unreadable file or a ragged or non-numeric row is an input::InputError that names the line.
Csv read_csv(const std::filesystem::path& file);

}  // namespace grainlaw::element
