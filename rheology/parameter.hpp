// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// One row of a parameter table. The table is the only declaration of a parameter: it drives the reading of YAML,
// the error messages, the printed documentation and the test of invariance to units.
#include <limits>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "real.hpp"

namespace grainlaw {

inline constexpr double required = std::numeric_limits<double>::quiet_NaN();
inline constexpr double unbounded = std::numeric_limits<double>::infinity();

template <class Owner>
struct Parameter {
  std::string_view name;     ///< the same in papers, code, YAML and output
  std::string_view unit;     ///< SI; "-" when dimensionless
  std::string_view meaning;  ///< a few words
  Constant Owner::*value;
  double low, high;            ///< closed interval outside which the formula has no meaning
  double fallback = required;  ///< value when the material does not give one
};

/// Calls f(row, value) for every parameter of a law and of the slots that it fills.
template <class Owner, class F>
constexpr void visit_parameters(Owner& owner, F&& f) {
  using Plain = std::remove_const_t<Owner>;
  if constexpr (requires { Plain::parameters(); }) {
    for (const auto& row : Plain::parameters()) f(row, owner.*row.value);
  }
  if constexpr (requires { owner.parts(); }) {
    std::apply([&](auto&... part) { (visit_parameters(part, f), ...); }, owner.parts());
  }
}

/// Sets the void ratio that belongs to zero compaction in every slot that depends on the density.
template <class Owner>
constexpr void set_void_ratio(Owner& owner, double e) {
  if constexpr (requires { owner.e_ref; }) owner.e_ref = e;
  if constexpr (requires { owner.parts(); }) {
    std::apply([&](auto&... part) { (set_void_ratio(part, e), ...); }, owner.parts());
  }
}

/// Whether a law or one of its slots depends on the void ratio.
template <class Owner>
constexpr bool uses_void_ratio() {
  if constexpr (requires(Owner o) { o.e_ref; }) {
    return true;
  } else if constexpr (requires(Owner o) { o.parts(); }) {
    return []<class... Part>(std::tuple<Part&...>*) {
      return (uses_void_ratio<Part>() || ...);
    }(static_cast<decltype(std::declval<Owner&>().parts())*>(nullptr));
  } else {
    return false;
  }
}

}  // namespace grainlaw
