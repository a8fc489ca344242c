// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// Element tests as the tests need them: unit rate, so that time is strain; rows where the reference has them.
#include "drivers/element/run.hpp"
#include "rheology/laws.hpp"
#include "tests/materials.hpp"

namespace grainlaw::testing {

using element::ElementTest;
using element::Method;
using element::RunRecord;
using element::StateForm;
using element::Status;

template <class Law>
element::Material material_of(const Law& law) {
  element::Material material;
  material.law = Law::name;
  visit_parameters(law, [&](const auto& row, const Constant& value) {
    material.parameters.push_back({std::string(row.name), std::string(row.unit), "", value.value, "test"});
  });
  return material;
}

/// L = pattern, constant, from `start`; rows at 0 and at the times given.
template <class Law>
ElementTest path(const Law& law, double e, const Tensor<double>& pattern, const SymTensor<double>& start,
                 std::vector<double> rows, double rtol = 1e-11, Method method = Method::dp54,
                 StateForm form = StateForm::logarithmic) {
  ElementTest test;
  test.run = "test";
  test.material = material_of(law);
  test.void_ratio = e;
  test.initial_stress = start;
  test.control.pattern = pattern;
  test.control.rate = element::RateProgramme::constant(1);
  test.until.time = rows.back();
  rows.insert(rows.begin(), 0);
  test.row_times = std::move(rows);
  test.columns.shear_strain = true;
  test.columns.volumetric = true;
  test.integration.method = method;
  test.integration.form = form;
  test.integration.rtol = rtol;
  test.integration.error_estimate = false;
  test.main_quantity = "shear_stress";
  return test;
}

/// Undrained simple shear from an isotropic pressure.
inline ElementTest shear(const Set& set, double e, double p0, std::vector<double> rows, double rtol = 1e-11,
                         Method method = Method::dp54, StateForm form = StateForm::logarithmic) {
  ElementTest test = path(law_of(set, e), e, simple_shear_flow, isotropic(-p0), std::move(rows), rtol, method, form);
  test.columns.excess_pore_pressure = true;  // what makes a test an undrained one
  return test;
}
/// Simple shear under a constant normal stress: L_zz is free, the void ratio follows.
inline ElementTest drained_shear(const Set& set, double e, double p0, std::vector<double> rows, double rtol = 1e-11,
                                 Method method = Method::dp54) {
  ElementTest test = shear(set, e, p0, std::move(rows), rtol, method, StateForm::stress);
  test.columns.excess_pore_pressure = false;
  test.control.held = {2};
  test.control.held_stress = test.initial_stress;
  return test;
}
inline ElementTest with_fixed_step(ElementTest test, Method method, double step) {
  test.integration.method = method;
  test.integration.fixed_step = step;
  return test;
}

/// n equal intervals up to `end`, without the 0.
inline std::vector<double> equal_rows(double end, int n) {
  std::vector<double> rows;
  for (int i = 1; i <= n; ++i) rows.push_back(end * i / n);
  return rows;
}

inline double value(const RunRecord& record, std::size_t row, const char* column) {
  return record.at(row, std::size_t(record.column(column)));
}
inline double last(const RunRecord& record, const char* column) { return value(record, record.rows() - 1, column); }
inline SymTensor<double> stress_at(const RunRecord& r, std::size_t row) {
  return {value(r, row, "stress_xx"), value(r, row, "stress_yy"), value(r, row, "stress_zz"),
          value(r, row, "stress_yz"), value(r, row, "stress_xz"), value(r, row, "stress_xy")};
}
/// Largest distance of two paths over common rows, relative to a stress.
inline double path_error(const RunRecord& a, const RunRecord& b, double scale) {
  double worst = a.rows() == b.rows() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.rows(), b.rows()); ++i)
    worst = std::max(worst, norm(stress_at(a, i) - stress_at(b, i)) / scale);
  return worst;
}

/// Steady state of undrained simple shear: I_e(e, |tr|) = I*, by bisection; 0 when it liquefies completely.
struct Steady {
  double t;
  SymTensor<double> sigma;
};
inline Steady steady(const Set& set, double e, const Tensor<double>& flow = simple_shear_flow) {
  const auto law = law_of(set, e);
  const auto state = stationary_state(law, flow);
  double low = 0, high = 3e6;
  if (!(critical_void_ratio(law.critical, state.I_star, 0) > e)) return {0, {}};
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (critical_void_ratio(law.critical, state.I_star, middle) > e ? low : high) = middle;
  }
  return {low, -low * state.r};
}

}  // namespace grainlaw::testing
