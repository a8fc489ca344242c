#include "reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainlaw::input {
namespace {

/// "above 0 Pa and at most 5 Pa".
std::string describe(const Range& range, std::string_view unit) {
  std::string symbol = unit == "-" ? "" : fmt::format(" {}", unit);
  std::vector<std::string> bounds;
  if (std::isfinite(range.low)) {
    bounds.push_back(fmt::format("{} {}{}", range.low_open ? "above" : "at least", range.low, symbol));
  }
  if (std::isfinite(range.high)) {
    bounds.push_back(fmt::format("{} {}{}", range.high_open ? "below" : "at most", range.high, symbol));
  }
  return fmt::format("{}", fmt::join(bounds, " and "));
}

bool contains(const Range& range, double value) {
  bool above = range.low_open ? value > range.low : value >= range.low;
  bool below = range.high_open ? value < range.high : value <= range.high;
  return above && below;
}

std::int64_t whole(const Node& node, std::string_view what, const Range& range) {
  double value = quantity(node, what, "-", range);
  constexpr double largest_exact = 9007199254740992.0;  // 2^53
  if (value != std::floor(value) || std::abs(value) > largest_exact || !unit_typed(node).empty()) {
    fail(node.mark, fmt::format("{} = '{}' is not a whole number", what, node.text), "for example '10'");
  }
  return static_cast<std::int64_t>(value);
}

}  // namespace

double quantity(const Node& node, std::string_view what, std::string_view unit, Range range) {
  double value = quantity(node, what, unit);
  if (!contains(range, value)) {
    fail(node.mark, fmt::format("{} = '{}' is outside its range", what, node.text),
         fmt::format("expected {} {}", expected_quantity(unit), describe(range, unit)));
  }
  return value;
}

Reader::Reader(const Node& map, std::string path) : tree(&map), own_path(std::move(path)) {
  if (map.is_map()) return;
  std::string name = own_path.empty() ? "the input" : own_path;
  fail(map.mark, fmt::format("{} is {}, expected a map with keys", name, input::describe(map)),
       "write 'key: value' lines, or {key: value, key: value}");
}

bool Reader::has(std::string_view key) const { return tree->find(key) != nullptr; }

void Reader::ask(std::string_view key) {
  if (std::find(asked.begin(), asked.end(), key) == asked.end()) asked.emplace_back(key);
}

const Node* Reader::find(std::string_view key) {
  ask(key);
  return tree->find(key);
}

const Node& Reader::need(std::string_view key, std::string_view what) {
  if (const Node* value = find(key)) return *value;
  missing(key, fmt::format("'{}' is missing", path(key)), what);
}

void Reader::missing(std::string_view key, std::string_view what, std::string_view remedy) const {
  std::string help(remedy);
  std::vector<std::string> others;
  for (const Node::Entry& entry : tree->entries) {
    if (std::find(asked.begin(), asked.end(), entry.key) == asked.end()) others.push_back(entry.key);
  }
  std::string near = nearest(key, others);
  if (!near.empty()) help += fmt::format(" (is '{}' at {} a misspelling of it?)", near, locate(mark(near)));
  fail(tree->mark, what, help);
}

double Reader::number(std::string_view key, std::string_view unit, Range range) {
  std::string what = fmt::format("add {}, for example '{}: {}'", expected_quantity(unit), key, example_of(unit));
  return quantity(need(key, what), path(key), unit, range);
}

double Reader::number_or(std::string_view key, std::string_view unit, double fallback, Range range) {
  return maybe_number(key, unit, range).value_or(fallback);
}

std::optional<double> Reader::maybe_number(std::string_view key, std::string_view unit, Range range) {
  const Node* value = find(key);
  if (value == nullptr) return std::nullopt;
  return quantity(*value, path(key), unit, range);
}

std::vector<double> Reader::numbers(std::string_view key, std::string_view unit, Range range) {
  std::string what = fmt::format("add a list, for example '{}: [{}]'", key, example_of(unit));
  const Node& value = need(key, what);
  if (!value.is_sequence()) return {quantity(value, path(key), unit, range)};
  std::vector<double> result;
  for (const Node& item : value.items) {
    result.push_back(quantity(item, fmt::format("{}.{}", path(key), result.size()), unit, range));
  }
  return result;
}

std::int64_t Reader::integer(std::string_view key, Range range) {
  return whole(need(key, fmt::format("add a whole number, for example '{}: 10'", key)), path(key), range);
}

std::int64_t Reader::integer_or(std::string_view key, std::int64_t fallback, Range range) {
  const Node* value = find(key);
  return value == nullptr ? fallback : whole(*value, path(key), range);
}

std::string Reader::word(std::string_view key, const std::vector<std::string>& allowed) {
  std::string what = "one of: " + join(allowed);
  const Node& value = need(key, what);
  if (!value.is_scalar()) fail(value.mark, fmt::format("{} is {}, expected a word", path(key), describe(value)), what);
  if (std::find(allowed.begin(), allowed.end(), value.text) == allowed.end()) {
    fail(value.mark, fmt::format("{} = '{}' is not a known choice", path(key), value.text),
         did_you_mean(value.text, allowed));
  }
  return value.text;
}

std::string Reader::word_or(std::string_view key, const std::vector<std::string>& allowed, std::string fallback) {
  return find(key) == nullptr ? std::move(fallback) : word(key, allowed);
}

std::string Reader::text(std::string_view key, std::string_view what) {
  const Node& value = need(key, what);
  if (!value.is_scalar()) {
    fail(value.mark, fmt::format("{} is {}, expected a text", path(key), describe(value)), what);
  }
  return value.text;
}

std::string Reader::text_or(std::string_view key, std::string fallback) {
  return find(key) == nullptr ? std::move(fallback) : text(key, fmt::format("write '{}: a text'", key));
}

bool Reader::flag_or(std::string_view key, bool fallback) {
  const Node* value = find(key);
  if (value == nullptr) return fallback;
  if (!value->is_scalar() || (value->text != "true" && value->text != "false")) {
    fail(value->mark, fmt::format("{} is {}, expected true or false", path(key), describe(*value)),
         fmt::format("write '{}: true' or '{}: false'", key, key));
  }
  return value->text == "true";
}

Reader Reader::map(std::string_view key) {
  return {need(key, fmt::format("add a map, '{}: {{...}}'", key)), path(key)};
}

std::optional<Reader> Reader::maybe_map(std::string_view key) {
  const Node* value = find(key);
  if (value == nullptr) return std::nullopt;
  return Reader(*value, path(key));
}

std::vector<const Node*> Reader::list(std::string_view key) {
  const Node* value = find(key);
  if (value == nullptr) return {};
  if (!value->is_sequence()) {
    fail(value->mark, fmt::format("{} is {}, expected a list", path(key), describe(*value)),
         "write [a, b], or one line with '- ' for each entry");
  }
  std::vector<const Node*> result;
  for (const Node& item : value->items) result.push_back(&item);
  return result;
}

std::vector<Reader> Reader::maps(std::string_view key) {
  std::vector<Reader> result;
  for (const Node* item : list(key)) result.emplace_back(*item, fmt::format("{}.{}", path(key), result.size()));
  return result;
}

void Reader::inert(std::string_view key, std::string_view why) {
  if (has(key)) fail(mark(key), fmt::format("'{}' would change nothing here", path(key)), why);
}

void Reader::known(std::initializer_list<std::string_view> keys) {
  for (std::string_view key : keys) ask(key);
}

void Reader::known(const std::vector<std::string>& keys) {
  for (const std::string& key : keys) ask(key);
}

void Reader::finish() const {
  for (const Node::Entry& entry : tree->entries) {
    if (std::find(asked.begin(), asked.end(), entry.key) != asked.end()) continue;
    std::string head = entry.key.substr(0, entry.key.find(':'));
    bool lacks_blank = head != entry.key && std::find(asked.begin(), asked.end(), head) != asked.end();
    fail(entry.key_mark, fmt::format("unknown key '{}'", path(entry.key)),
         lacks_blank ? "a blank is missing behind ':'" : did_you_mean(entry.key, asked));
  }
}

std::string Reader::path(std::string_view key) const {
  return own_path.empty() ? std::string(key) : fmt::format("{}.{}", own_path, key);
}

Mark Reader::mark(std::string_view key) const {
  for (const Node::Entry& entry : tree->entries) {
    if (entry.key == key) return entry.key_mark;
  }
  return tree->mark;
}

}  // namespace grainlaw::input
