// SPDX-License-Identifier: BSD-3-Clause
#include "read_material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
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
    const fs::path file = folder / (name + ".yaml");
    if (!fs::is_regular_file(file, none)) continue;
    // beside a test stand tests, one of which may well bear the name of its material
    if (folder.filename() != "materials" && input::read_yaml(file).find("test")) continue;
    return file;
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

/// Every parameter that some law has, with the laws that have it: a named set may serve several laws.
std::map<std::string, std::vector<std::string>> laws_by_parameter() {
  std::map<std::string, std::vector<std::string>> laws;
  for_each_recipe([&]<class R>(R) {
    typename R::Law law{};
    visit_parameters(law, [&](const auto& row, Constant&) { laws[std::string(row.name)].emplace_back(R::name); });
  });
  return laws;
}

std::string describe_row(const auto& row) {
  const std::string range = fmt::format("{} to {}", row.low, row.high);
  return fmt::format("{} [{}]: {}; from {}, for example '{}: {}'", row.name, row.unit, row.meaning, range, row.name,
                     input::example_of(row.unit));
}

[[noreturn]] void fail_name(const std::string& name, const input::Mark& mark, const fs::path& beside) {
  input::fail(mark, fmt::format("no material is called '{}'", name), input::did_you_mean(name, material_names(beside)));
}

NamedSet read_set(const std::string& name, const fs::path& file) {
  NamedSet set;
  set.name = name;
  set.tree = input::read_yaml(file);
  Reader reader(set.tree, "");
  set.title = reader.text_or("title", name);
  set.law = reader.word("law", law_names());
  set.source = reader.text_or("source", "");
  set.notes = reader.text_or("notes", "");
  Reader parameters = reader.map("parameters");
  for (const auto& [parameter, laws] : laws_by_parameter()) parameters.known({parameter});
  parameters.finish();
  reader.finish();
  return set;
}

/// What a parameter is when the test itself does not give it: the named set's value or the law's default.
std::optional<ParameterValue> value_of_set(const auto& row, const NamedSet* set) {
  ParameterValue value{std::string(row.name), std::string(row.unit), std::string(row.meaning), row.fallback, "default"};
  if (set) {
    Reader parameters(*set->tree.find("parameters"), "parameters");
    if (const auto given = parameters.maybe_number(row.name, row.unit, {.low = row.low, .high = row.high})) {
      value.value = *given;
      value.source = set->name;
      return value;
    }
  }
  if (std::isnan(row.fallback)) return std::nullopt;
  return value;
}

/// k_v: {rho_s, d, A, C_max} at the void ratio of the test.
double bagnold_k_v(Reader formula, std::optional<double> void_ratio, double highest, std::string& source) {
  const double A = formula.number_or("A", "-", 0.016, input::positive),
               C_max = formula.number_or("C_max", "-", 0.61, {0.1, 0.75});
  const double rho_s = formula.number("rho_s", "kg/m^3", input::positive),
               d = formula.number("d", "m", input::positive);
  formula.finish();
  if (!void_ratio) {
    input::fail(formula.node().mark, "k_v by Bagnold's formula needs the void ratio of the test",
                "give void_ratio or solid_fraction");
  }
  const double C = 1 / (1 + *void_ratio), k_v = bagnold_coefficient(A, rho_s, d, C, C_max);
  if (!(k_v <= highest)) {
    input::fail(
        formula.node().mark,
        fmt::format("the solid fraction {:.4g} is not below C_max = {:.4g}: Bagnold's spacing vanishes", C, C_max),
        "raise C_max or the void ratio");
  }
  source = fmt::format("Bagnold's formula, A = {}, C_max = {}", A, C_max);
  return k_v;
}

std::optional<Calibration> read_calibration(Reader& reader, const std::string& law) {
  if (law != "hypoplastic" && law != "hypoplastic_bagnold") {
    reader.inert("calibrate", fmt::format("it gives c1 to c4, which law '{}' does not have", law));
    return std::nullopt;
  }
  auto given = reader.maybe_map("calibrate");
  if (!given) return std::nullopt;
  const auto calibration =
      calibrate(given->number("E_over_p", "-", {1, 1e5}), given->number_or("nu", "-", 0, {-0.5, 0.49}),
                given->number("phi", "rad", {0.05, 1.4}), given->number_or("psi", "rad", 0, {-0.7, 0.7}));
  given->finish();
  if (!calibration.usable) {
    input::fail(reader.mark("calibrate"),
                fmt::format("calibration gives c4 = {:.4g}: the law would have no failure surface", calibration.c4),
                "lower nu (0 is the usual choice), phi or psi");
  }
  return calibration;
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

MaterialChoice choose_material(Reader& reader, const fs::path& beside) {
  MaterialChoice choice;
  if (const Node* use = reader.find("use")) {
    if (!use->is_scalar() || use->text.empty()) {
      input::fail(use->mark, fmt::format("material.use is {}", input::describe(*use)),
                  "expected the name of a material");
    }
    const auto file = find_material(use->text, beside);
    if (!file) fail_name(use->text, use->mark, beside);
    choice.set = read_set(use->text, *file);
    choice.law = reader.word_or("law", law_names(), choice.set->law);
  } else {
    choice.law = reader.word("law", law_names());
  }
  return choice;
}

Material read_material(Reader reader, const MaterialChoice& choice, std::optional<double> void_ratio,
                       std::optional<double> k_v_of_test) {
  Material material;
  material.law = choice.law;
  reader.known({"law", "use"});
  const NamedSet* set = choice.set ? &*choice.set : nullptr;
  if (set) {
    reader.inert("name", "use: names the material");
    material.name = set->name;
    material.title = set->title;
    material.source = set->source;
  } else {
    material.name = reader.text_or("name", "");  // as_run.yaml spells a named material out under its name
  }
  const auto calibration = read_calibration(reader, material.law);

  with_recipe(material.law, [&]<class R>(R) {
    typename R::Law law{};
    visit_parameters(law, [&](const auto& row, Constant&) {
      const std::string name(row.name);
      ParameterValue value{name, std::string(row.unit), std::string(row.meaning), 0, "given here"};
      const bool calibrated = calibration && name.size() == 2 && name[0] == 'c' && name[1] >= '1' && name[1] <= '4';
      if (calibrated) {
        reader.inert(name, "calibrate: gives c1 to c4");
        value.value =
            std::array{calibration->c1, calibration->c2, calibration->c3, calibration->c4}[std::size_t(name[1] - '1')];
        value.source = "calibrated from E/p, nu, phi, psi";
      } else if (name == "k_v" && k_v_of_test) {
        reader.inert(name, "test.k_v gives it");
        value.value = *k_v_of_test;
        value.source = "given by the test";
      } else if (const Node* node = reader.find(name)) {
        if (name == "k_v" && node->is_map()) {
          value.value = bagnold_k_v(Reader(*node, reader.path(name)), void_ratio, row.high, value.source);
        } else {
          value.value = input::quantity(*node, reader.path(name), row.unit, {.low = row.low, .high = row.high});
        }
      } else if (auto otherwise = value_of_set(row, set)) {
        value = std::move(*otherwise);
      } else {
        reader.missing(set || name != "c1" ? name : "use",
                       fmt::format("{} is missing for law '{}'", reader.path(name), material.law), describe_row(row));
      }
      material.parameters.push_back(std::move(value));
    });
  });
  for (const auto& [parameter, laws] : laws_by_parameter()) {
    if (std::find(laws.begin(), laws.end(), material.law) == laws.end())
      reader.inert(parameter,
                   fmt::format("law '{}' has no such parameter; it belongs to {}", material.law, input::join(laws)));
  }
  reader.finish();
  warn_of_the_cone(material);
  return material;
}

Material read_named_material(const std::string& name, const fs::path& beside) {
  const auto file = find_material(name, beside);
  if (!file)
    fail_name(name, {std::make_shared<input::Source>(input::Source{"grainlaw materials", {}}), -1, -1}, beside);
  const NamedSet set = read_set(name, *file);
  Material material;
  material.name = name;
  material.title = set.title;
  material.law = set.law;
  material.source = set.source;
  with_recipe(material.law, [&]<class R>(R) {
    typename R::Law law{};
    visit_parameters(law, [&](const auto& row, Constant&) {
      if (auto value = value_of_set(row, &set)) material.parameters.push_back(std::move(*value));
    });
  });
  warn_of_the_cone(material);
  if (!set.notes.empty()) material.warnings.insert(material.warnings.begin(), set.notes);
  return material;
}

}  // namespace grainlaw::element
