#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "node.hpp"

namespace grainlaw::input {
namespace {

constexpr size_t line_width = 100;

/// Whether YAML would read the text back as it is, in block as in flow style.
bool reads_back_plain(const std::string& text) {
  if (text.empty() || text == "~" || text == "null" || text == "Null" || text == "NULL") return false;
  auto first = static_cast<unsigned char>(text[0]);
  bool signed_number = (first == '-' || first == '+') && text.size() > 1 &&
                       (std::isdigit(static_cast<unsigned char>(text[1])) != 0 || text[1] == '.');
  bool starts_plain = std::isalnum(first) != 0 || first == '_' || first == '/' || first >= 0x80 || signed_number ||
                      (first == '.' && !text.starts_with(".."));
  if (!starts_plain || text.back() == ' ' || text.find(" #") != std::string::npos) return false;
  return std::none_of(text.begin(), text.end(), [](char c) {
    bool indicates = std::string_view(",[]{}?:\"'").find(c) != std::string_view::npos;
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7F || indicates;
  });
}

std::string quote(const std::string& text) {
  std::string result = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (c == '\n') {
      result += "\\n";
    } else if (c == '\t') {
      result += "\\t";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string word(const std::string& text, bool quoted) {
  return quoted || !reads_back_plain(text) ? quote(text) : text;
}

std::string flow(const Node& node) {
  std::vector<std::string> parts;
  switch (node.kind) {
    case Node::Kind::null:
      return "~";
    case Node::Kind::scalar:
      return word(node.text, node.quoted);
    case Node::Kind::sequence:
      for (const Node& item : node.items) parts.push_back(flow(item));
      return "[" + join(parts) + "]";
    case Node::Kind::map:
      for (const auto& [key, mark, value] : node.entries) parts.push_back(word(key, false) + ": " + flow(value));
      return "{" + join(parts) + "}";
  }
  return {};
}

bool is_leaf(const Node& node) { return node.is_scalar() || node.is_null(); }

bool is_flat(const Node& node) {
  return is_leaf(node) || (node.is_sequence() && std::all_of(node.items.begin(), node.items.end(), is_leaf));
}

/// Matrices and one-level maps read better on one line, if they fit.
bool fits_on_line(const Node& node, size_t column) {
  bool simple = std::all_of(node.items.begin(), node.items.end(), is_flat) &&
                std::all_of(node.entries.begin(), node.entries.end(), [](const auto& e) { return is_flat(e.value); });
  bool nothing_to_break = node.items.empty() && node.entries.empty();
  return nothing_to_break || (simple && column + flow(node).size() <= line_width);
}

void write(const Node& node, size_t indent, std::string& out);

/// Writes a value behind "key:" or "-".
void write_value(const Node& value, size_t indent, size_t column, std::string& out) {
  if (fits_on_line(value, column)) {
    out += " " + flow(value) + "\n";
  } else {
    out += "\n";
    write(value, indent + 2, out);
  }
}

void write(const Node& node, size_t indent, std::string& out) {
  for (const auto& [key, mark, value] : node.entries) {
    std::string head = word(key, false) + ":";
    out += std::string(indent, ' ') + head;
    write_value(value, indent, indent + head.size() + 1, out);
  }
  for (const Node& item : node.items) {
    out += std::string(indent, ' ') + "-";
    write_value(item, indent, indent + 2, out);
  }
}

}  // namespace

std::string to_yaml(const Node& node) {
  if (is_leaf(node) || (node.items.empty() && node.entries.empty())) return flow(node) + "\n";
  std::string out;
  write(node, 0, out);
  return out;
}

}  // namespace grainlaw::input
