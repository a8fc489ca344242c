// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// The list of laws that can be chosen by name: the only registry. A new law is one line here.
#include <tuple>

#include "elastic.hpp"
#include "hypoplastic_bagnold.hpp"
#include "newtonian.hpp"

namespace grainlaw {

/// A law under the name by which a material chooses it, in the state forms that it has.
template <class Default, class... OtherForms>
struct Recipe {
  using Law = Default;  ///< carries the stress itself where there is one
  using Forms = std::tuple<Default, OtherForms...>;
  static constexpr std::string_view name = Default::name;
};

using Recipes = std::tuple<Recipe<Newtonian>,                                           //
                           Recipe<Elastic>,                                             //
                           Recipe<Hypoplastic<>, Hypoplastic<CriticalState, LogForm>>,  //
                           Recipe<Bagnold>,                                             //
                           Recipe<HypoplasticBagnold<>, HypoplasticBagnold<CriticalState, LogForm>>>;

/// Calls f(Recipe) for every law.
template <class F>
constexpr void for_each_recipe(F&& f) {
  [&]<class... R>(std::tuple<R...>*) { (f(R{}), ...); }(static_cast<Recipes*>(nullptr));
}

}  // namespace grainlaw
