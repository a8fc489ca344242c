// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <numbers>

#include "../element/read_material.hpp"
#include "../element/with_law.hpp"
#include "../input/source.hpp"
#include "commands.hpp"
#include "rheology/hypoplastic_calibration.hpp"

namespace grainlaw::commands {

using namespace element;

namespace {

std::string number(double v) { return std::isinf(v) ? (v < 0 ? "-inf" : "inf") : fmt::format("{:g}", v); }

template <class R>
void show(R, bool markdown) {
  typename R::Law law{};
  if (markdown) {
    fmt::print(
        "## {}\n\n{}. Valid for {}.\n\n| parameter | unit | meaning | range | default |\n|---|---|---|---|---|\n",
        R::name, R::Law::source, R::Law::valid);
  } else {
    fmt::print("{}\n  source: {}\n  valid:  {}\n  state:  {}\n  parameters:\n", R::name, R::Law::source, R::Law::valid,
               StressInState<typename R::Law>
                   ? (std::tuple_size_v<typename R::Forms> > 1 ? "stress, or its logarithmic form" : "stress")
                   : "none");
  }
  visit_parameters(law, [&](const auto& row, Constant&) {
    const std::string fallback = std::isnan(row.fallback) ? "required" : number(row.fallback);
    const std::string range = fmt::format("{} to {}", number(row.low), number(row.high));
    if (markdown) {
      fmt::print("| `{}` | {} | {} | {} | {} |\n", row.name, row.unit, row.meaning, range, fallback);
    } else {
      fmt::print("    {:<9} [{}]  {}  ({}, {})\n", row.name, row.unit, row.meaning, range, fallback);
    }
  });
  if (uses_void_ratio<typename R::Law>())
    fmt::print("{}", markdown ? "\nNeeds the initial `void_ratio`.\n" : "  needs the initial void_ratio\n");
  fmt::print("\n");
}

/// Where the law can flow for ever: what an engineer checks first.
void show_critical_states(const Material& material) {
  const auto law = build_law<Hypoplastic<>>(material, 1.0);
  fmt::print("  critical states (isochoric, stress direction constant):\n");
  fmt::print("    mode                    I*        ratio     angle [deg]  void ratio at p = 0\n");
  struct Mode {
    const char* name;
    Tensor<double> L;
  };
  for (const auto& mode :
       {Mode{"simple shear", simple_shear_flow}, Mode{"triaxial compression", triaxial_compression_flow},
        Mode{"triaxial extension", triaxial_extension_flow}}) {
    const auto s = stationary_state(law, mode.L);
    if (!s.found) {
      fmt::print("    {:<22}  none\n", mode.name);
      continue;
    }
    const bool shear = mode.L.xz != 0;
    const double high = std::max(s.r.zz, s.r.xx), low = std::min(s.r.zz, s.r.xx);
    const double ratio = shear ? -s.r.xz / s.r.zz : high / low;
    const double angle = shear ? std::atan(ratio) : std::asin((high - low) / (high + low));
    const double threshold = critical_void_ratio(law.critical, s.I_star, 0);
    fmt::print("    {:<22}  {:.6f}  {:.6f}  {:.4f}      {:.6f}{}\n", mode.name, s.I_star, ratio,
               angle * 180 / std::numbers::pi, threshold,
               threshold < law.critical.e_min.value ? "  (below e_min: every state liquefies)" : "");
  }
  fmt::print(
      "    (ratio: shear over normal stress, or larger over smaller principal stress; above the void ratio at p = 0\n"
      "     an undrained test in that mode liquefies completely)\n");
}

}  // namespace

int laws(const std::string& name, bool markdown) {
  if (!name.empty()) {
    if (with_recipe(name, [&](auto recipe) { show(recipe, markdown); })) return done;
    std::vector<std::string> names;
    for_each_recipe([&](auto recipe) { names.emplace_back(recipe.name); });
    throw input::InputError(
        fmt::format("error: no law is called '{}'\n  = {}\n", name, input::did_you_mean(name, names)));
  }
  for_each_recipe([&](auto recipe) { show(recipe, markdown); });
  return done;
}

int materials(const std::string& name) {
  const auto here = std::filesystem::current_path();
  if (name.empty()) {
    for (const auto& each : material_names(here)) {
      const auto material = read_named_material(each, here);
      fmt::print("{:<24} {:<20} {}\n", each, material.law, material.title);
    }
    return done;
  }
  const Material material = read_named_material(name, here);
  fmt::print("{}\n  {}\n  law:    {}\n  source: {}\n  parameters:\n", material.name, material.title, material.law,
             material.source);
  for (const auto& p : material.parameters) {
    fmt::print("    {:<9} {} {}  ({}{})\n", p.name, p.value, p.unit == "-" ? "" : p.unit, p.meaning,
               p.source == "default" ? ", default" : "");
  }
  if (material.law.rfind("hypoplastic", 0) == 0) show_critical_states(material);
  for (const auto& w : material.warnings) fmt::print("  note: {}\n", w);
  return done;
}

}  // namespace grainlaw::commands
