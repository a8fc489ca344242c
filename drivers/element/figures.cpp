// SPDX-License-Identifier: BSD-3-Clause
#include "figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "sweep.hpp"

namespace grainlaw::element {

using Json = nlohmann::ordered_json;

namespace {

struct AxisStyle {
  std::string column, label;
  double sign = 1;  ///< -1 shows a compression-negative column positive
};
struct FigureStyle {
  std::string id, title;
  AxisStyle x, y;
  std::string log, caption;
  bool after_first_piece = false;
  std::string run = {};  ///< only this run, with its data; empty: all
};

std::vector<FigureStyle> styles(const ElementTest& test) {
  const std::string flow = "shear strain";
  switch (test.kind) {
    case Kind::simple_shear: {
      std::vector<FigureStyle> list{
          {"stress_strain",
           "Shear stress against shear strain",
           {"shear_strain", flow},
           {"shear_stress", "shear stress"},
           "",
           ""},
          {"peak",
           "The peak, on a logarithmic strain axis",
           {"shear_strain", flow},
           {"shear_stress", "shear stress"},
           "x",
           ""},
          {"stress_path", "Stress path", {"stress_zz", "normal stress", -1}, {"shear_stress", "shear stress"}, "", ""}};
      if (test.columns.excess_pore_pressure) {
        list.push_back({"pore_pressure",
                        "Excess pore pressure",
                        {"shear_strain", flow},
                        {"excess_pore_pressure", "excess pore pressure"},
                        "",
                        "Loss of effective normal stress at constant volume."});
      } else {
        list.push_back({"void_ratio", "Void ratio", {"shear_strain", flow}, {"void_ratio", "void ratio"}, "", ""});
      }
      return list;
    }
    case Kind::annular_shear_cell:
      return {{"shear_stress",
               "Shear stress against shear rate",
               {"shear_rate", "shear rate"},
               {"shear_stress", "shear stress"},
               "xy",
               "The ramp of the shear rate, after the steady state at its first value.",
               true},
              {"normal_stress",
               "Normal stress against shear rate",
               {"shear_rate", "shear rate"},
               {"stress_zz", "normal stress", -1},
               "xy",
               "",
               true},
              {"collisional_share",
               "Share of the pressure carried by collisions",
               {"shear_rate", "shear rate"},
               {"collisional_fraction", "collisional fraction"},
               "x",
               "",
               true},
              {"liquefaction",
               "Loss of the frictional skeleton",
               {"shear_strain", flow},
               {"ln_trace", "ln(|tr| / Pa)"},
               "",
               "Logarithm of the skeleton's stress; it falls without bound where the packing is too loose to keep "
               "contacts."}};
    case Kind::triaxial: {
      const std::string axial = test.axial_sign < 0 ? "axial shortening" : "axial extension";
      std::vector<FigureStyle> list{
          {"stress_strain",
           "Stress difference against axial strain",
           {"axial_strain", axial, test.axial_sign},
           {"q", "q"},
           "",
           ""},
          {"stress_path", "Effective stress path", {"pressure", "mean effective pressure"}, {"q", "q"}, "", ""}};
      if (test.columns.excess_pore_pressure) {
        list.push_back({"pore_pressure",
                        "Excess pore pressure",
                        {"axial_strain", axial, test.axial_sign},
                        {"excess_pore_pressure", "excess pore pressure"},
                        "",
                        ""});
      } else {
        list.push_back({"volumetric_strain",
                        "Volume change",
                        {"axial_strain", axial, test.axial_sign},
                        {"volumetric_strain", "volumetric strain (contraction positive)", -1},
                        "",
                        ""});
        list.push_back({"void_ratio",
                        "Void ratio",
                        {"axial_strain", axial, test.axial_sign},
                        {"void_ratio", "void ratio"},
                        "",
                        ""});
      }
      return list;
    }
    case Kind::pure_rotation:
      return {{"stress_xx", "Horizontal stress", {"revolutions", "revolutions"}, {"stress_xx", "stress xx"}, "", ""},
              {"stress_xz",
               "Shear stress",
               {"revolutions", "revolutions"},
               {"stress_xz", "stress xz"},
               "",
               "A rigid rotation turns the stress and changes nothing else."}};
    case Kind::point:
      return {};
  }
  return {};
}

/// Scale and unit that read well for values of a column over all runs.
std::pair<double, std::string> readable_unit(const std::string& unit, const AxisStyle& style,
                                             const std::vector<RunRecord>& records, const auto& wanted) {
  double most = 0;
  for (const auto& r : records) {
    if (!wanted(r)) continue;
    for (const double v : r.series(style.column)) {
      if (std::isfinite(v)) most = std::max(most, std::abs(v));
    }
  }
  if (unit == "Pa" && most >= 2e3) return {1e-3 * style.sign, "kPa"};
  if ((style.column == "axial_strain" || style.column == "volumetric_strain") && unit == "-")
    return {100 * style.sign, "%"};
  return {style.sign, unit};
}

}  // namespace

namespace {

/// A specimen's name says enough; a parameter needs its key.
std::string short_name(const std::string& run) { return run.rfind("specimen=", 0) == 0 ? run.substr(9) : run; }

Json drawn(const FigureStyle& style, const ElementFile& file, const std::vector<RunRecord>& records,
           const std::vector<ComparisonResult>& comparisons, const std::vector<std::string>& comparison_files) {
  const RunRecord& first = records.front();
  const int cx = first.column(style.x.column), cy = first.column(style.y.column);
  if (cx < 0 || cy < 0) return nullptr;
  const auto& x = first.columns[std::size_t(cx)];
  const auto& y = first.columns[std::size_t(cy)];
  const auto only = [&](const RunRecord& r) { return style.run.empty() || r.name == style.run; };
  const auto [sx, ux] = readable_unit(x.unit, style.x, records, only);
  const auto [sy, uy] = readable_unit(y.unit, style.y, records, only);
  Json series = Json::array();
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (!only(records[r]) || records[r].column(style.y.column) < 0 || records[r].rows() == 0) continue;
    const std::string label = !style.run.empty()         ? "computed"
                              : records[r].name == "run" ? file.kind
                                                         : short_name(records[r].name);
    Json s{{"csv", file_stem(records[r].name) + ".csv"}, {"label", label}, {"color", r}};
    if (style.after_first_piece && !file.tests[r].control.rate.pieces.empty()) {
      const double begin = file.tests[r].control.rate.pieces.front().over;
      const auto times = records[r].series("time");
      const auto from = std::find_if(times.begin(), times.end(), [&](double t) { return t >= begin; }) - times.begin();
      if (std::size_t(from) < times.size()) s["from_row"] = from;
    }
    series.push_back(std::move(s));
  }
  std::set<std::string> labelled;
  for (std::size_t k = 0; k < comparisons.size(); ++k) {
    const auto& c = comparisons[k].comparison;
    if (c.x.run != style.x.column || c.y.run != style.y.column) continue;
    if (!style.run.empty() && c.run != style.run) continue;
    const auto owner =
        std::find_if(records.begin(), records.end(), [&](const auto& r) { return r.name == c.run; }) - records.begin();
    series.push_back(
        {{"csv", comparison_files[k]},
         {"x", 1},
         {"y", 2},
         {"label", labelled.insert(c.label).second ? c.label : ""},  // one entry: the colours tell the runs
         {"points", true},
         {"color", owner}});
  }
  return {{"id", style.id},
          {"title", style.title},
          {"x", {{"column", x.header()}, {"label", style.x.label}, {"unit", ux}, {"scale", sx}}},
          {"y", {{"column", y.header()}, {"label", style.y.label}, {"unit", uy}, {"scale", sy}}},
          {"log", style.log},
          {"series", series},
          {"caption", style.caption}};
}

}  // namespace

Json figures(const ElementFile& file, const std::vector<RunRecord>& records,
             const std::vector<ComparisonResult>& comparisons, const std::vector<std::string>& comparison_files) {
  Json list = Json::array();
  if (records.empty()) return list;
  auto wanted = styles(file.tests.front());
  // tests of very different size hide each other: one more picture for each that has data beside it
  if (records.size() > 1 && !wanted.empty()) {
    const FigureStyle common = wanted.front();
    for (const auto& r : records) {
      const auto has_data = [&](const ComparisonResult& c) {
        return c.comparison.run == r.name && c.comparison.role != "model" && c.comparison.x.run == common.x.column &&
               c.comparison.y.run == common.y.column;
      };
      if (std::none_of(comparisons.begin(), comparisons.end(), has_data)) continue;
      FigureStyle own = common;
      own.id += "_" + file_stem(r.name);
      own.title = short_name(r.name);
      own.run = r.name;
      wanted.push_back(std::move(own));
    }
  }
  for (const auto& style : wanted) {
    Json figure = drawn(style, file, records, comparisons, comparison_files);
    if (!figure.is_null()) list.push_back(std::move(figure));
  }
  return list;
}

}  // namespace grainlaw::element
