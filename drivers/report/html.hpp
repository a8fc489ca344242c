#pragma once

#include <string>
#include <vector>

#include "fields.hpp"

namespace grainlaw::report {

/// Text made harmless inside HTML, in content and in quoted attributes.
std::string escape(const std::string& text);

/// A number in HTML to the given significant digits, powers of ten raised.
std::string show(double value, int digits = 5);

/// A number with its unit; "" when the number is missing.
std::string show(double value, const std::string& unit, int digits = 5);

/// One table cell: HTML, whether it reads as a number, and an optional CSS class.
struct Cell {
  std::string html;
  bool numeric = false;
  std::string style = {};
};

/// The cell for any JSON value: numbers shortened, text escaped.
Cell cell(const Json& value, int digits = 5);

/// The cell for a member of an object, empty when it is missing.
Cell cell(const Json& object, const std::string& key, int digits = 5);

/// A table that leaves out its empty columns, and itself when nothing but its first column is left.
class Table {
 public:
  explicit Table(std::vector<std::string> header) : header_(std::move(header)) {}

  void add(std::vector<Cell> row);
  std::string html() const;

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<Cell>> rows_;
};

/// A complete page with the report's style sheet.
std::string document(const std::string& title, const std::string& body);

}  // namespace grainlaw::report
