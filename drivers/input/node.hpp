#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "source.hpp"

namespace grainlaw::input {

/// One value of an input: nothing, a scalar as typed, a list or a map, and where it stands.
struct Node {
  enum class Kind { null, scalar, sequence, map };
  struct Entry;

  Kind kind = Kind::null;
  std::string text;  // of a scalar; a unit behind a list has been handed down to its numbers
  bool quoted = false;
  Mark mark;
  std::vector<Node> items;
  std::vector<Entry> entries;

  bool is_null() const { return kind == Kind::null; }
  bool is_scalar() const { return kind == Kind::scalar; }
  bool is_sequence() const { return kind == Kind::sequence; }
  bool is_map() const { return kind == Kind::map; }

  /// The value of a key, or nullptr.
  const Node* find(std::string_view key) const;
  Node* find(std::string_view key);
};

struct Node::Entry {
  std::string key;
  Mark key_mark;
  Node value;
};

/// What stands there, in words: "empty", "'5 kPa'", "a list" or "a map".
std::string describe(const Node& node);

/// A scalar without a place, for trees that a program builds.
Node scalar(std::string text);

/// The same values in the same order, wherever they were typed.
bool same_tree(const Node& a, const Node& b);

/// Reads one file; a missing, unreadable or broken one is an InputError.
Node read_yaml(const std::filesystem::path& file);

/// Reads one text; the name stands in messages where a file name would.
Node parse_yaml(std::string text, std::string name);

/// Applies "test.initial.pressure=50 kPa" or "expect.0.value=3 Pa"; missing maps are made on the way.
void apply_set(Node& root, const std::string& assignment);

/// Writes a tree in block style so that it parses back to the same tree.
std::string to_yaml(const Node& node);

}  // namespace grainlaw::input
