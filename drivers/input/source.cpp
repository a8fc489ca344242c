#include "source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace grainlaw::input {
namespace {

bool continues_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) == 0x80; }

int characters(std::string_view bytes) {
  return static_cast<int>(bytes.end() - bytes.begin() - std::count_if(bytes.begin(), bytes.end(), continues_character));
}

std::string_view line_of(const Mark& at) {
  if (!at.source || at.line < 0 || static_cast<size_t>(at.line) >= at.source->lines.size()) return {};
  return at.source->lines[static_cast<size_t>(at.line)];
}

std::string_view before(const Mark& at) { return line_of(at).substr(0, static_cast<size_t>(std::max(at.column, 0))); }

/// The part of a long line around the caret, and the caret's place in it.
std::pair<std::string, int> excerpt(const Mark& at) {
  constexpr size_t width = 100, lead = 60;
  std::string_view line = line_of(at);
  auto column = std::min(static_cast<size_t>(std::max(at.column, 0)), line.size());
  size_t begin = line.size() > width && column > lead ? column - lead : 0;
  while (begin > 0 && continues_character(line[begin])) --begin;
  size_t end = std::min(line.size(), begin + width);
  while (end < line.size() && continues_character(line[end])) ++end;

  std::string shown = (begin > 0 ? "..." : "") + std::string(line.substr(begin, end - begin));
  int caret = (begin > 0 ? 3 : 0) + characters(line.substr(begin, column - begin));
  for (char& c : shown) {
    if (c == '\t') c = ' ';
    // A control character would let an input write to the terminal.
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  if (end < line.size()) shown += "...";
  return {shown, caret};
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// Damerau-Levenshtein distance: insertions, deletions, substitutions and swaps of neighbours.
size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> cost(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
  for (size_t j = 0; j <= b.size(); ++j) cost[0][j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    for (size_t j = 1; j <= b.size(); ++j) {
      size_t substituted = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, substituted});
      bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

}  // namespace

std::string locate(const Mark& at) {
  std::string name = at.source ? at.source->name : "input";
  if (at.line < 0 || !at.source) return name;
  return fmt::format("{}:{}:{}", name, at.line + 1, characters(before(at)) + 1);
}

std::string message(const Mark& at, std::string_view severity, std::string_view what, std::string_view help) {
  std::string result = fmt::format("{}: {}: {}", locate(at), severity, what);
  if (at.source && at.line >= 0) {
    auto [shown, caret] = excerpt(at);
    result += fmt::format("\n{:5} | {}\n      | {:{}}^", at.line + 1, shown, "", caret);
  }
  if (!help.empty()) result += fmt::format("\n      = {}", help);
  return result;
}

void fail(const Mark& at, std::string_view what, std::string_view help) {
  throw InputError(message(at, "error", what, help));
}

std::string nearest(std::string_view typed, const std::vector<std::string>& known) {
  // Pasted novels are not misspelt keys.
  if (typed.empty() || typed.size() > 100) return {};
  for (const std::string& word : known) {
    if (lower(word) == lower(typed)) return word;
  }
  size_t allowed = std::min(std::max<size_t>(1, typed.size() / 3), typed.size() - 1);
  std::string best;
  for (const std::string& word : known) {
    size_t d = distance(lower(typed), lower(word));
    if (d > allowed || (!best.empty() && d == allowed)) continue;
    best = word;
    allowed = d;
  }
  return best;
}

std::string did_you_mean(std::string_view typed, const std::vector<std::string>& known) {
  std::string near = nearest(typed, known);
  if (!near.empty()) return fmt::format("did you mean '{}'?", near);
  return known.empty() ? "nothing is known here" : "known: " + join(known);
}

std::string join(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

}  // namespace grainlaw::input
