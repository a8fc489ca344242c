#include "html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "figure.hpp"

namespace grainlaw::report {
namespace {

constexpr const char* minus = "\u2212";

constexpr const char* style_sheet = R"css(
:root { color-scheme: light; --ink: #1c2024; --soft: #5d666f; --rule: #d9dde1; --pale: #f5f7f8; --accent: #0072b2; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1120px; padding: 2.2rem 1.6rem 3rem; background: #fff; color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }
h1 { margin: 0; font-size: 1.85rem; line-height: 1.25; font-weight: 650; letter-spacing: -0.01em; }
h2 { margin: 2.3rem 0 0.7rem; font-size: 1.2rem; font-weight: 650; }
h3 { margin: 1.7rem 0 0.5rem; font-size: 1rem; font-weight: 650; }
p { margin: 0.4rem 0; max-width: 52rem; }
a { color: var(--accent); text-decoration: none; }
a:hover { text-decoration: underline; }
code { font: 0.9em ui-monospace, "SF Mono", Menlo, Consolas, monospace; }
sup { line-height: 0; font-size: 0.75em; }
header { border-bottom: 2px solid var(--ink); padding-bottom: 1rem; }
.source { color: var(--soft); margin-top: 0.25rem; }
.facts { display: flex; flex-wrap: wrap; gap: 0.3rem 2.2rem; margin: 0.8rem 0 0; }
.facts dt { font-size: 0.78rem; color: var(--soft); }
.facts dd { margin: 0; overflow-wrap: anywhere; }
.status { margin: 1rem 0 0; padding: 0.6rem 0.9rem; border-left: 4px solid #b3261e; background: #fdf3f2; }
.status ul { margin: 0.2rem 0 0; padding-left: 1.2rem; }
.contents { margin: 0; padding-left: 1.4rem; }
.contents li { padding: 0.1rem 0; }
.contents span { color: var(--soft); }
.part { margin-top: 3rem; padding-top: 0.4rem; border-top: 2px solid var(--ink); }
.part > h2 { margin-top: 0.8rem; font-size: 1.45rem; margin-bottom: 0; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.9rem; line-height: 1.4; font-variant-numeric: tabular-nums; }
th, td { padding: 0.32rem 0.9rem 0.32rem 0; text-align: left; vertical-align: top; overflow-wrap: break-word; }
th + th, td + td { padding-left: 0.5rem; }
th { font-weight: 600; color: var(--soft); font-size: 0.82rem; vertical-align: bottom; }
thead tr { border-top: 1.5px solid var(--ink); border-bottom: 1px solid var(--ink); }
tbody tr { border-bottom: 1px solid var(--rule); }
tbody tr:last-child { border-bottom: 1.5px solid var(--ink); }
.n { text-align: right; white-space: nowrap; }
.met { color: #00664b; white-space: nowrap; }
.unmet { color: #b3261e; font-weight: 650; white-space: nowrap; }
.soft { color: var(--soft); }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 440px), 1fr)); gap: 1.6rem 2rem;
  align-items: start; }
figure { margin: 0; break-inside: avoid; }
figure:only-child { max-width: 600px; }
figure svg { display: block; width: 100%; height: auto; }
figure svg text { font-family: "Helvetica Neue", Helvetica, Arial, sans-serif; }
figcaption { margin-top: 0.3rem; font-size: 0.88rem; color: #3b434a; }
figcaption b { color: var(--ink); }
.missing { padding: 2.4rem 1.2rem; border: 1px dashed #aab2b9; color: var(--soft); text-align: center; }
.remark { margin: 0.2rem 0 0; font-size: 0.82rem; color: #8a5200; overflow-wrap: anywhere; }
.notes { margin: 0; padding-left: 1.2rem; max-width: 52rem; }
.notes li { margin: 0.2rem 0; overflow-wrap: anywhere; }
.warning { color: #8a5200; font-weight: 600; }
footer { margin-top: 3rem; padding-top: 0.7rem; border-top: 1px solid var(--rule); font-size: 0.82rem;
  color: var(--soft); }
@media print {
  @page { margin: 14mm; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  .wide { overflow: visible; }
  .figures { grid-template-columns: 1fr 1fr; gap: 1rem; }
  h2, h3 { break-after: avoid; }
  tr { break-inside: avoid; }
  a { color: inherit; }
}
)css";

/// Whether text is a number, perhaps with a unit after it, so that its column is set flush right.
bool reads_as_number(const std::string& text) {
  char* end = nullptr;
  static_cast<void>(std::strtod(text.c_str(), &end));
  const std::string rest = end;
  return end != text.c_str() && (rest.empty() || rest == "%" || (rest[0] == ' ' && rest.find(' ', 1) == rest.npos));
}

std::string without_trailing_zeros(std::string digits) {
  if (digits.find('.') == std::string::npos) return digits;
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return digits;
}

}  // namespace

std::string escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string show(double value, int digits) {
  if (!std::isfinite(value)) return std::isnan(value) ? "" : value > 0 ? "\u221e" : std::string(minus) + "\u221e";
  const std::string sign = value < 0.0 ? minus : "";
  const double size = std::abs(value);
  if (size == 0.0) return "0";
  const std::string scientific = fmt::format("{:.{}e}", size, digits - 1);
  const auto mark = scientific.find('e');
  const int exponent = std::stoi(scientific.substr(mark + 1));
  if (exponent >= -3 && exponent < 7) {
    return sign + without_trailing_zeros(fmt::format("{:.{}f}", size, std::max(0, digits - 1 - exponent)));
  }
  const std::string power = (exponent < 0 ? minus : "") + std::to_string(std::abs(exponent));
  return fmt::format("{}{}×10<sup>{}</sup>", sign, without_trailing_zeros(scientific.substr(0, mark)), power);
}

std::string show(double value, const std::string& unit, int digits) {
  const std::string number = show(value, digits);
  const std::string suffix = shown_unit(unit);
  return number.empty() || suffix.empty() ? number : number + "\u00a0" + escape(suffix);
}

Cell cell(const Json& value, int digits) {
  if (value.is_null()) return {};
  if (value.is_number()) return {show(value.get<double>(), digits), true};
  if (value.is_boolean()) return {value.get<bool>() ? "yes" : "no"};
  const std::string words = value.is_string() ? value.get<std::string>() : value.dump();
  if (words == "-") return {"\u2013", true};
  if (!reads_as_number(words)) return {escape(words)};
  return {(words[0] == '-' ? minus + escape(words.substr(1)) : escape(words)), true};
}

Cell cell(const Json& object, const std::string& key, int digits) {
  const auto found = object.find(key);
  return found == object.end() ? Cell{} : cell(*found, digits);
}

void Table::add(std::vector<Cell> row) {
  row.resize(header_.size());
  rows_.push_back(std::move(row));
}

std::string Table::html() const {
  std::vector<std::size_t> columns;
  std::vector<bool> numeric(header_.size(), true);
  for (std::size_t c = 0; c < header_.size(); ++c) {
    bool filled = false;
    for (const auto& row : rows_) {
      if (row[c].html.empty()) continue;
      filled = true;
      if (!row[c].numeric) numeric[c] = false;
    }
    if (filled) columns.push_back(c);
  }
  if (columns.empty() || (columns.size() == 1 && header_.size() > 1)) return "";

  const auto attribute = [&numeric](std::size_t column, const std::string& style) {
    const std::string classes = numeric[column] ? (style.empty() ? "n" : "n " + style) : style;
    return classes.empty() ? classes : fmt::format(" class=\"{}\"", classes);
  };
  std::string out = "<div class=\"wide\"><table>\n<thead><tr>";
  for (const std::size_t c : columns) out += fmt::format("<th{}>{}</th>", attribute(c, ""), escape(header_[c]));
  out += "</tr></thead>\n<tbody>\n";
  for (const auto& row : rows_) {
    out += "<tr>";
    for (const std::size_t c : columns) out += fmt::format("<td{}>{}</td>", attribute(c, row[c].style), row[c].html);
    out += "</tr>\n";
  }
  return out + "</tbody>\n</table></div>\n";
}

std::string document(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      escape(title), style_sheet, body);
}

}  // namespace grainlaw::report
