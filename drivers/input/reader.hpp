#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "node.hpp"
#include "units.hpp"

namespace grainlaw::input {

/// The values that make sense, in SI; an open bound is itself excluded.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;
};

inline constexpr Range positive{.low = 0.0, .low_open = true};
inline constexpr Range not_negative{.low = 0.0};

/// quantity(), and an error when the value lies outside the range.
double quantity(const Node& node, std::string_view what, std::string_view unit, Range range);

/// Reads one map; every key must be asked for, and finish() turns what was not into an error with a suggestion.
///
/// A reader points into the tree, which must outlive it.
class Reader {
 public:
  Reader(const Node& map, std::string path);
  Reader(Node&& temporary, std::string path) = delete;

  /// Whether the key is there, without asking for it.
  bool has(std::string_view key) const;
  /// The value of a key, or nullptr.
  const Node* find(std::string_view key);
  /// The value of a key; `what` tells the author what to add when it is absent.
  const Node& need(std::string_view key, std::string_view what);

  /// The error of a key that is not there, pointing at a likely misspelling of it.
  [[noreturn]] void missing(std::string_view key, std::string_view what, std::string_view remedy) const;

  double number(std::string_view key, std::string_view unit, Range range = {});
  double number_or(std::string_view key, std::string_view unit, double fallback, Range range = {});
  std::optional<double> maybe_number(std::string_view key, std::string_view unit, Range range = {});
  /// A list of numbers; a single number is a list of one.
  std::vector<double> numbers(std::string_view key, std::string_view unit, Range range = {});

  /// A whole number without unit.
  std::int64_t integer(std::string_view key, Range range = {});
  std::int64_t integer_or(std::string_view key, std::int64_t fallback, Range range = {});

  /// One of the allowed words.
  std::string word(std::string_view key, const std::vector<std::string>& allowed);
  std::string word_or(std::string_view key, const std::vector<std::string>& allowed, std::string fallback);
  std::string text(std::string_view key, std::string_view what = "a text");
  std::string text_or(std::string_view key, std::string fallback);
  /// `true` or `false`, and no other spelling.
  bool flag_or(std::string_view key, bool fallback);

  Reader map(std::string_view key);
  std::optional<Reader> maybe_map(std::string_view key);
  /// The entries of a list; an absent key is an empty list.
  std::vector<const Node*> list(std::string_view key);
  /// The entries of a list of maps; an absent key is an empty list.
  std::vector<Reader> maps(std::string_view key);

  /// A key that is known but would change nothing here: an error that says why.
  void inert(std::string_view key, std::string_view why);
  /// Keys that someone else reads.
  void known(std::initializer_list<std::string_view> keys);
  void known(const std::vector<std::string>& keys);
  /// An error at the first key that nobody asked for.
  void finish() const;

  /// "test.initial.pressure": how messages and --set name a key of this map.
  std::string path(std::string_view key) const;
  const std::string& path() const { return own_path; }
  const Node& node() const { return *tree; }
  /// Where the key stands, or the map itself when the key is absent.
  Mark mark(std::string_view key) const;

 private:
  void ask(std::string_view key);

  const Node* tree;
  std::string own_path;
  std::vector<std::string> asked;
};

}  // namespace grainlaw::input
