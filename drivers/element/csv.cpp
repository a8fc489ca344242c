// SPDX-License-Identifier: BSD-3-Clause
#include "csv.hpp"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <string_view>

#include "../input/source.hpp"

namespace grainlaw::element {

int Csv::find(const std::string& name) const {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return int(i);
  }
  return -1;
}

namespace {

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto comma = line.find(',');
    std::string_view cell = line.substr(0, comma);
    while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t' || cell.back() == '\r')) cell.remove_suffix(1);
    cells.push_back(cell);
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

Csv read_csv(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw input::InputError(fmt::format("{}: error: cannot be read\n", file.string()));
  Csv csv;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.empty() || line[0] == '#' || line == "\r") continue;
    const auto cells = split(line);
    if (csv.names.empty()) {
      for (const auto cell : cells) csv.names.emplace_back(cell);
      csv.columns.resize(cells.size());
      continue;
    }
    if (cells.size() != csv.names.size()) {
      throw input::InputError(fmt::format("{}:{}:1: error: {} values under {} column names\n", file.string(), number,
                                          cells.size(), csv.names.size()));
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      double value = 0;
      const char* end = cells[i].data() + cells[i].size();
      const auto [at, error] = std::from_chars(cells[i].data(), end, value);
      if (error != std::errc{} || at != end) {
        throw input::InputError(fmt::format("{}:{}:1: error: '{}' in column '{}' is not a number\n", file.string(),
                                            number, cells[i], csv.names[i]));
      }
      csv.columns[i].push_back(value);
    }
  }
  if (csv.names.empty()) throw input::InputError(fmt::format("{}: error: has no header line\n", file.string()));
  return csv;
}

}  // namespace grainlaw::element
