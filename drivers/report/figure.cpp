#include "figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

#include "../input/csv.hpp"

namespace grainlaw::report {
namespace {

constexpr std::size_t line_limit = 600;
constexpr std::size_t marker_limit = 1500;

// Okabe and Ito's colours, told apart by colour-blind readers; their yellow is too pale for a line on white.
constexpr std::array palette = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#333333"};

using CsvCache = std::map<std::string, input::Csv>;

/// Text that stays on its line.
std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  return text;
}

/// A gnuplot string: nothing is substituted between single quotes, and a doubled quote stands for one.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : on_one_line(text)) out += c == '\'' ? "''" : std::string(1, c);
  return out + "'";
}

/// A round distance (1, 2 or 5 times a power of ten) that divides the extent in three to six.
double round_tics(double extent) {
  if (!(extent > 0.0)) return 0.0;
  const double least = extent / 6.0;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least) return factor * power;
  }
  return 10.0 * power;
}

Axis read_axis(const Json& figure, const std::string& key) {
  const Json& axis = object(figure, key);
  return {.column = text(axis, "column"),
          .label = text(axis, "label"),
          .unit = text(axis, "unit"),
          .scale = number(axis, "scale", 1.0),
          .log = text(figure, "log").find(key) != std::string::npos,
          .tics = 0.0,
          .from_zero = false};
}

/// The values of a series along one axis: the axis's column by name, or the series's own by number from 1.
std::vector<double> read_values(const input::Csv& csv, const Json& series, const std::string& key, const Axis& axis) {
  const double scale = number(series, key + "_scale", axis.scale);
  const double own = number(series, key, std::nan(""));
  std::size_t index = 0;
  if (!std::isnan(own)) {
    if (!(own >= 1.0 && own <= static_cast<double>(csv.columns.size()))) {
      throw std::runtime_error(fmt::format("has no column number {:g}", own));
    }
    index = static_cast<std::size_t>(own) - 1;
  } else {
    const auto found = std::find(csv.names.begin(), csv.names.end(), axis.column);
    if (found == csv.names.end()) throw std::runtime_error(fmt::format("has no column '{}'", axis.column));
    index = static_cast<std::size_t>(found - csv.names.begin());
  }
  std::vector<double> values = csv.columns[index];
  for (double& value : values) value *= scale;
  return values;
}

Curve read_curve(const Json& series, const Figure& figure, CsvCache& cache) {
  const std::string file = text(series, "csv");
  auto found = cache.find(file);
  if (found == cache.end() && !std::filesystem::is_regular_file(figure.dir / file)) {
    throw std::runtime_error("cannot be read");
  }
  if (found == cache.end()) found = cache.emplace(file, input::read_csv(figure.dir / file)).first;
  const auto x = read_values(found->second, series, "x", figure.x);
  const auto y = read_values(found->second, series, "y", figure.y);
  Curve curve;
  curve.reserve(x.size());
  const auto first = static_cast<std::size_t>(std::max(number(series, "from_row", 0.0), 0.0));
  for (std::size_t i = first; i < x.size(); ++i) curve.push_back({x[i], y[i]});
  return curve;
}

Figure read_figure(const Json& json, const std::filesystem::path& dir, CsvCache& cache) {
  Figure figure;
  figure.dir = dir;
  figure.id = plain_name(text(json, "id"));
  figure.title = text(json, "title");
  figure.caption = text(json, "caption");
  figure.x = read_axis(json, "x");
  figure.y = read_axis(json, "y");

  Frame frame(figure.x.log, figure.y.log);
  std::size_t position = 0;
  for (const Json& entry : list(json, "series")) {
    const double color = number(entry, "color", static_cast<double>(position++));
    const bool markers = entry.value("points", false);
    const std::string file = text(entry, "csv");
    try {
      Curve curve = read_curve(entry, figure, cache);
      const auto drawable = [&frame](const Point& point) { return is_finite(frame.place(point)); };
      if (std::none_of(curve.begin(), curve.end(), drawable)) {
        figure.problems.push_back(file + ": no values that can be drawn here");
        continue;
      }
      frame.include(curve);
      figure.series.push_back(
          {text(entry, "label"), static_cast<std::size_t>(std::max(color, 0.0)), markers, std::move(curve)});
    } catch (const std::runtime_error& error) {
      figure.problems.push_back(file + ": " + error.what());
    }
  }
  // gnuplot's own choice can crowd long labels such as -0.008 until they touch.
  if (!figure.x.log) figure.x.tics = round_tics(frame.extent().x);
  if (!figure.y.log) figure.y.tics = round_tics(frame.extent().y);
  const auto noise = [](double low, double extent) { return low < 0.0 && -low < 0.02 * extent; };
  figure.x.from_zero = !figure.x.log && noise(frame.low().x, frame.extent().x);
  figure.y.from_zero = !figure.y.log && noise(frame.low().y, frame.extent().y);
  for (Series& series : figure.series) {
    series.curve =
        series.markers ? thin_markers(series.curve, frame, marker_limit) : thin_line(series.curve, frame, line_limit);
  }
  return figure;
}

std::string axis_commands(const Axis& axis, char name) {
  const std::string unit = shown_unit(axis.unit);
  const std::string label = unit.empty() ? axis.label : fmt::format("{} [{}]", axis.label, unit);
  std::string out =
      fmt::format("set {}label {} noenhanced{}\n", name, quoted(label), name == 'x' ? " offset 0,0.3" : "");
  if (axis.log) out += fmt::format("set logscale {0}\nset format {0} '10^{{%T}}'\n", name);
  if (axis.from_zero) out += fmt::format("set {}range [0:*]\n", name);
  if (axis.tics > 0.0) out += fmt::format("set {}tics {:.6g}\n", name, axis.tics);
  return out;
}

std::string style(const Series& series) {
  const char* color = palette[series.color % palette.size()];
  if (series.markers) return fmt::format("with points pt 6 ps 0.6 lw 1.1 lc rgb '{}'", color);
  constexpr std::array dashes = {1, 2, 4, 3};
  const int dash = dashes[series.color / palette.size() % dashes.size()];
  return fmt::format("with lines lw 1.8 dt {} lc rgb '{}'", dash, color);
}

/// Characters of UTF-8 text, good enough to lay out a legend.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string script(const Figure& figure) {
  std::size_t longest = 0;
  std::size_t labels = 0;
  for (const Series& series : figure.series) {
    longest = std::max(longest, width(series.label));
    labels += series.label.empty() ? 0 : 1;
  }
  const std::size_t columns = std::clamp<std::size_t>(450 / (8 * longest + 50), 1, 4);
  const std::size_t rows = (labels + columns - 1) / columns;

  std::string out = "# " + on_one_line(figure.title) + "\n";
  out += "# Run from the folder above this one: gnuplot plots/" + figure.id + ".gp\n";
  out += "# Written anew with every report: keep an edited copy under another name.\n\n";
  out += "reset\nset encoding utf8\n";
  out += fmt::format("set terminal svg size 540,{} enhanced font 'Arial,14' background 'white'\n", 380 + 20 * rows);
  out += fmt::format("set output 'plots/{0}.svg'\ndata = 'plots/{0}.dat'\n\n", figure.id);
  out += "set border 3 lw 0.8 lc rgb '#555555'\n";
  out += "set tics out nomirror scale 0.6,0.3 textcolor rgb '#222222'\n";
  out += "set grid lt 1 lw 0.6 lc rgb '#e3e3e3'\n";
  out += "set xzeroaxis lt 1 lw 0.8 lc rgb '#999999'\n";
  out += "set format '%h'\n";
  out += fmt::format("set bmargin {:.1f}\n", 3.85 + 1.0 * static_cast<double>(rows));
  out += labels == 0 ? "unset key\n"
                     : fmt::format("set key below Left reverse noenhanced samplen 2 maxcols {}\n", columns);
  out += axis_commands(figure.x, 'x') + axis_commands(figure.y, 'y') + "\n";

  std::size_t index = 0;
  for (const Series& series : figure.series) {
    const std::string title = series.label.empty() ? "notitle" : "title " + quoted(series.label);
    out += fmt::format("{}data index {} {} {}", index == 0 ? "plot " : ", \\\n     ", index, style(series), title);
    ++index;
  }
  return out + "\n\nset output\n";
}

/// One block per series, as gnuplot's `index` counts them; a single empty line interrupts a line.
std::string data(const Figure& figure) {
  std::string out;
  std::size_t index = 0;
  for (const Series& series : figure.series) {
    out += fmt::format("{}# index {}: {}\n", index == 0 ? "" : "\n\n", index, on_one_line(series.label));
    ++index;
    Curve curve = series.curve;
    while (!curve.empty() && !is_finite(curve.back())) curve.pop_back();
    for (const Point& point : curve) {
      out += is_finite(point) ? fmt::format("{:.9g} {:.9g}\n", point.x, point.y) : "\n";
    }
  }
  return out;
}

void write(const std::filesystem::path& file, const std::string& content) {
  std::ofstream out(file, std::ios::binary);
  out << content;
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace

std::vector<Figure> read_figures(const Json& summary, const std::filesystem::path& dir) {
  CsvCache cache;
  std::set<std::string> taken;
  std::vector<Figure> figures;
  for (const Json& json : list(summary, "figures")) {
    Figure figure = read_figure(json, dir, cache);
    if (figure.id.empty()) figure.id = "figure";
    const std::string stem = figure.id;
    for (int n = 2; !taken.insert(figure.id).second; ++n) figure.id = fmt::format("{}_{}", stem, n);
    figures.push_back(std::move(figure));
  }
  return figures;
}

void write_plot(const Figure& figure) {
  const auto plots = figure.dir / "plots";
  std::filesystem::create_directories(plots);
  std::filesystem::remove(plots / (figure.id + ".svg"));
  write(plots / (figure.id + ".dat"), data(figure));
  write(plots / (figure.id + ".gp"), script(figure));
}

std::string plain_name(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    const bool letter = u < 128 && std::isalnum(u);
    if (out.empty() && !letter) continue;
    out += letter || c == '-' || c == '.' ? c : '_';
  }
  return out;
}

std::string raise_exponents(const std::string& unit) {
  constexpr std::array digits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out;
  bool raised = false;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const auto is_digit = [&unit](std::size_t k) {
      return k < unit.size() && std::isdigit(static_cast<unsigned char>(unit[k]));
    };
    const bool starts = unit[i] == '^' && (is_digit(i + 1) || (i + 1 < unit.size() && unit[i + 1] == '-'));
    if (starts) {
      raised = true;
    } else if (raised && is_digit(i)) {
      out += digits[static_cast<std::size_t>(unit[i] - '0')];
    } else if (raised && unit[i] == '-') {
      out += "⁻";
    } else {
      raised = false;
      out += unit[i];
    }
  }
  return out;
}

std::string shown_unit(const std::string& unit) { return unit == "-" ? "" : raise_exponents(unit); }

}  // namespace grainlaw::report
