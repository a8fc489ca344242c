#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "curve.hpp"
#include "fields.hpp"

namespace grainlaw::report {

/// One axis of a figure: the CSV column it shows, its words, the factor from the CSV's unit to its
/// own, and the distance of its tic marks (0: left to gnuplot).
struct Axis {
  std::string column;
  std::string label;
  std::string unit;
  double scale = 1.0;
  bool log = false;
  double tics = 0.0;
  bool from_zero = false;  // a trace of noise below zero does not deserve a tic
};

/// One line or set of markers, in plotted units and thinned.
struct Series {
  std::string label;
  std::size_t color = 0;
  bool markers = false;
  Curve curve;
};

/// One figure of a summary, and the picture once gnuplot has drawn it.
struct Figure {
  std::filesystem::path dir;
  std::string id;
  std::string title;
  std::string caption;
  Axis x;
  Axis y;
  std::vector<Series> series;
  std::vector<std::string> problems;
  std::string svg;
};

/// Reads the figures of a summary and their CSV files; what is wrong with a series is noted in its figure.
std::vector<Figure> read_figures(const Json& summary, const std::filesystem::path& dir);

/// Writes plots/<id>.dat and plots/<id>.gp in the figure's folder and removes an older picture.
void write_plot(const Figure& figure);

/// Text with letters, digits, '.', '_' and '-' only, fit for a file name; "" when nothing is left.
std::string plain_name(const std::string& text);

/// Exponents such as m^2 or s^-1 written with raised digits.
std::string raise_exponents(const std::string& unit);

/// The unit, or "" for a pure number.
std::string shown_unit(const std::string& unit);

}  // namespace grainlaw::report
