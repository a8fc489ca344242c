// SPDX-License-Identifier: BSD-3-Clause
#include "read_integration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "with_law.hpp"

namespace grainlaw::element {

using input::Node;
using input::Reader;

namespace {

/// Explicit Dormand-Prince while stability costs less than implicit algebra, BDF beyond: with eigenvalues near
/// -1000 |D| an explicit method needs some 600 evaluations per unit of strain, BDF about 1500 altogether.
constexpr double longest_explicit_path = 10;

StateForm form_for(const ElementTest& test, const LawNeeds& needs) {
  const bool compressive = trace(test.initial_stress) < 0;
  return needs.forms && test.control.held.empty() && compressive ? StateForm::logarithmic : StateForm::stress;
}

}  // namespace

LawNeeds needs_of(const std::string& law) {
  LawNeeds needs;
  with_recipe(law, [&]<class R>(R) {
    needs.void_ratio = uses_void_ratio<typename R::Law>();
    needs.stress = StressInState<typename R::Law>;
    needs.forms = std::tuple_size_v<typename R::Forms> > 1;
  });
  return needs;
}

void read_until(ElementTest& test, Reader& reader, Defaults& defaults) {
  const auto& rate = test.control.rate;
  const bool programme = rate.duration() > 0;
  if (test.kind == Kind::pure_rotation) {
    reader.inert("until", "revolutions says when the test ends");
    return;
  }
  double end = std::numeric_limits<double>::infinity();
  if (!reader.has("until")) {
    if (!programme) {
      reader.need("until", test.kind == Kind::triaxial
                               ? "when the test ends, for example 'until: {axial_strain: 0.2}'"
                               : "when the test ends, for example 'until: {shear_strain: 1.0}'");
    }
    reader.known({"until"});
    end = rate.duration();
  } else {
    Reader until = reader.map("until");
    const bool triaxial = test.kind == Kind::triaxial;
    if (const auto t = until.maybe_number("time", "s", input::positive)) end = std::min(end, *t);
    for (const char* key : {"shear_strain", "axial_strain"}) {
      const bool mine = (std::string_view(key) == "axial_strain") == triaxial;
      if (!mine && until.has(key))
        until.inert(key, triaxial ? "a triaxial test counts axial_strain" : "a shear test counts shear_strain");
      if (!mine) continue;
      if (const auto strain = until.maybe_number(key, "-", {.low = 0, .high = 1e9, .low_open = true})) {
        const double t = rate.time_of_path(*strain);
        if (!std::isfinite(t))
          input::fail(until.mark(key),
                      fmt::format("until.{} = {} is never reached: the rate ends at zero", key, *strain),
                      "lengthen the programme");
        end = std::min(end, t);
      }
    }
    test.until.pressure_ratio =
        until.maybe_number("pressure_ratio", "-", {.low = 0, .high = 1, .low_open = true, .high_open = true});
    if (test.until.pressure_ratio && !(trace(test.initial_stress) < 0))
      until.inert("pressure_ratio", "the test starts without a pressure");
    until.inert("cycles", "this test is monotonic");
    until.finish();
    if (programme && !std::isfinite(end)) end = rate.duration();
    if (!std::isfinite(end)) {
      const char* key = triaxial ? "axial_strain" : "shear_strain";
      if (!test.until.pressure_ratio) {
        input::fail(until.node().mark, "test.until is empty: the test would never end",
                    fmt::format("for example 'until: {{{}: 0.2}}'", key));
      }
      // a ratio that is never reached must not run for ever
      const double farthest = triaxial ? 1 : 10;
      end = rate.time_of_path(farthest);
      defaults.add(fmt::format("test.until.{}", key), fmt::format("{}", farthest));
      test.warnings.push_back(
          fmt::format("until: {{pressure_ratio}} stands alone; the test ends at {} = {} at the latest", key, farthest));
    }
  }
  if (rate.path(end) == 0)
    input::fail(reader.mark("until"), "nothing happens before the test ends: the rate is still zero",
                "let it last longer, or begin with a rate different from zero");
  test.until.time = end;
}

/// Rows at equal distances along the strain path, the first at the start and the last at the end.
void read_output(ElementTest& test, const Node* node, Defaults& defaults) {
  const auto& rate = test.control.rate;
  const double end = test.until.time, length = rate.path(end);
  double every = 0, every_time = 0;
  std::int64_t rows = 1000;
  if (node) {
    Reader output(*node, "output");
    if (auto spacing = output.maybe_map("every")) {
      output.inert("rows", "every gives the distance between rows");
      const bool triaxial = test.kind == Kind::triaxial, rotation = test.kind == Kind::pure_rotation;
      const char* own = triaxial ? "axial_strain" : rotation ? "revolutions" : "shear_strain";
      spacing->known({own, "time"});
      for (const char* key : {"shear_strain", "axial_strain", "revolutions"}) {
        if (std::string_view(key) != own && spacing->has(key))
          spacing->inert(key, fmt::format("this test counts {}", own));
      }
      if (const auto strain = spacing->maybe_number(own, "-", {.low = 0, .high = 1e9, .low_open = true})) {
        every = rotation ? *strain * 2 * std::numbers::pi : *strain;
        if (spacing->has("time")) spacing->inert("time", fmt::format("{} gives the distance between rows", own));
      } else {
        every_time = spacing->number("time", "s", input::positive);
      }
      spacing->finish();
    } else {
      rows = output.integer_or("rows", rows, {.low = 1, .high = 1e7});
    }
    output.finish();
  }
  if (every == 0 && every_time == 0) {
    every = length / double(rows);
    if (!node || !node->find("rows")) defaults.add("output.rows", fmt::format("{}", rows));
  }
  const double total = every_time > 0 ? end : length;
  double step = every_time > 0 ? every_time : every;
  if (info(test.integration.method).fixed_step && test.integration.fixed_step > 0 && rate.duration() == 0) {
    // rows of a fixed-step method lie on its steps
    const double unit = every_time > 0 ? test.integration.fixed_step : test.integration.fixed_step * rate.largest();
    step = unit * std::max(1.0, std::round(step / unit));
  }
  const double count = total / step;
  if (count > 1e7) {
    input::fail(node ? node->mark : input::Mark{}, fmt::format("the output would have {:.3g} rows", count),
                "at most ten million rows: make `every` larger");
  }
  const auto whole = std::int64_t(std::floor(count * (1 + 1e-12)));
  for (std::int64_t i = 0; i <= whole; ++i) {
    const double at = double(i) * step;
    const double t = i == 0 ? 0 : every_time > 0 ? at : rate.time_of_path(at);
    if (t < end * (1 - 1e-12)) test.row_times.push_back(t);
  }
  test.row_times.push_back(end);
}

/// Whether a list of methods has some with a fixed step and some with error control: then `step` and `rtol` may stand
/// side by side, as each has a run that uses it.
bool mixed_methods(const Node& file) {
  const Node* integrator = file.find("integrator");
  const Node* list = integrator ? integrator->find("method") : nullptr;
  if (!list || !list->is_sequence()) return false;
  const auto has_fixed_step = [](const Node& name) {
    return std::any_of(methods().begin(), methods().end(),
                       [&](const MethodInfo& m) { return m.name == name.text && m.fixed_step; });
  };
  const auto fixed = std::count_if(list->items.begin(), list->items.end(), has_fixed_step);
  return fixed > 0 && fixed < std::ptrdiff_t(list->items.size());
}

void read_integrator(ElementTest& test, const Node* node, bool mixed, Defaults& defaults) {
  Integration& integration = test.integration;
  const LawNeeds needs = needs_of(test.material.law);
  const double strain = test.control.rate.path(test.until.time) * norm(symmetric(test.control.pattern));
  const Node empty{.kind = Node::Kind::map, .text = {}, .quoted = false, .mark = {}, .items = {}, .entries = {}};
  Reader reader(node ? *node : empty, "integrator");
  std::vector<std::string> names{"auto"};
  for (const auto& m : methods()) names.push_back(m.name);
  if (const Node* method = reader.find("method"); method && (method->text == "ida" || method->text == "dirk")) {
    input::fail(method->mark, fmt::format("integrator.method = '{}' is not available in this version", method->text),
                "available: " + input::join(names));
  }
  const std::string name = reader.word_or("method", names, "auto");
  if (!reader.has("method")) defaults.add("integrator.method", "auto");
  if (name == "auto") {
    integration.method = strain > longest_explicit_path ? Method::bdf : Method::dp54;
    integration.chosen_automatically = true;
  } else {
    integration.method =
        std::find_if(methods().begin(), methods().end(), [&](const auto& m) { return m.name == name; })->method;
  }

  const std::string form = reader.word_or("state", {"auto", "stress", "logarithmic"}, "auto");
  if (!reader.has("state")) defaults.add("integrator.state", "auto");
  if (form == "logarithmic") {
    if (!needs.forms) reader.inert("state", fmt::format("law '{}' has no logarithmic state", test.material.law));
    if (!test.control.held.empty()) reader.inert("state", "a test that holds a stress needs the stress as its state");
    if (!(trace(test.initial_stress) < 0))
      reader.inert("state", "the logarithmic state needs a compressive initial stress");
  }
  integration.form = form == "auto"     ? form_for(test, needs)
                     : form == "stress" ? StateForm::stress
                                        : StateForm::logarithmic;

  if (info(integration.method).fixed_step) {
    for (const char* key : {"rtol", "atol"}) {
      if (mixed) {
        reader.known({key});
      } else {
        reader.inert(key, fmt::format("{} has a fixed step and no error control", name));
      }
    }
    const Node& step = reader.need("step", "a strain increment [-] or a time [s], for example 'step: 1e-4'");
    if (step.is_scalar() && input::unit_typed(step).empty()) {
      integration.fixed_step =
          input::quantity(step, "integrator.step", "-", input::positive) / test.control.rate.largest();
    } else {
      integration.fixed_step = input::quantity(step, "integrator.step", "s", input::positive);
    }
    if (test.until.time / integration.fixed_step > 1e10)
      input::fail(step.mark, "more than ten billion steps", "make the step larger or the test shorter");
  } else {
    if (mixed) {
      reader.known({"step"});
    } else {
      reader.inert("step", fmt::format("{} chooses its own steps: give rtol", name));
    }
    integration.rtol = reader.number_or("rtol", "-", 1e-9, {.low = 1e-14, .high = 0.1});
    if (!reader.has("rtol")) defaults.add("integrator.rtol", "1e-09");
    if (reader.has("atol")) {
      integration.atol = reader.number("atol", "Pa", input::not_negative);
    } else {
      // round-off of the initial stress; the logarithmic state needs none
      integration.atol = integration.form == StateForm::logarithmic ? 0 : 1e-14 * norm(test.initial_stress);
    }
  }
  integration.error_estimate = reader.flag_or("error_estimate", true);
  if (!reader.has("error_estimate")) defaults.add("integrator.error_estimate", "true");
  reader.finish();
}

}  // namespace grainlaw::element
