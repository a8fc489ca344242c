#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "node.hpp"

namespace grainlaw::input {

/// A number with its unit as typed, in SI; `what` names it in messages, `unit` is the SI unit ("Pa", "1/s", "-" ...).
double quantity(const Node& node, std::string_view what, std::string_view unit);

/// A decimal number at the head of a text and what follows it, without blanks; the number is empty when there is none.
std::pair<std::string, std::string> split_number(std::string_view text);

/// The unit as typed behind the number, empty for a bare number or for anything that is not a number.
std::string unit_typed(const Node& node);

/// A number that came with a separate unit (a CSV column, say) in SI; nothing when the unit does not fit.
std::optional<double> to_si(double value, std::string_view typed_unit, std::string_view unit);

/// "Pa, kPa, MPa, ...": everything that may be typed for an SI unit.
std::string accepted_units(std::string_view unit);

/// "a pressure [Pa]", "a plain number": the quantity behind an SI unit, in words.
std::string expected_quantity(std::string_view unit);

/// "100 kPa": a value that would be accepted for an SI unit.
std::string example_of(std::string_view unit);

}  // namespace grainlaw::input
