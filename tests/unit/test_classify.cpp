// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "drivers/element/classify.hpp"

using grainlaw::element::classify;
using grainlaw::element::peak_index;

TEST_CASE("The class of a response follows the documented thresholds", "[classify]") {
  const struct {
    const char* what;
    std::vector<double> stress;
    std::string expected;
  } rows[]{{"rises", {0, 1, 2, 3}, "dilative"},
           {"rises and stays", {0, 10, 10}, "dilative"},
           {"drops by 2.9 %", {0, 100, 97.1}, "dilative"},
           {"drops by 3.1 %", {0, 100, 96.9}, "softening"},
           {"ends at 21 % of the peak", {0, 100, 21}, "softening"},
           {"ends at 19 % of the peak", {0, 100, 19}, "liquefaction"},
           {"regains 4 % of a drop of 50", {0, 100, 50, 52}, "softening"},
           {"regains 6 % of a drop of 50", {0, 100, 50, 53}, "limited liquefaction"},
           {"dips and rises beyond the peak", {0, 100, 90, 300}, "limited liquefaction"},
           {"falls from the start", {5, 1, 0.1}, "liquefaction"},
           {"stays at zero", {0, 0, 0}, "dilative"},
           {"one row", {3}, "dilative"}};
  for (const auto& row : rows) {
    CAPTURE(row.what);
    CHECK(classify(row.stress) == row.expected);
  }
}

TEST_CASE("The peak is the first maximum that a real drop follows", "[classify]") {
  CHECK(peak_index({0, 1, 2, 3}) == 3);           // no drop: the end
  CHECK(peak_index({0, 5, 4, 9}) == 1);           // a drop of 20 % ends the search
  CHECK(peak_index({0, 100, 98, 101, 50}) == 3);  // noise of 2 % does not
  CHECK(peak_index({0, 5, 5, 1}) == 1);           // of equals the first
}
