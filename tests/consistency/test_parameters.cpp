// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <set>

#include "drivers/input/units.hpp"
#include "harness.hpp"

using namespace grainlaw;
using namespace grainlaw::consistency;

TEMPLATE_LIST_TEST_CASE("every parameter says what it is", "[parameters]", AllLaws) {
  auto law = example_law<TestType>();
  std::set<std::string> names;
  std::vector<const Constant*> places;
  const Units units{3, 2, -1};
  visit_parameters(law, [&](const auto& row, Constant& value) {
    CAPTURE(row.name);
    CHECK(!row.name.empty());
    CHECK(row.meaning.size() >= 5);
    CHECK(names.insert(std::string(row.name)).second);  // materials name a parameter without its slot
    units.power(row.unit);                              // fails for an unknown unit
    // a material file can give it in this very unit
    const auto si = input::to_si(1.5, row.unit == "-" ? "" : row.unit, row.unit);
    CHECK((si && *si == 1.5));
    CHECK(row.low < row.high);
    CHECK(std::isfinite(row.low));
    CHECK(std::isfinite(row.high));
    CHECK((std::isnan(row.fallback) || (row.low <= row.fallback && row.fallback <= row.high)));
    CHECK(row.low <= value.value);
    CHECK(value.value <= row.high);
    places.push_back(&value);
  });
  CHECK(!places.empty());
  // listed in the order in which they are declared, each once
  CHECK(std::is_sorted(places.begin(), places.end()));
  CHECK(std::adjacent_find(places.begin(), places.end()) == places.end());
}

TEMPLATE_LIST_TEST_CASE("every parameter changes something", "[parameters]", AllLaws) {
  using L = TestType;
  const L law = example_law<L>();
  int which = 0;
  visit_parameters(law, [&](const auto& row, const Constant& value) {
    L changed = law;
    const double step = 0.01 * std::fabs(value.value);
    int k = 0;
    visit_parameters(changed, [&](const auto& r, Constant& v) {
      if (k++ == which) v = v.value + step <= r.high ? v.value + step : v.value - step;
    });
    ++which;
    Random random(61);
    bool moves = false;
    for (int i = 0; i < 3000 && !moves; ++i) {
      const Flow<double> flow = random.flow(1e-6, 1e3);
      const auto y = at_rest(law, flow.compaction, random.stress(random.decades(1e-9, 1e7)));
      const auto a = law.admit(flow, y), b = changed.admit(flow, y);
      moves = !equal<double>(law.stress(flow, y), changed.stress(flow, y)) ||
              !equal<double>(law.rate(flow, y), changed.rate(flow, y)) || !equal<double>(a.state, b.state) ||
              a.reasons != b.reasons;
    }
    CAPTURE(row.name);
    CHECK(moves);
  });
}

TEST_CASE("no two recipes have the same name", "[parameters]") {
  std::set<std::string_view> names;
  for_each_recipe([&](auto recipe) { CHECK(names.insert(recipe.name).second); });
}
