#include "list_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

namespace grainlaw::input {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_flow_indicator(char c) { return std::string_view(",[]{}").find(c) != std::string_view::npos; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0; }
bool is_unit_character(char c) {
  return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("/^*%.-+ \t").find(c) != std::string_view::npos;
}

bool looks_like_unit(std::string_view word) {
  auto names_it = [](char c) { return is_letter(c) || c == '%'; };
  return !word.empty() && std::all_of(word.begin(), word.end(), is_unit_character) &&
         std::any_of(word.begin(), word.end(), names_it);
}

/// Follows the YAML text just closely enough to tell lists from quotes, comments, block scalars and plain text.
class Scanner {
 public:
  Scanner(std::vector<std::string>& text, const std::shared_ptr<const Source>& from) : lines(text), source(from) {}

  ListUnits run() {
    for (line = 0; line < lines.size(); ++line) {
      column = 0;
      if (quote == 0 && open.empty() && !begins_block_line()) continue;
      scan_line();
    }
    if (quote != 0) fail(quote_mark, "this quotation mark is never closed", "close it on the same line");
    if (!open.empty()) {
      char closing = open.back().character == '[' ? ']' : '}';
      fail(open.back().mark, fmt::format("this '{}' is never closed", open.back().character),
           fmt::format("add the missing '{}'", closing));
    }
    return std::move(units);
  }

 private:
  struct Bracket {
    char character;
    Mark mark;
  };

  const std::string& text() const { return lines[line]; }
  Mark here() const { return {source, static_cast<int>(line), static_cast<int>(column)}; }
  bool ends_word(size_t at) const { return at >= text().size() || is_blank(text()[at]); }
  bool starts_comment(size_t at) const { return text()[at] == '#' && (at == 0 || is_blank(text()[at - 1])); }

  /// False when the whole line belongs to a text that began above, or is empty.
  bool begins_block_line() {
    size_t first = text().find_first_not_of(" \t");
    if (first == std::string::npos) return false;
    bool marks_document = (text().starts_with("---") || text().starts_with("...")) && ends_word(3);
    if (marks_document) {
      in_block_scalar = in_plain_text = false;
      owner = -1;
      column = 3;
      expects_value = true;
      return true;
    }
    auto indent = static_cast<int>(text().find_first_not_of(' '));
    if ((in_block_scalar || in_plain_text) && indent > owner) return false;
    in_block_scalar = in_plain_text = false;
    if (text()[first] == '#') return false;
    column = static_cast<size_t>(indent);
    if (text()[column] == '\t') fail(here(), "a tab stands in the indentation", "indent with spaces");
    expects_value = true;
    return true;
  }

  void scan_line() {
    while (column < text().size()) {
      if (quote != 0) {
        skip_quoted();
      } else if (is_blank(text()[column])) {
        ++column;
      } else if (starts_comment(column)) {
        return;
      } else if (open.empty()) {
        block_token();
      } else {
        flow_token();
      }
    }
  }

  void block_token() {
    char c = text()[column];
    if (!expects_value) {
      // A colon turns the finished value into a key.
      if (c != ':') {
        fail(here(), "nothing may follow here, the value is complete",
             "put quotes around the whole text; a unit stands behind each number, or behind a [list]");
      }
      owner = key_column;
      expects_value = true;
      ++column;
      return;
    }
    key_column = static_cast<int>(column);
    if (c == '"' || c == '\'') return open_quote();
    if (c == '[' || c == '{') return open_bracket();
    if ((c == '-' || c == '?' || c == ':') && ends_word(column + 1)) {
      if (c != ':') owner = key_column;
      ++column;
    } else if (c == '|' || c == '>') {
      in_block_scalar = true;
      column = text().size();
    } else if (c == '&' || c == '*' || c == '!') {
      while (!ends_word(column)) ++column;
    } else {
      plain_text();
    }
  }

  void plain_text() {
    for (; column < text().size() && !starts_comment(column); ++column) {
      if (text()[column] != ':' || !ends_word(column + 1)) continue;
      owner = key_column;
      ++column;
      return;
    }
    in_plain_text = true;
    expects_value = false;
  }

  void flow_token() {
    char c = text()[column];
    if (c == '[' || c == '{') return open_bracket();
    if (c == ']' || c == '}') return close_bracket();
    if ((c == '"' || c == '\'') && expects_value) return open_quote();
    if (c == ',' || c == ':') {
      expects_value = true;
      ++column;
    } else if (expects_value && (c == '&' || c == '*' || c == '!' || (c == '?' && ends_word(column + 1)))) {
      while (!ends_word(column) && !is_flow_indicator(text()[column])) ++column;
    } else {
      expects_value = false;
      flow_text();
    }
  }

  void flow_text() {
    for (; column < text().size() && !is_flow_indicator(text()[column]) && !starts_comment(column); ++column) {
      bool ends_key = ends_word(column + 1) || is_flow_indicator(text()[column + 1]);
      if (text()[column] == ':' && ends_key) return;
    }
  }

  void open_quote() {
    quote = text()[column];
    quote_mark = here();
    ++column;
  }

  void skip_quoted() {
    for (; column < text().size(); ++column) {
      const bool escaped = quote == '"' && text()[column] == '\\';
      const bool doubled = quote == '\'' && text().compare(column, 2, "''") == 0;
      if (escaped || doubled) {
        ++column;
      } else if (text()[column] == quote) {
        quote = 0;
        expects_value = false;
        ++column;
        return;
      }
    }
  }

  void open_bracket() {
    open.push_back({text()[column], here()});
    expects_value = true;
    ++column;
  }

  void close_bracket() {
    Bracket bracket = open.back();
    char closing = bracket.character == '[' ? ']' : '}';
    if (text()[column] != closing) {
      fail(here(),
           fmt::format("'{}' closes a '{}' of line {}", text()[column], bracket.character, bracket.mark.line + 1),
           fmt::format("write '{}' here, or close the inner bracket first", closing));
    }
    open.pop_back();
    expects_value = false;
    ++column;
    if (closing == ']') take_unit(bracket);
  }

  void take_unit(const Bracket& bracket) {
    size_t end = column;
    while (end < text().size() && !starts_comment(end) && (open.empty() || !is_flow_indicator(text()[end]))) ++end;
    size_t begin = column;
    while (begin < end && is_blank(text()[begin])) ++begin;
    while (end > begin && is_blank(text()[end - 1])) --end;
    std::string word = text().substr(begin, end - begin);
    if (!looks_like_unit(word)) return;
    column = begin;
    units[{bracket.mark.line, bracket.mark.column}] = {word, here()};
    lines[line].replace(begin, word.size(), word.size(), ' ');
  }

  std::vector<std::string>& lines;
  std::shared_ptr<const Source> source;
  ListUnits units;

  size_t line = 0;
  size_t column = 0;
  std::vector<Bracket> open;
  char quote = 0;
  Mark quote_mark;
  bool expects_value = true;
  bool in_block_scalar = false;
  bool in_plain_text = false;
  int key_column = 0;
  int owner = -1;  // the column of the key or dash that a text over several lines belongs to
};

}  // namespace

ListUnits take_list_units(std::vector<std::string>& lines, const std::shared_ptr<const Source>& source) {
  return Scanner(lines, source).run();
}

}  // namespace grainlaw::input
