#include "units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <numbers>
#include <system_error>
#include <vector>

namespace grainlaw::input {
namespace {

/// SI value = number * 10^exponent * factor / divisor, where at most one of the last three is not trivial.
struct Unit {
  std::string_view name;
  int exponent = 0;
  double factor = 1.0;
  double divisor = 1.0;
};

struct Dimension {
  std::string_view si;
  std::string_view words;
  std::string_view example;
  std::vector<Unit> units;    // named in messages
  std::vector<Unit> aliases;  // understood as well
};

constexpr double psi = 6894.757293168361;
constexpr double degree = std::numbers::pi / 180.0;
constexpr double per_minute = std::numbers::pi / 30.0;

const std::vector<Dimension>& dimensions() {
  static const std::vector<Dimension> table{
      {"-", "a plain number", "0.5", {{"%", -2}}, {{"percent", -2}}},
      {"Pa",
       "a pressure",
       "100 kPa",
       {{"Pa"}, {"hPa", 2}, {"kPa", 3}, {"MPa", 6}, {"GPa", 9}, {"mbar", 2}, {"bar", 5}, {"N/m^2"}, {"psi", 0, psi}},
       {{"kN/m^2", 3}, {"MN/m^2", 6}, {"N/mm^2", 6}}},
      {"1/Pa", "an inverse pressure", "1e-3 1/kPa", {{"1/Pa"}, {"1/kPa", -3}, {"1/MPa", -6}}, {{"1/GPa", -9}}},
      {"s", "a time", "10 s", {{"s"}, {"ms", -3}, {"us", -6}, {"min", 0, 60}, {"h", 0, 3600}}, {{"d", 0, 86400}}},
      {"1/s",
       "a rate",
       "0.01 1/s",
       {{"1/s"},
        {"1/ms", 3},
        {"1/min", 0, 1, 60},
        {"1/h", 0, 1, 3600},
        {"%/s", -2},
        {"%/min", 0, 1, 6000},
        {"%/h", 0, 1, 360000},
        {"Hz"}},
       {{"s^-1"}, {"kHz", 3}}},
      {"rad", "an angle", "30 deg", {{"rad"}, {"deg", 0, degree}}, {}},
      {"rad/s",
       "an angular velocity",
       "2 rad/s",
       {{"rad/s"}, {"1/s"}, {"deg/s", 0, degree}, {"rpm", 0, per_minute}},
       {{"s^-1"}}},
      {"m", "a length", "0.5 mm", {{"m"}, {"cm", -2}, {"mm", -3}, {"um", -6}, {"km", 3}}, {}},
      {"m^2", "an area", "0.25 m^2", {{"m^2"}, {"cm^2", -4}, {"mm^2", -6}}, {}},
      {"m^3", "a volume", "0.1 m^3", {{"m^3"}, {"cm^3", -6}, {"mm^3", -9}}, {}},
      {"1/m", "an inverse length", "10 1/m", {{"1/m"}, {"1/cm", 2}, {"1/mm", 3}}, {{"m^-1"}}},
      {"m/s", "a velocity", "1 m/s", {{"m/s"}, {"cm/s", -2}, {"mm/s", -3}}, {{"km/h", 0, 1, 3.6}}},
      {"m/s^2", "an acceleration", "9.81 m/s^2", {{"m/s^2"}}, {}},
      {"kg", "a mass", "2 kg", {{"kg"}, {"g", -3}, {"t", 3}}, {}},
      {"kg/m^2", "a mass per area", "30 kg/m^2", {{"kg/m^2"}, {"g/cm^2", 1}}, {}},
      {"kg/m^3", "a density", "2650 kg/m^3", {{"kg/m^3"}, {"g/cm^3", 3}, {"t/m^3", 3}}, {}},
      {"kg/m",
       "a mass per length",
       "0.01 kg/m",
       {{"kg/m"}, {"g/m", -3}, {"Pa s^2"}},
       {{"kPa s^2", 3}, {"mPa s^2", -3}, {"N s^2/m^2"}}},
      {"Pa s", "a viscosity", "1e-3 Pa s", {{"Pa s"}, {"mPa s", -3}, {"kPa s", 3}}, {{"kg/(m s)"}, {"N s/m^2"}}},
      {"m^2/s", "a kinematic viscosity", "1e-6 m^2/s", {{"m^2/s"}, {"mm^2/s", -6}}, {}},
      {"N", "a force", "5 kN", {{"N"}, {"kN", 3}, {"MN", 6}}, {}},
      {"N/m", "a force per length", "100 N/m", {{"N/m"}, {"kN/m", 3}}, {}},
      {"N/m^3", "a force per volume", "20 kN/m^3", {{"N/m^3"}, {"kN/m^3", 3}, {"MN/m^3", 6}}, {{"Pa/m"}, {"kPa/m", 3}}},
      {"J", "an energy", "1 J", {{"J"}, {"mJ", -3}, {"kJ", 3}}, {{"N m"}}},
      {"J/kg", "an energy per mass", "1 J/kg", {{"J/kg"}, {"kJ/kg", 3}}, {{"m^2/s^2"}}},
      {"Pa/s", "a stress rate", "1 kPa/s", {{"Pa/s"}, {"kPa/s", 3}, {"MPa/s", 6}}, {}},
  };
  return table;
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

/// One spelling for "kg/m^3", "kg / m3" and "kg/m³", and for "Pa s", "Pa*s" and "Pa·s".
std::string canonical(std::string_view unit) {
  std::string text(unit);
  replace_all(text, "°", "deg");
  replace_all(text, "²", "2");
  replace_all(text, "³", "3");
  replace_all(text, "µ", "u");  // the micro sign; below the Greek letter
  replace_all(text, "μ", "u");
  replace_all(text, "·", " ");
  replace_all(text, "*", " ");
  for (std::string_view power : {" ^", "^ ", "^"}) replace_all(text, power, power.size() > 1 ? "^" : "");
  std::string result;
  for (char c : text) {
    bool needless = c == ' ' && (result.empty() || result.back() == ' ' || result.back() == '/');
    if (needless) continue;
    if (c == '/' && !result.empty() && result.back() == ' ') result.pop_back();
    result += c;
  }
  while (result.ends_with(' ')) result.pop_back();
  return result;
}

const Unit* find_unit(const Dimension& in, std::string_view typed) {
  std::string wanted = canonical(typed);
  auto matches = [&](const Unit& unit) { return canonical(unit.name) == wanted; };
  for (const auto* list : {&in.units, &in.aliases}) {
    auto unit = std::find_if(list->begin(), list->end(), matches);
    if (unit != list->end()) return &*unit;
  }
  return nullptr;
}

/// The dimension of an SI unit, which may go by another name ("m^2/s^2" for "J/kg").
const Dimension& dimension(std::string_view si) {
  for (const Dimension& d : dimensions()) {
    if (d.si == si) return d;
  }
  for (const Dimension& d : dimensions()) {
    const Unit* unit = find_unit(d, si);
    if (unit != nullptr && unit->exponent == 0 && unit->factor == unit->divisor) return d;
  }
  throw std::logic_error(fmt::format("no unit table for [{}]", si));
}

const Dimension* dimension_of(std::string_view typed) {
  for (const Dimension& d : dimensions()) {
    if (find_unit(d, typed) != nullptr) return &d;
  }
  return nullptr;
}

std::vector<std::string> names(const Dimension& d) {
  std::vector<std::string> result;
  for (const Unit& unit : d.units) result.emplace_back(unit.name);
  return result;
}

size_t count_digits(std::string_view text, size_t at) {
  size_t end = at;
  while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) ++end;
  return end - at;
}

bool is_sign(char c) { return c == '+' || c == '-'; }

/// The length of the decimal number at the head of a text, 0 when there is none.
size_t number_length(std::string_view text) {
  size_t at = !text.empty() && is_sign(text[0]) ? 1 : 0;
  size_t digits = count_digits(text, at);
  at += digits;
  if (at < text.size() && text[at] == '.') {
    size_t decimals = count_digits(text, at + 1);
    digits += decimals;
    at += 1 + decimals;
  }
  if (digits == 0) return 0;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    size_t sign = at + 1 < text.size() && is_sign(text[at + 1]) ? 1 : 0;
    size_t exponent = count_digits(text, at + 1 + sign);
    if (exponent > 0) at += 1 + sign + exponent;
  }
  return at;
}

struct Value {
  double value = 0.0;
  std::string_view problem;
};

/// The double nearest to number * 10^shift: shifting the typed exponent rounds once, where a factor rounds twice.
Value decimal(std::string_view number, int shift) {
  bool negative = number[0] == '-';
  if (is_sign(number[0])) number.remove_prefix(1);
  size_t e = std::min(number.find_first_of("eE"), number.size());
  std::string_view mantissa = number.substr(0, e);
  long exponent = shift;
  if (e < number.size()) {
    // Ten million decimals do not fit on a line, so a larger exponent is out of range whatever the digits are.
    constexpr long huge = 10'000'000;
    std::string_view typed = number.substr(e + 1);
    if (typed[0] == '+') typed.remove_prefix(1);
    long given = 0;
    auto [end, error] = std::from_chars(typed.data(), typed.data() + typed.size(), given);
    if (error == std::errc::result_out_of_range) given = typed[0] == '-' ? -huge : huge;
    exponent += std::clamp(given, -huge, huge);
  }
  std::string digits = fmt::format("{}e{}", mantissa, exponent);
  double value = 0.0;
  auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  bool is_zero = mantissa.find_first_of("123456789") == std::string_view::npos;
  if (is_zero) return {};
  if (error == std::errc::result_out_of_range) {
    size_t point = std::min(mantissa.find('.'), mantissa.size());
    size_t first = mantissa.find_first_of("123456789");
    long magnitude = exponent + static_cast<long>(point) - static_cast<long>(first);
    return {0.0, magnitude > 0 ? "it is too large for a double" : "it is too small for a double and would become zero"};
  }
  return {negative ? -value : value, {}};
}

/// Why a text is not "number unit", for the ways in which that happens.
std::string why_no_number(std::string_view text) {
  size_t sign = !text.empty() && is_sign(text[0]) ? 1 : 0;
  std::string_view body = text.substr(sign);
  auto follows = [&](std::string_view prefixes) {
    return body.size() > 1 && body[0] == '0' && prefixes.find(body[1]) != std::string_view::npos;
  };
  if (follows("xXbBoO")) return "only decimal numbers are understood";
  size_t length = number_length(text);
  std::string_view rest = text.substr(length);
  if (length == 0) {
    std::string lower(body);
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
    if (lower.starts_with('.')) lower.erase(0, 1);
    if (lower.starts_with("nan") || lower.starts_with("inf")) return "the number must be finite";
    if (text.starts_with("−") || text.starts_with("–")) return "the minus sign is a typographic one, type '-'";
    return {};
  }
  auto digit_follows = [&](size_t at) { return count_digits(rest, at) > 0; };
  if (rest[0] == ',' || rest[0] == '_' || rest[0] == '\'') {
    return "digits are not grouped, and the decimal sign is a point";
  }
  size_t word = rest.find_first_not_of(' ');
  bool blank_inside = word != 0 && digit_follows(word) && !canonical(rest).starts_with("1/");
  if (blank_inside) return "a blank stands inside the number";
  return {};
}

std::string prefixed(std::string_view what, const Node& node) { return fmt::format("{} = '{}'", what, node.text); }

[[noreturn]] void fail_number(const Node& node, std::string_view what, const Dimension& expected) {
  std::string reason = why_no_number(node.text);
  fail(node.mark, fmt::format("{} is not a number{}", prefixed(what, node), reason.empty() ? "" : ": " + reason),
       fmt::format("expected {}, for example '{}'", expected_quantity(expected.si), expected.example));
}

[[noreturn]] void fail_unit(const Node& node, std::string_view what, std::string_view typed,
                            const Dimension& expected) {
  const Dimension* other = dimension_of(typed);
  bool plain = expected.si == "-";
  if (other != nullptr && other != &expected) {
    std::string help = plain ? fmt::format("remove the unit '{}'", typed)
                             : fmt::format("expected one of: {}", accepted_units(expected.si));
    fail(node.mark,
         fmt::format("{} is {}, expected {}", prefixed(what, node), other->words, expected_quantity(expected.si)),
         help);
  }
  bool continues_number = std::string_view("+-.").find(typed[0]) != std::string_view::npos;
  if (plain || continues_number) fail_number(node, what, expected);
  std::string near = nearest(typed, names(expected));
  fail(node.mark,
       fmt::format("{}: no unit is called '{}', expected {}", prefixed(what, node), typed,
                   expected_quantity(expected.si)),
       near.empty() ? fmt::format("expected one of: {}", accepted_units(expected.si))
                    : fmt::format("did you mean '{}'?", near));
}

double scaled(double value, const Unit& unit) { return value * unit.factor / unit.divisor; }

/// The text with every typographic blank as a plain one.
std::string plain_blanks(std::string text) {
  for (std::string_view blank : {"\u00A0", "\u202F", "\u2009", "\t"}) replace_all(text, blank, " ");
  return text;
}

}  // namespace

std::pair<std::string, std::string> split_number(std::string_view text) {
  std::string plain = plain_blanks(std::string(text));
  size_t begin = std::min(plain.find_first_not_of(' '), plain.size());
  size_t length = number_length(std::string_view(plain).substr(begin));
  std::string rest = plain.substr(begin + length);
  rest.erase(0, rest.find_first_not_of(' '));
  while (rest.ends_with(' ')) rest.pop_back();
  return {plain.substr(begin, length), rest};
}

double quantity(const Node& node, std::string_view what, std::string_view unit) {
  const Dimension& expected = dimension(unit);
  if (!node.is_scalar()) {
    fail(node.mark, fmt::format("{} is {}, expected {}", what, describe(node), expected_quantity(unit)),
         fmt::format("write a number, for example '{}'", expected.example));
  }
  auto [number, typed] = split_number(node.text);
  if (number.empty() || (!typed.empty() && !why_no_number(plain_blanks(node.text)).empty())) {
    fail_number(node, what, expected);
  }
  if (typed.empty() && unit != "-") {
    fail(node.mark, fmt::format("{} has no unit, expected {}", prefixed(what, node), expected_quantity(unit)),
         fmt::format("for example '{}'; accepted: {}", expected.example, accepted_units(unit)));
  }
  static const Unit bare;
  const Unit* found = typed.empty() ? &bare : find_unit(expected, typed);
  if (found == nullptr) fail_unit(node, what, typed, expected);
  Value value = decimal(number, found->exponent);
  if (!value.problem.empty()) {
    fail(node.mark, fmt::format("{}: {}", prefixed(what, node), value.problem),
         fmt::format("expected {}, for example '{}'", expected_quantity(unit), expected.example));
  }
  double result = scaled(value.value, *found);
  if (std::isinf(result)) fail(node.mark, fmt::format("{}: it is too large for a double", prefixed(what, node)), "");
  return result;
}

std::string unit_typed(const Node& node) {
  auto [number, unit] = split_number(node.text);
  return number.empty() ? "" : unit;
}

std::optional<double> to_si(double value, std::string_view typed_unit, std::string_view unit) {
  const Dimension& expected = dimension(unit);
  if (unit == "-" && (typed_unit.empty() || typed_unit == "-")) return value;
  const Unit* found = find_unit(expected, typed_unit);
  if (found == nullptr) return std::nullopt;
  // A power of ten is exact only with a positive exponent.
  double power = std::pow(10.0, std::abs(found->exponent));
  return scaled(found->exponent < 0 ? value / power : value * power, *found);
}

std::string accepted_units(std::string_view unit) { return join(names(dimension(unit))); }

std::string expected_quantity(std::string_view unit) {
  const Dimension& d = dimension(unit);
  return unit == "-" ? std::string(d.words) : fmt::format("{} [{}]", d.words, d.si);
}

std::string example_of(std::string_view unit) { return std::string(dimension(unit).example); }

}  // namespace grainlaw::input
