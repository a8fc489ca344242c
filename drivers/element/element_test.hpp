// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// What one element test is, after its YAML has been read: plain data, no YAML, no law type.
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../input/node.hpp"
#include "ode.hpp"
#include "rate_programme.hpp"
#include "rheology/tensor.hpp"

namespace grainlaw::element {

struct ParameterValue {
  std::string name, unit, meaning;
  double value;
  std::string source;  ///< the material's source, "given here" or "default"
};

struct Material {
  std::string law;
  std::string name;  ///< of the named set, empty when everything was given in place
  std::string title, source;
  std::vector<ParameterValue> parameters;
  std::vector<std::string> warnings;
};

enum class Kind { simple_shear, annular_shear_cell, triaxial, pure_rotation, point };
enum class StateForm { automatic, stress, logarithmic };

/// How the point is driven: L = rate(t) pattern, plus free diagonal components that hold stresses.
struct Control {
  Tensor<double> pattern{};
  RateProgramme rate;
  std::vector<int> held;            ///< 0, 1, 2 for xx, yy, zz: stress held, L free
  SymTensor<double> held_stress{};  ///< [Pa], tension positive; only held components are read
};

struct Until {
  double time;                           ///< [s], always finite
  std::optional<double> pressure_ratio;  ///< stop when p falls to this share of the initial p
};

struct Columns {  ///< which generic columns make sense for this test
  bool shear_strain = false, shear_rate = false, axial = false, volumetric = false, excess_pore_pressure = false;
  bool spin = false;
};

struct Integration {
  Method method = Method::dp54;
  bool chosen_automatically = false;
  StateForm form = StateForm::automatic;
  double rtol = 0, atol = 0;  ///< [-], [Pa]
  double fixed_step = 0;      ///< [s]
  bool error_estimate = true;
};

struct ElementTest {
  std::string run;  ///< name of the run: "void_ratio=0.890"
  Kind kind = Kind::simple_shear;
  std::string kind_name;
  Material material;
  std::optional<double> void_ratio;
  SymTensor<double> initial_stress{};
  double compaction = 0;
  Control control;
  Until until;
  std::vector<double> row_times;
  Columns columns;
  Integration integration;
  double axial_sign = 1;                  ///< triaxial: -1 compression, +1 extension
  std::string main_quantity;              ///< column whose peak and residual the tables show
  std::vector<std::string> peaks_wanted;  ///< other columns whose peak an expectation names
  std::vector<std::string> notes, warnings;

  /// Liquefaction, softening and dilation are words for shearing at constant volume.
  bool has_response_class() const { return columns.excess_pore_pressure; }
};

struct Axis {
  std::string data;   ///< column name in the CSV
  double factor = 1;  ///< to SI, sign included
  double offset = 0;
  bool engineering = false;        ///< the data are engineering strains: ln(1 + value) is compared
  bool relative_to_first = false;  ///< the data count from their first row
  std::string run;                 ///< column of the run, without unit
};

struct Comparison {
  std::string run;
  std::filesystem::path file;
  Axis x, y;
  std::string label, role, note;
  std::string where_column;  ///< only rows in which this column ...
  double where_value = 0;    ///< ... has this value; empty: all
};

struct Expectation {
  std::string run;  ///< empty: every run
  std::string column;
  enum class At { end, peak, value } at = At::end;
  std::string at_column, at_unit;
  double at_value = 0;
  double value = 0;
  std::string unit;
  double within = 0;
  bool relative = true;
  std::string because;
};

/// One YAML file as understood: every run of it, and what is to be done with the results.
struct ElementFile {
  std::filesystem::path path;
  std::string title, source, kind;
  std::vector<ElementTest> tests;
  std::vector<Comparison> comparisons;
  std::vector<Expectation> expectations;
  std::vector<std::string> notes, warnings;
  input::Node as_run;  ///< everything as understood, defaults included
};

}  // namespace grainlaw::element
