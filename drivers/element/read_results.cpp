// SPDX-License-Identifier: BSD-3-Clause
#include "read_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../input/csv.hpp"
#include "../input/reader.hpp"
#include "run.hpp"

namespace grainlaw::element {

using input::Node;
using input::Reader;

namespace {

/// The columns a run will have, and the unit of each.
std::vector<Column> columns_of(const ElementTest& test) {
  if (test.kind != Kind::point) return make_point(test).columns;
  std::vector<Column> columns;
  std::vector<double> values;
  evaluate_point(test, columns, values);
  return columns;
}

const Column& find_column(const std::vector<Column>& columns, const std::string& name, const input::Mark& mark) {
  std::vector<std::string> names;
  for (const auto& c : columns) {
    if (c.name == name) return c;
    names.push_back(c.name);
  }
  input::fail(mark, fmt::format("this run has no column '{}'", name), input::did_you_mean(name, names));
}

bool applies(Reader& entry, const SingleRun& single, const std::vector<SingleRun>& runs) {
  const Node* run = entry.find("run");
  if (!run) return true;
  std::vector<std::string> names;
  for (const auto& r : runs) names.push_back(r.name);
  if (!run->is_scalar() || std::find(names.begin(), names.end(), run->text) == names.end()) {
    input::fail(run->mark, fmt::format("no run is called {}", input::describe(*run)),
                input::did_you_mean(run->text, names));
  }
  return run->text == single.name;
}

Axis read_axis(Reader axis, const std::vector<Column>& columns, const input::Csv* csv) {
  Axis a;
  a.data = axis.text("data", "the name of a column of the data file");
  a.run = axis.text("run", "the name of a column of the run, without its unit");
  const Column& column = find_column(columns, a.run, axis.mark("run"));
  const std::string unit = axis.text_or("unit", "-");
  const auto factor = input::to_si(1, unit, column.unit);
  if (!factor) {
    const std::string what =
        axis.has("unit")
            ? fmt::format("{} = '{}' does not fit column '{}' [{}]", axis.path("unit"), unit, a.run, column.unit)
            : fmt::format("'{}' is missing: column '{}' is in {}", axis.path("unit"), a.run, column.unit);
    input::fail(axis.mark("unit"), what, "expected one of: " + input::accepted_units(column.unit));
  }
  a.factor = *factor;
  if (const Node* sign = axis.find("sign")) {
    if (!sign->is_scalar() || (sign->text != "-1" && sign->text != "1" && sign->text != "+1"))
      input::fail(sign->mark, "sign must be 1 or -1", "-1 turns compression-positive data into our convention");
    if (sign->text == "-1") a.factor = -a.factor;
  }
  a.offset = axis.number_or("offset", column.unit, 0);
  a.engineering = axis.word_or("strain", {"engineering", "logarithmic"}, "logarithmic") == "engineering";
  if (axis.has("strain") && column.name.find("_strain") == std::string::npos) {
    axis.inert("strain", fmt::format("column '{}' is no strain", a.run));
  }
  a.relative_to_first = axis.flag_or("relative_to_first", false);
  if (csv) csv->numbers(a.data, axis.mark("data"));
  axis.finish();
  return a;
}

void read_compare(Reader entry, const SingleRun& single, const std::vector<Column>& columns,
                  const std::filesystem::path& beside, const std::vector<SingleRun>& runs, ElementFile& file) {
  Comparison c;
  c.run = single.name;
  const bool mine = applies(entry, single, runs);
  const std::string data = entry.text("data", "a CSV file, relative to this file");
  const bool optional = entry.flag_or("optional", false);
  c.label = entry.text_or("label", "measured");
  c.role = entry.word_or("role", {"validation", "calibration", "fitted", "model"}, "validation");
  c.note = entry.text_or("note", "");
  c.file = beside / data;
  std::error_code none;
  std::optional<input::Csv> csv;
  if (std::filesystem::is_regular_file(c.file, none)) {
    csv = input::read_csv(c.file);
  } else if (!optional) {
    input::fail(entry.mark("data"), fmt::format("there is no file '{}'", data),
                "paths are relative to the YAML; `optional: true` makes it a note instead");
  }
  if (const Node* where = entry.find("where")) {  // rows of the data that belong to this run
    Reader rows(*where, entry.path("where"));
    c.where_column = rows.text("column", "the name of a column of the data file");
    c.where_value = rows.number("equals", "-");
    if (csv) {
      const auto& values = csv->columns[std::size_t(csv->numbers(c.where_column, rows.mark("column")))];
      const auto selected = [&](double v) { return std::abs(v - c.where_value) <= 1e-9 * std::abs(c.where_value); };
      if (std::none_of(values.begin(), values.end(), selected))
        input::fail(rows.mark("equals"), fmt::format("no row has {} = {}", c.where_column, c.where_value),
                    "the comparison would be empty");
    }
    rows.finish();
  }
  c.x = read_axis(entry.map("x"), columns, csv ? &*csv : nullptr);
  c.y = read_axis(entry.map("y"), columns, csv ? &*csv : nullptr);
  entry.finish();
  if (!csv) {
    const std::string note = fmt::format("'{}' ({}) is not there{}{}", data, c.label,
                                         c.note.empty() ? ": no comparison with it" : ": ", c.note);
    if (std::find(file.notes.begin(), file.notes.end(), note) == file.notes.end()) file.notes.push_back(note);
    return;
  }
  if (mine) file.comparisons.push_back(std::move(c));
}

void read_expect(Reader entry, const SingleRun& single, ElementTest& test, const std::vector<Column>& columns,
                 const std::vector<SingleRun>& runs, ElementFile& file) {
  Expectation e;
  e.run = single.name;
  const bool mine = applies(entry, single, runs);
  e.column = entry.text("column", "the name of a column, without its unit");
  if (mine) e.unit = find_column(columns, e.column, entry.mark("column")).unit;
  const Node* at = entry.find("at");
  if (at && at->is_map()) {
    if (at->entries.size() != 1)
      input::fail(at->mark, "`at` needs exactly one column and its value", "for example 'at: {shear_strain: 0.1}'");
    e.at = Expectation::At::value;
    e.at_column = at->entries[0].key;
    const Column& column = find_column(columns, e.at_column, at->entries[0].key_mark);
    e.at_unit = column.unit;
    e.at_value = input::quantity(at->entries[0].value, entry.path("at") + "." + e.at_column, column.unit);
  } else {
    e.at = entry.word_or("at", {"end", "peak"}, "end") == "end" ? Expectation::At::end : Expectation::At::peak;
    if (e.at == Expectation::At::peak && test.kind == Kind::point) {
      input::fail(entry.mark("at"), "a point test has no path and no peak", "expected 'at: end'");
    }
  }
  const Node& value = entry.need("value", "the expected value with its unit");
  const Node& within =
      entry.need("within", "how far off it may be: a bare number is relative (0.01 for 1 %), one with a unit absolute");
  e.because = entry.text_or("because", "");
  entry.finish();
  if (!mine) return;
  e.value = input::quantity(value, entry.path("value"), e.unit);
  const std::string within_unit = input::unit_typed(within);
  e.relative = within_unit.empty() || within_unit == "%";
  e.within = input::quantity(within, entry.path("within"), e.relative ? "-" : e.unit, input::not_negative);
  if (e.at == Expectation::At::peak && e.column != test.main_quantity) test.peaks_wanted.push_back(e.column);
  file.expectations.push_back(std::move(e));
}

}  // namespace

void read_results(const SingleRun& single, ElementTest& test, const std::filesystem::path& beside,
                  const std::vector<SingleRun>& runs, ElementFile& file) {
  Reader root(single.tree, "");
  auto compares = root.maps("compare");
  auto expects = root.maps("expect");
  if (compares.empty() && expects.empty()) return;
  const auto columns = columns_of(test);
  for (auto& entry : compares) read_compare(entry, single, columns, beside, runs, file);
  for (auto& entry : expects) read_expect(entry, single, test, columns, runs, file);
}

}  // namespace grainlaw::element
