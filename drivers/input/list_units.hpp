#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "source.hpp"

namespace grainlaw::input {

/// A unit typed behind a list, `[50, 100] kPa`.
struct ListUnit {
  std::string text;
  Mark mark;
};

/// The units behind lists, by line and column of the list's '['.
using ListUnits = std::map<std::pair<int, int>, ListUnit>;

/// Blanks every unit behind a list, which YAML itself forbids, and returns them; no column moves.
///
/// Brackets, quotes and tabs that YAML would stumble over are errors here, at the place of their cause.
ListUnits take_list_units(std::vector<std::string>& lines, const std::shared_ptr<const Source>& source);

}  // namespace grainlaw::input
