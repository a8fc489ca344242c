// SPDX-License-Identifier: BSD-3-Clause
#include "read_element.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../input/reader.hpp"
#include "read_integration.hpp"
#include "read_material.hpp"
#include "read_results.hpp"
#include "sweep.hpp"
#include "with_law.hpp"

namespace grainlaw::element {

namespace fs = std::filesystem;
using input::Node;
using input::Reader;

namespace {

struct KindName {
  Kind kind;
  std::string name;
};
const std::vector<KindName> kinds{{Kind::simple_shear, "simple_shear"},
                                  {Kind::annular_shear_cell, "annular_shear_cell"},
                                  {Kind::triaxial, "triaxial"},
                                  {Kind::pure_rotation, "pure_rotation"},
                                  {Kind::point, "point"}};

const std::vector<std::string> later_kinds{"biaxial",   "oedometer",      "isotropic",
                                           "programme", "infinite_slope", "wellposedness"};

Kind read_kind(Reader& test, std::string& name) {
  std::vector<std::string> names;
  for (const auto& k : kinds) names.push_back(k.name);
  const Node* kind = test.find("kind");
  if (kind && std::find(later_kinds.begin(), later_kinds.end(), kind->text) != later_kinds.end()) {
    input::fail(kind->mark, fmt::format("test.kind = '{}' is not available in this version", kind->text),
                "available: " + input::join(names));
  }
  name = test.word("kind", names);
  return std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.name == name; })->kind;
}

class TestReader {
 public:
  TestReader(ElementTest& t, Reader r, std::string law_name, Defaults& d)
      : test(t), reader(std::move(r)), law(std::move(law_name)), needs(needs_of(law)), defaults(d) {}

  void read_void_ratio(const Node& material) {
    // in the annular cell and at a point it stands beside the kind, elsewhere under `initial`
    const bool beside = test.kind == Kind::annular_shear_cell || test.kind == Kind::point;
    std::optional<double> value;
    const auto look = [&](Reader& r) {
      if (const auto e = r.maybe_number("void_ratio", "-", {.low = 0, .high = 20, .low_open = true})) {
        if (value) r.inert("void_ratio", "the void ratio is already given");
        value = e;
      }
      if (const auto C =
              r.maybe_number("solid_fraction", "-", {.low = 0, .high = 1, .low_open = true, .high_open = true})) {
        if (value) r.inert("solid_fraction", "the void ratio is already given");
        value = 1 / *C - 1;
      }
    };
    if (beside) look(reader);
    if (reader.has("initial")) {
      Reader initial = reader.map("initial");
      look(initial);
    }
    const Node* k_v = material.find("k_v");
    const bool by_formula = k_v && k_v->is_map();  // Bagnold's formula needs the spacing of the grains
    if (!value && (needs.void_ratio || by_formula)) {
      if (!beside)
        reader.need("initial", "the state before loading, for example 'initial: {pressure: 100 kPa, void_ratio: 0.8}'");
      Reader place = beside ? reader : reader.map("initial");
      place.known({"pressure", "stress"});
      place.missing("void_ratio",
                    fmt::format("'{}' is missing: {} depends on the void ratio", place.path("void_ratio"),
                                needs.void_ratio ? fmt::format("law '{}'", law) : "Bagnold's formula for k_v"),
                    "give void_ratio [-] or solid_fraction [-], for example 'void_ratio: 0.845'");
    }
    if (value && !needs.void_ratio && !by_formula && !beside) {
      Reader place = reader.map("initial");
      place.inert(place.has("void_ratio") ? "void_ratio" : "solid_fraction",
                  fmt::format("law '{}' does not depend on the density", law));
    }
    test.void_ratio = value;
  }

  std::optional<double> read_k_v() {
    if (test.kind != Kind::annular_shear_cell) return std::nullopt;
    const auto k_v = reader.maybe_number("k_v", "kg/m", input::not_negative);
    if (k_v && law != "bagnold" && law != "hypoplastic_bagnold")
      reader.inert("k_v", fmt::format("law '{}' has no collisional part", law));
    return k_v;
  }

  void read() {
    switch (test.kind) {
      case Kind::simple_shear:
        simple_shear();
        break;
      case Kind::annular_shear_cell:
        annular_shear_cell();
        break;
      case Kind::triaxial:
        triaxial();
        break;
      case Kind::pure_rotation:
        pure_rotation();
        break;
      case Kind::point:
        point();
        break;
    }
    if (const Node* specimen = reader.find("specimen")) {
      if (!specimen->is_scalar())
        input::fail(specimen->mark, "test.specimen must be a name", "for example 'specimen: TMU1'");
      test.notes.push_back("specimen " + specimen->text);
    }
  }

  Reader& raw() { return reader; }

 private:
  SymTensor<double> read_stress(Reader map) {
    SymTensor<double> s{};
    if (map.node().entries.empty())
      input::fail(map.node().mark, map.path() + " is empty",
                  "for example 'stress: {xx: -100 kPa, yy: -100 kPa, "
                  "zz: -100 kPa}'");
    const auto component = [&](const char* key, double& value, bool normal) {
      // a granular law has no use for a normal stress of zero: it was forgotten
      value = normal && law != "elastic" ? map.number(key, "Pa") : map.number_or(key, "Pa", 0);
    };
    component("xx", s.xx, true), component("yy", s.yy, true), component("zz", s.zz, true);
    component("yz", s.yz, false), component("xz", s.xz, false), component("xy", s.xy, false);
    map.finish();
    return s;
  }

  /// `pressure` or `stress` of one map; a law without history starts from the compaction that belongs to it.
  void read_stress_of(Reader& map) {
    if (!needs.stress) {
      if (test.kind == Kind::annular_shear_cell) map.known({"pressure", "stress"});
      if (!map.has("pressure") && !map.has("stress")) {
        map.known({"pressure", "stress"});
        test.compaction = map.number_or("compaction", "-", 0, {.low = -1, .high = 1e3, .low_open = true});
        return;
      }
      map.inert("compaction", "the pressure gives it");
      const input::Mark mark = map.mark(map.has("stress") ? "stress" : "pressure");
      const SymTensor<double> sigma =
          map.has("stress") ? read_stress(map.map("stress")) : isotropic(-map.number("pressure", "Pa"));
      compact_to(sigma, mark);
      return;
    }
    map.inert("compaction", fmt::format("law '{}' carries its stress: give pressure or stress", law));
    if (map.has("stress")) {
      map.inert("pressure", "stress gives every component");
      test.initial_stress = read_stress(map.map("stress"));
    } else {
      const double p = map.number("pressure", "Pa", law == "elastic" ? input::Range{} : input::positive);
      test.initial_stress = isotropic(-p);
    }
  }

  /// The compaction at which a law without history has this stress at rest.
  void compact_to(const SymTensor<double>& sigma, const input::Mark& mark) {
    const double p = pressure(sigma);
    bool possible = p == 0;
    with_law(test.material, 0, StateForm::stress, [&](const auto& chosen, const auto&) {
      if constexpr (requires { chosen.compaction_at(p); }) {
        test.compaction = chosen.compaction_at(p);
        possible = std::isfinite(test.compaction) && test.compaction > -1;
      }
    });
    if (!possible && test.kind != Kind::annular_shear_cell) {
      input::fail(mark, fmt::format("law '{}' has no stress at rest that would be {} Pa", law, p),
                  "its stress follows from the rate alone: leave it out");
    }
    if (von_mises(sigma) > 1e-12 * std::abs(p)) {
      input::fail(mark, fmt::format("law '{}' is a fluid: at rest it carries no shear stress", law),
                  "give an isotropic stress or a pressure");
    }
  }

  void read_initial() {
    if (law == "elastic" && !reader.has("initial")) return;  // from zero stress
    if (!reader.has("initial") && !needs.stress) {
      reader.known({"initial"});
      return;
    }
    const Node& node = reader.need(
        "initial", needs.stress
                       ? "the state before loading, for example 'initial: {pressure: 100 kPa, void_ratio: 0.8}'"
                       : "the state before loading, for example 'initial: {compaction: 0}'");
    Reader initial(node, reader.path("initial"));
    initial.find("void_ratio"), initial.find("solid_fraction");  // read before
    read_stress_of(initial);
    initial.finish();
    check_start(node.mark);
  }

  /// The law must be able to live with the initial state.
  void check_start(const input::Mark& mark) {
    if (!needs.stress) return;
    Material probe = test.material;
    with_law(probe, test.void_ratio.value_or(0), StateForm::stress, [&](const auto& chosen, const auto&) {
      using L = std::decay_t<decltype(chosen)>;
      if constexpr (StressInState<L>) {
        const Flow<double> flow{{}, 0};
        const auto reasons = chosen.admit(flow, chosen.start(flow, test.initial_stress)).reasons;
        if ((reasons & tension) != 0) {
          input::fail(mark, "the initial stress has a principal component that is not compressive",
                      fmt::format("law '{}' needs compressive principal stresses; stresses are tension positive, so "
                                  "compression is negative",
                                  law));
        }
        if ((reasons & pressure_floor) != 0)
          input::fail(mark, "the initial pressure is below p_floor of the material",
                      "raise the pressure or lower p_floor");
        if ((reasons & beyond_validity) != 0) {
          test.warnings.push_back(
              fmt::format("the initial state lies outside the range of law '{}' ({}): its density function is clamped",
                          law, L::valid));
        }
      }
    });
  }

  RateProgramme read_rate(const char* key, const char* unit, double factor, const char* what) {
    const Node& node = reader.need(key, what);
    if (!node.is_sequence()) {
      const double value = input::quantity(node, reader.path(key), unit) * factor;
      if (value == 0)
        input::fail(node.mark, fmt::format("{} is zero: nothing would happen", reader.path(key)),
                    "give a rate different from zero");
      return RateProgramme::constant(value);
    }
    RateProgramme programme;
    std::size_t i = 0;
    for (const Node& item : node.items) {
      Reader piece(item, fmt::format("{}.{}", reader.path(key), i++));
      programme.pieces.push_back({piece.number("from", unit) * factor, piece.number("to", unit) * factor,
                                  piece.number("over", "s", input::positive)});
      piece.finish();
    }
    if (programme.pieces.empty())
      input::fail(node.mark, fmt::format("{} is an empty list", reader.path(key)), "give at least {from, to, over}");
    if (programme.largest() == 0)
      input::fail(node.mark, fmt::format("{} is zero throughout: nothing would happen", reader.path(key)),
                  "give a rate different from zero");
    return programme;
  }

  void simple_shear() {
    const std::string hold = reader.word_or("hold", {"volume", "normal_stress"}, "volume");
    if (!reader.has("hold")) defaults.add("test.hold", "volume");
    read_initial();
    test.control.rate = read_rate(
        "shear_rate", "1/s", 1, "dv_x/dz, for example 'shear_rate: 0.01 1/s' or [{from: 0 1/s, to: 1 1/s, over: 2 s}]");
    test.control.pattern.xz = 1;
    test.columns.shear_strain = test.columns.shear_rate = true;
    if (hold == "normal_stress") {
      double normal = -test.initial_stress.zz;
      if (needs.stress) {
        normal = reader.number_or("normal_stress", "Pa", normal, input::positive);
        if (std::abs(normal + test.initial_stress.zz) > 1e-9 * normal) {
          input::fail(reader.mark("normal_stress"),
                      fmt::format("test.normal_stress is {} Pa but the initial vertical stress is {} Pa: the test "
                                  "would start with a jump",
                                  normal, -test.initial_stress.zz),
                      "make them equal, or leave normal_stress out: it is held at its initial value");
        }
      } else {
        normal = reader.number("normal_stress", "Pa", input::positive);
        if (!reader.has("initial")) compact_to(isotropic(-normal), reader.mark("normal_stress"));
      }
      test.control.held = {2};
      test.control.held_stress.zz = -normal;
      test.columns.volumetric = true;
    } else {
      reader.inert("normal_stress", "hold: volume keeps the volume, not the stress");
      test.columns.excess_pore_pressure = needs.stress;
    }
    test.main_quantity = "shear_stress";
  }

  void annular_shear_cell() {
    reader.inert("shear_rate", "the cell is driven by kappa, with dv_x/dz = 2 kappa");
    read_initial();
    test.control.rate =
        read_rate("kappa", "1/s", 2, "half of dv_x/dz, for example 'kappa: [{from: 10 1/s, to: 500 1/s, over: 20 s}]'");
    test.control.pattern.xz = 1;
    test.columns.shear_strain = test.columns.shear_rate = true;
    test.main_quantity = "shear_stress";
  }

  void triaxial() {
    const std::string drainage = reader.word("drainage", {"drained", "undrained"});
    const std::string mode = reader.word_or("mode", {"compression", "extension"}, "compression");
    if (!reader.has("mode")) defaults.add("test.mode", "compression");
    read_initial();
    test.axial_sign = mode == "compression" ? -1 : 1;
    if (reader.has("cyclic"))
      input::fail(reader.mark("cyclic"), "test.cyclic is not available in this version", "give axial_rate and until");
    const double rate = reader.number("axial_rate", "1/s", input::positive);
    test.control.rate = RateProgramme::constant(rate);
    test.control.pattern.zz = test.axial_sign;
    test.columns.axial = true;
    if (drainage == "undrained") {
      test.control.pattern.xx = test.control.pattern.yy = -0.5 * test.axial_sign;
      test.columns.excess_pore_pressure = needs.stress;
    } else {
      if (!needs.stress) {
        input::fail(
            reader.mark("drainage"),
            fmt::format("a drained test holds the cell pressure, and law '{}' has no stress history to hold it with",
                        law),
            "use drainage: undrained, or a law that carries its stress");
      }
      test.control.held = {0, 1};
      test.control.held_stress = test.initial_stress;
    }
    const auto& s = test.initial_stress;
    if (s.yz != 0 || s.xz != 0 || s.xy != 0 || s.xx != s.yy) {
      input::fail(reader.mark("initial"), "the initial stress is not axisymmetric",
                  "a triaxial test has stress xx = yy and no shear components");
    }
    test.main_quantity = "q";
  }

  void pure_rotation() {
    read_initial();
    const double spin = reader.number("spin", "rad/s");
    if (spin == 0)
      input::fail(reader.mark("spin"), "test.spin is zero: nothing would turn", "for example 'spin: 1 rad/s'");
    const double revolutions = reader.number("revolutions", "-", {.low = 0, .high = 1e7, .low_open = true});
    test.control.rate = RateProgramme::constant(spin);
    test.control.pattern.xz = 1;
    test.control.pattern.zx = -1;
    test.columns.spin = true;
    test.until.time = 2 * std::numbers::pi * revolutions / std::abs(spin);
    test.main_quantity = "q";
  }

  void point() {
    const Node& node =
        reader.need("L", "velocity gradient by rows, for example 'L: [[0, 0, 1], [0, 0, 0], [0, 0, 0]] 1/s'");
    const auto wrong = [&](const Node& at) {
      input::fail(at.mark, "test.L is not a 3 by 3 matrix",
                  "three rows of three rates [1/s]: L: [[0, 0, 1], [0, 0, 0], [0, 0, 0]] 1/s");
    };
    if (!node.is_sequence() || node.items.size() != 3) wrong(node);
    std::array<double, 9> l{};
    for (std::size_t r = 0; r < 3; ++r) {
      if (!node.items[r].is_sequence() || node.items[r].items.size() != 3) wrong(node.items[r]);
      for (std::size_t c = 0; c < 3; ++c) {
        l[3 * r + c] = input::quantity(node.items[r].items[c], fmt::format("test.L[{}][{}]", r + 1, c + 1), "1/s");
      }
    }
    test.control.pattern = {l[0], l[1], l[2], l[3], l[4], l[5], l[6], l[7], l[8]};
    test.control.rate = RateProgramme::constant(1);
    reader.inert("density",
                 fmt::format("law '{}' has no density of its own: give stress, void_ratio or compaction", law));
    if (reader.has("initial")) {
      read_initial();
    } else if (law == "elastic" && !reader.has("stress") && !reader.has("pressure")) {
      reader.known({"stress", "pressure"});  // zero
    } else {
      read_stress_of(reader);
      check_start(reader.node().mark);
    }
  }

  ElementTest& test;
  Reader reader;
  std::string law;
  LawNeeds needs;
  Defaults& defaults;
};

ElementTest read_run(const SingleRun& single, const fs::path& beside, bool mixed, Defaults& defaults) {
  ElementTest test;
  test.run = single.name;
  Reader root(single.tree, "");
  for (const char* key : {"title", "source", "sweep", "compare", "expect"}) root.find(key);
  const Node& material_node =
      root.need("material", "the law and its parameters, for example 'material: {use: peng2016_table1}'");
  const Node& test_node = root.need("test", "what is done to the point, for example 'test: {kind: simple_shear, ...}'");

  Reader raw_test(test_node, "test");
  test.kind = read_kind(raw_test, test.kind_name);
  Reader material(material_node, "material");
  const MaterialChoice choice = choose_material(material, beside);
  TestReader reader(test, raw_test, choice.law, defaults);
  reader.read_void_ratio(material_node);
  const auto k_v = reader.read_k_v();
  test.material = read_material(material, choice, test.void_ratio, k_v);
  reader.read();

  const Node* output = root.find("output");
  const Node* integrator = root.find("integrator");
  if (test.kind == Kind::point) {
    reader.raw().finish();
    if (output) root.inert("output", "a point test has one row");
    if (integrator) root.inert("integrator", "a point test integrates nothing");
    test.integration.form = StateForm::stress;
    test.row_times = {0};
  } else {
    read_until(test, reader.raw(), defaults);
    reader.raw().finish();
    read_integrator(test, integrator, mixed, defaults);
    read_output(test, output, defaults);
  }
  root.finish();
  if (test.void_ratio) {
    for (const auto& p : test.material.parameters) {
      if (p.name == "e_min" && *test.void_ratio < p.value) {
        test.warnings.push_back(
            fmt::format("void ratio {:.4g} is below e_min = {:.4g}: the law is clamped to its densest state",
                        *test.void_ratio, p.value));
      }
    }
  }
  for (const auto& w : test.material.warnings) test.warnings.push_back(w);
  return test;
}

/// Writes a value where the file has none; a key inside something else than a map is left alone.
void fill_in(Node& root, const std::string& path, const std::string& text) {
  Node* at = &root;
  for (std::size_t from = 0; from <= path.size();) {
    const auto dot = std::min(path.find('.', from), path.size());
    const std::string key = path.substr(from, dot - from);
    if (!at->is_map()) return;
    if (!at->find(key)) {
      at->entries.push_back({key, {}, {}});
      at->entries.back().value.kind = Node::Kind::map;
    }
    at = at->find(key);
    from = dot + 1;
  }
  if (at->is_map() && at->entries.empty()) *at = input::scalar(text);
}

/// The file as understood: the material spelled out, defaults filled in. Lists stay lists, so the runs keep their
/// names.
Node understood(const Node& file, const ElementTest& first, const Defaults& defaults) {
  Node tree = file;
  Node& material = *tree.find("material");
  const auto has_list = [&](const char* key) {
    const Node* node = material.find(key);
    return node && node->is_sequence();
  };
  if (!has_list("use") && !has_list("law")) {  // one law for all runs
    if (material.find("use")) {
      std::erase_if(material.entries, [](const auto& e) { return e.key == "use"; });
      material.entries.insert(material.entries.begin(), {"name", {}, input::scalar(first.material.name)});
    }
    if (!material.find("law"))
      material.entries.insert(material.entries.begin(), {"law", {}, input::scalar(first.material.law)});
    const bool k_v_of_test = tree.find("test")->find("k_v") != nullptr;
    for (const auto& p : first.material.parameters) {
      const bool calibrated = p.source.starts_with("calibrated");
      if (material.find(p.name) || calibrated || (p.name == "k_v" && k_v_of_test)) continue;
      const std::string unit = p.unit == "-" ? "" : " " + p.unit;
      material.entries.push_back({p.name, {}, input::scalar(fmt::format("{}{}", p.value, unit))});
    }
  }
  for (const auto& [path, text] : defaults.list) fill_in(tree, path, text);
  return tree;
}

}  // namespace

ElementFile read_element(const fs::path& path, const std::vector<std::string>& sets) {
  Node tree = input::read_yaml(path);
  for (const auto& assignment : sets) input::apply_set(tree, assignment);
  if (!tree.is_map())
    input::fail(tree.mark, "this is not an element test", "expected a map with title, material, test ...");
  const fs::path beside = fs::absolute(path).parent_path();

  ElementFile file;
  file.path = path;
  Defaults defaults;
  const auto runs = expand(tree);
  for (const auto& single : runs) {
    Defaults own;
    file.tests.push_back(read_run(single, beside, mixed_methods(tree), own));
    // a default of one run may be inert in another: only what holds for all is written into the file
    if (file.tests.size() == 1) {
      defaults = own;
    } else {
      std::erase_if(defaults.list,
                    [&](const auto& d) { return std::find(own.list.begin(), own.list.end(), d) == own.list.end(); });
    }
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    read_results(runs[i], file.tests[i], beside, runs, file);
  }
  Reader root(tree, "");
  file.title = root.text_or("title", path.stem().string());
  if (!root.has("title")) defaults.list.insert(defaults.list.begin(), {"title", file.title});
  file.source = root.text_or("source", "");
  file.kind = file.tests.front().kind_name;
  for (const auto& test : file.tests) {
    for (const auto& w : test.warnings) {
      const std::string line =
          file.tests.size() == 1 || test.material.warnings.end() !=
                                        std::find(test.material.warnings.begin(), test.material.warnings.end(), w)
              ? w
              : fmt::format("{}: {}", test.run, w);
      if (std::find(file.warnings.begin(), file.warnings.end(), line) == file.warnings.end())
        file.warnings.push_back(line);
    }
  }
  file.as_run = understood(tree, file.tests.front(), defaults);
  return file;
}

}  // namespace grainlaw::element
