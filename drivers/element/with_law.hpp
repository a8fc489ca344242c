// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// The one place where a law is chosen at run time.
#include <string_view>

#include "element_test.hpp"
#include "rheology/laws.hpp"

namespace grainlaw::element {

/// Calls f(Recipe) for the recipe of that name; false when there is none.
template <class F>
bool with_recipe(std::string_view name, F&& f) {
  bool found = false;
  for_each_recipe([&]<class R>(R recipe) {
    if (R::name == name) {
      found = true;
      f(recipe);
    }
  });
  return found;
}

/// The law with the parameters of a material.
template <class L>
L build_law(const Material& material, double void_ratio) {
  L law{};
  visit_parameters(law, [&](const auto& row, Constant& value) {
    for (const auto& p : material.parameters) {
      if (p.name == row.name) value = p.value;
    }
  });
  set_void_ratio(law, void_ratio);
  return law;
}

/// Calls f(law, form name) with the law of a material in the state form asked for.
template <class F>
void with_law(const Material& material, double void_ratio, StateForm form, F&& f) {
  with_recipe(material.law, [&]<class R>(R) {
    using Forms = typename R::Forms;
    if constexpr (std::tuple_size_v < Forms >> 1) {
      if (form == StateForm::logarithmic) {
        f(build_law<std::tuple_element_t<1, Forms>>(material, void_ratio), "logarithmic");
        return;
      }
    }
    f(build_law<std::tuple_element_t<0, Forms>>(material, void_ratio), "stress");
  });
}

}  // namespace grainlaw::element
