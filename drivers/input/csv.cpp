// SPDX-License-Identifier: BSD-3-Clause
#include "csv.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <memory>
#include <string_view>

namespace grainlaw::input {

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
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t')) cell.remove_suffix(1);
    cells.push_back(cell);
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

Csv read_csv(const std::filesystem::path& file) {
  auto text = std::make_shared<Source>(Source{file.string(), {}});
  std::ifstream in(file);
  const auto whole = [&] { return Mark{text, -1, -1}; };
  if (!in) fail(whole(), "the file cannot be read", "check its permissions");
  for (std::string line; std::getline(in, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (text->lines.empty() && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    text->lines.push_back(std::move(line));
  }
  Csv csv;
  for (std::size_t number = 0; number < text->lines.size(); ++number) {
    const std::string& line = text->lines[number];
    const auto place = [&](std::string_view cell) { return Mark{text, int(number), int(cell.data() - line.data())}; };
    if (line.empty() || line[0] == '#') continue;
    const auto cells = split(line);
    if (csv.names.empty()) {
      for (const auto cell : cells) csv.names.emplace_back(cell);
      csv.columns.resize(cells.size());
      csv.no_number.resize(cells.size());
      continue;
    }
    if (cells.size() != csv.names.size()) {
      fail(place(line), fmt::format("{} values under {} column names", cells.size(), csv.names.size()),
           "every row needs one value per column, separated by commas");
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      double value = 0;
      const char* end = cells[i].data() + cells[i].size();
      const auto [at, error] = std::from_chars(cells[i].data(), end, value);
      const bool number_typed = error == std::errc{} && at == end && std::isfinite(value);
      if (!number_typed && !csv.no_number[i]) csv.no_number[i] = place(cells[i]);
      csv.columns[i].push_back(number_typed ? value : std::nan(""));
    }
  }
  if (csv.names.empty()) fail(whole(), "there is no header line", "name the columns in the first line");
  if (csv.columns[0].empty()) fail(whole(), "there is no row of numbers", "the header line stands alone");
  return csv;
}

int Csv::numbers(const std::string& name, const Mark& asked_at) const {
  const int found = find(name);
  if (found < 0) {
    fail(asked_at, fmt::format("the data file has no column '{}'", name), did_you_mean(name, names));
  }
  if (const auto& wrong = no_number[std::size_t(found)]) {
    fail(*wrong, fmt::format("this is not a number, but column '{}' is compared", name),
         "leave rows without a value out of the file");
  }
  return found;
}

}  // namespace grainlaw::input
