// SPDX-License-Identifier: BSD-3-Clause
#include "read_material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "rheology/hypoplastic_calibration.hpp"
#include "with_law.hpp"

namespace grainlaw::element {

namespace fs = std::filesystem;
using input::Node;
using input::Reader;

std::vector<fs::path> material_folders(const fs::path& beside) {
  std::vector<fs::path> folders;
  std::error_code none;
  fs::path at = fs::absolute(beside, none);
  folders.push_back(at);
  for (int up = 0; up < 3 && !at.empty(); ++up, at = at.parent_path()) folders.push_back(at / "materials");
  if (const char* data = std::getenv("GRAINLAW_DATA")) folders.push_back(fs::path(data) / "materials");
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  if (!program.empty()) folders.push_back(program.parent_path() / "../share/grainlaw/materials");
  folders.push_back(fs::path(GRAINLAW_DATA_FOLDER) / "materials");
  std::erase_if(folders, [&](const fs::path& p) { return !fs::is_directory(p, none); });
  return folders;
}

std::optional<fs::path> find_material(const std::string& name, const fs::path& beside) {
  std::error_code none;
  if (name.empty() || name.find('/') != std::string::npos) return std::nullopt;
  for (const auto& folder : material_folders(beside)) {
    if (const auto file = folder / (name + ".yaml"); fs::is_regular_file(file, none)) return file;
  }
  return std::nullopt;
}

std::vector<std::string> material_names(const fs::path& beside) {
  std::set<std::string> names;
  std::error_code none;
  for (const auto& folder : material_folders(beside)) {
    if (folder.filename() != "materials") continue;
    for (const auto& entry : fs::directory_iterator(folder, none)) {
      if (entry.path().extension() == ".yaml") names.insert(entry.path().stem().string());
    }
  }
  return {names.begin(), names.end()};
}

namespace {

std::vector<std::string> law_names() {
  std::vector<std::string> names;
  for_each_recipe([&](auto recipe) { names.emplace_back(recipe.name); });
  return names;
}

/// Every parameter that some law has: a named set may serve several laws.
std::vector<std::string> all_parameter_names() {
  std::set<std::string> names;
  for_each_recipe([&]<class R>(R) {
    typename R::Law law{};
    visit_parameters(law, [&](const auto& row, Constant&) { names.emplace(row.name); });
  });
  return {names.begin(), names.end()};
}

std::string describe_row(const auto& row) {
  const std::string range = fmt::format("{} to {}", row.low, row.high);
  return fmt::format("{} [{}]: {}; from {}, for example '{}: {}'", row.name, row.unit, row.meaning, range, row.name,
                     input::example_of(row.unit));
}

struct NamedSet {
  std::string name, title, law, source;
  Node tree;
};

NamedSet read_set(const std::string& name, const input::Mark& mark, const fs::path& beside) {
  const auto file = find_material(name, beside);
  if (!file)
    input::fail(mark, fmt::format("no material is called '{}'", name),
                input::did_you_mean(name, material_names(beside)));
  NamedSet set;
  set.name = name;
  set.tree = input::read_yaml(*file);
  Reader reader(set.tree, "");
  set.title = reader.text_or("title", name);
  set.law = reader.word("law", law_names());
  set.source = reader.text_or("source", "");
  reader.text_or("notes", "");
  Reader parameters = reader.map("parameters");
  parameters.known(all_parameter_names());
  parameters.finish();
  reader.finish();
  return set;
}

void warn_of_the_cone(Material& material) {
  double c1 = 0, c4 = 0, q1 = 1, q2 = 0;
  bool hypoplastic = false;
  for (const auto& p : material.parameters) {
    if (p.name == "c1") c1 = p.value, hypoplastic = true;
    if (p.name == "c4") c4 = p.value;
    if (p.name == "q1") q1 = p.value;
    if (p.name == "q2") q2 = p.value;
  }
  if (!hypoplastic) return;
  // D_c <= 1 bounds I_e from below by a(t), which lies between q1 and q1 + q2
  const double lowest = std::min({1.0, q1, q1 + q2}), guaranteed = guaranteed_I_e(c1, c4);
  if (guaranteed > lowest) {
    material.warnings.push_back(
        fmt::format("principal stresses are guaranteed to stay compressive for I_e >= {:.3g} only, and this "
                    "material reaches I_e = {:.3g} in its densest state; an exact path may leave the cone there",
                    guaranteed, lowest));
  }
}

}  // namespace

Material read_material(Reader reader, const fs::path& beside, std::optional<double> void_ratio,
                       std::optional<double> k_v_of_test) {
  Material material;
  std::optional<NamedSet> set;
  if (const Node* use = reader.find("use")) {
    if (!use->is_scalar() || use->text.empty())
      input::fail(use->mark, fmt::format("material.use is {}", input::describe(*use)),
                  "expected the name of a material");
    set = read_set(use->text, use->mark, beside);
    material.name = set->name;
    material.title = set->title;
    material.source = set->source;
  }
  if (set && !reader.has("law")) {
    reader.known({"law"});
    material.law = set->law;
  } else {
    material.law = reader.word("law", law_names());
  }

  std::optional<Calibration> calibration;
  input::Mark calibration_mark;
  const bool hypoplastic = material.law == "hypoplastic" || material.law == "hypoplastic_bagnold";
  if (hypoplastic) {
    calibration_mark = reader.mark("calibrate");
    if (auto given = reader.maybe_map("calibrate")) {
      calibration = calibrate(given->number("E_over_p", "-", {1, 1e5}), given->number_or("nu", "-", 0, {-0.5, 0.49}),
                              given->number("phi", "rad", {0.05, 1.4}), given->number_or("psi", "rad", 0, {-0.7, 0.7}));
      given->finish();
      if (!calibration->usable) {
        input::fail(
            calibration_mark,
            fmt::format("calibration gives c4 = {:.4g}: the law would have no failure surface", calibration->c4),
            "lower nu (0 is the usual choice), phi or psi");
      }
    }
  }

  std::optional<Reader> named;
  if (set) named.emplace(*set->tree.find("parameters"), "parameters");
  with_recipe(material.law, [&]<class R>(R) {
    typename R::Law law{};
    visit_parameters(law, [&](const auto& row, Constant&) {
      const std::string name(row.name), unit(row.unit);
      const input::Range range{.low = row.low, .high = row.high};
      ParameterValue value{name, unit, std::string(row.meaning), 0, ""};
      const bool calibrated = calibration && name.size() == 2 && name[0] == 'c' && name[1] >= '1' && name[1] <= '4';
      if (calibrated) {
        if (reader.has(name)) reader.inert(name, "calibrate: gives c1 to c4");
        value.value =
            std::array{calibration->c1, calibration->c2, calibration->c3, calibration->c4}[std::size_t(name[1] - '1')];
        value.source = "calibrated from E/p, nu, phi, psi";
      } else if (name == "k_v" && k_v_of_test) {
        if (reader.has(name)) reader.inert(name, "test.k_v gives it");
        value.value = *k_v_of_test;
        value.source = "given by the test";
      } else if (const Node* node = reader.find(name)) {
        if (name == "k_v" && node->is_map()) {
          Reader formula(*node, reader.path(name));
          const double A = formula.number_or("A", "-", 0.016, input::positive),
                       C_max = formula.number_or("C_max", "-", 0.61, {0.1, 0.75});
          const double rho_s = formula.number("rho_s", "kg/m^3", input::positive),
                       d = formula.number("d", "m", input::positive);
          formula.finish();
          if (!void_ratio)
            input::fail(node->mark, "k_v by Bagnold's formula needs the void ratio of the test",
                        "give initial.void_ratio or solid_fraction");
          value.value = bagnold_coefficient(A, rho_s, d, 1 / (1 + *void_ratio), C_max);
          if (!(value.value <= row.high)) {
            input::fail(node->mark,
                        fmt::format("the solid fraction {:.4g} is not below C_max = {:.4g}: Bagnold's spacing vanishes",
                                    1 / (1 + *void_ratio), C_max),
                        "raise C_max or the void ratio");
          }
          value.source = fmt::format("Bagnold's formula, A = {}, C_max = {}", A, C_max);
        } else {
          value.value = input::quantity(*node, reader.path(name), unit, range);
          value.source = "given here";
        }
      } else if (named && named->has(name)) {
        value.value = named->number(name, unit, range);
        value.source = set->source.empty() ? set->name : set->source;
      } else if (!std::isnan(row.fallback)) {
        value.value = row.fallback;
        value.source = "default";
      } else {
        input::fail(reader.node().mark, fmt::format("{} is missing for law '{}'", reader.path(name), material.law),
                    describe_row(row));
      }
      material.parameters.push_back(std::move(value));
    });
  });
  reader.finish();
  warn_of_the_cone(material);
  return material;
}

Material read_named_material(const std::string& name, const fs::path& beside) {
  const auto file = find_material(name, beside);
  if (!file)
    throw input::InputError(fmt::format("error: no material is called '{}'\n  = {}\n", name,
                                        input::did_you_mean(name, material_names(beside))));
  const Node tree = input::read_yaml(*file);
  Reader reader(tree, "");
  Material material;
  material.name = name;
  material.title = reader.text_or("title", name);
  material.law = reader.word("law", law_names());
  material.source = reader.text_or("source", "");
  const std::string notes = reader.text_or("notes", "");
  Reader parameters = reader.map("parameters");
  with_recipe(material.law, [&]<class R>(R) {
    typename R::Law law{};
    visit_parameters(law, [&](const auto& row, Constant&) {
      const std::string key(row.name);
      if (parameters.has(key)) {
        material.parameters.push_back({key, std::string(row.unit), std::string(row.meaning),
                                       parameters.number(key, row.unit, {.low = row.low, .high = row.high}), name});
      } else if (!std::isnan(row.fallback)) {
        material.parameters.push_back({key, std::string(row.unit), std::string(row.meaning), row.fallback, "default"});
      }
    });
  });
  parameters.known(all_parameter_names());
  parameters.finish();
  reader.finish();
  warn_of_the_cone(material);
  if (!notes.empty()) material.warnings.insert(material.warnings.begin(), notes);
  return material;
}

}  // namespace grainlaw::element
