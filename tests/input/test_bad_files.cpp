// SPDX-License-Identifier: BSD-3-Clause
// Wrong inputs, run through the program: exit code 2, the place, the key, what would be right, and nothing written.
#include <catch2/catch.hpp>

#include "program.hpp"

using namespace program;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

const std::string shear = R"(title: Undrained simple shear
source: nobody
material: {use: peng2016_table1}
test:
  kind: simple_shear
  hold: volume
  initial: {pressure: 100 kPa, void_ratio: 0.845}
  shear_rate: 0.01 1/s
  until: {shear_strain: 0.1}
integrator: {method: auto, rtol: 1e-9}
output: {every: {shear_strain: 0.01}}
compare:
  - {data: data.csv, x: {data: strain, unit: percent, run: shear_strain}, y: {data: tau, unit: kPa, run: shear_stress}}
expect:
  - {run: run, column: shear_stress, at: end, value: 10 kPa, within: 10}
)";

const std::string held = R"(material: {use: peng2016_table1}
test:
  kind: simple_shear
  hold: normal_stress
  normal_stress: 100 kPa
  initial: {pressure: 100 kPa, void_ratio: 0.845}
  shear_rate: 0.01 1/s
  until: {shear_strain: 0.1}
integrator: {method: bdf, rtol: 1e-9}
)";

const std::string elastic = R"(material: {law: elastic, K: 20 MPa, G: 10 MPa}
test:
  kind: simple_shear
  initial: {pressure: 100 kPa}
  shear_rate: [{from: 0 1/s, to: 1 1/s, over: 1 s}]
integrator: {method: euler, step: 1e-4}
)";

const std::string cell = R"(material: {use: peng2016_table2}
test:
  kind: annular_shear_cell
  void_ratio: [1.169, 0.908]
  k_v: [0.0018 kg/m, 0.0065 kg/m]
  initial: {pressure: 500 Pa}
  kappa: [{from: 10 1/s, to: 50 1/s, over: 0.1 s}]
)";

const std::string triaxial = R"(material: {use: karlsruhe_fine_sand}
test:
  kind: triaxial
  drainage: undrained
  mode: compression
  initial: {pressure: 100 kPa, void_ratio: 0.9}
  axial_rate: 0.01 1/s
  until: {axial_strain: 0.1}
)";

const std::string rotation = R"(material: {use: peng2016_table1}
test:
  kind: pure_rotation
  initial: {stress: {xx: -50 kPa, yy: -50 kPa, zz: -100 kPa}, void_ratio: 0.845}
  spin: 1 rad/s
  revolutions: 1
)";

const std::string point = R"(material: {use: peng2016_table1}
test:
  kind: point
  stress: {xx: -50 kPa, yy: -50 kPa, zz: -100 kPa, xz: 5 kPa}
  void_ratio: 0.845
  L: [[0, 0, 1], [0, 0, 0], [0, 0, 0]] 1/s
)";

/// A file with one thing wrong. '@' in the replacement marks where the caret must stand; it is not part of the file.
struct Bad {
  std::string what;
  const std::string& file;
  std::string from, to;
  std::string key;   ///< what the message must name
  std::string help;  ///< what it must advise: the expected unit, a suggestion ...
};

const std::vector<Bad> units{
    {"no unit", shear, "pressure: 100 kPa", "pressure: @100", "test.initial.pressure = '100'", "a pressure [Pa]"},
    {"no unit on a rate", shear, "shear_rate: 0.01 1/s", "shear_rate: @0.01", "test.shear_rate", "0.01 1/s"},
    {"another dimension", shear, "pressure: 100 kPa", "pressure: @100 mm", "test.initial.pressure", "kPa"},
    {"a rate in seconds", shear, "shear_rate: 0.01 1/s", "shear_rate: @0.01 s", "test.shear_rate", "1/s"},
    {"a unit misspelt", shear, "pressure: 100 kPa", "pressure: @100 kPaa", "test.initial.pressure",
     "did you mean 'kPa'?"},
    {"a unit in capitals", shear, "pressure: 100 kPa", "pressure: @100 KPA", "test.initial.pressure",
     "did you mean 'kPa'?"},
    {"a prefix in the wrong case", shear, "pressure: 100 kPa", "pressure: @0.1 mpa", "test.initial.pressure", "MPa"},
    {"a unit on a plain number", shear, "void_ratio: 0.845", "void_ratio: @0.845 kPa", "test.initial.void_ratio",
     "remove the unit"},
    {"a unit without a number", shear, "pressure: 100 kPa", "pressure: @kPa", "test.initial.pressure", "100 kPa"},
    {"NaN", shear, "pressure: 100 kPa", "pressure: @nan kPa", "test.initial.pressure", "finite"},
    {"YAML's NaN", shear, "void_ratio: 0.845", "void_ratio: @.nan", "test.initial.void_ratio", "finite"},
    {"infinity", shear, "pressure: 100 kPa", "pressure: @inf Pa", "test.initial.pressure", "finite"},
    {"minus infinity", shear, "void_ratio: 0.845", "void_ratio: @-.inf", "test.initial.void_ratio", "finite"},
    {"hexadecimal", shear, "pressure: 100 kPa", "pressure: @0x10 kPa", "test.initial.pressure", "decimal"},
    {"too large for a double", shear, "pressure: 100 kPa", "pressure: @1e999 Pa", "test.initial.pressure", "too large"},
    {"too large because of the unit", shear, "pressure: 100 kPa", "pressure: @1e307 GPa", "test.initial.pressure",
     "too large"},
    {"too small for a double", shear, "pressure: 100 kPa", "pressure: @1e-400 Pa", "test.initial.pressure",
     "too small"},
    {"a decimal comma", shear, "void_ratio: 0.845", "void_ratio: @'0,845'", "test.initial.void_ratio", "point"},
    {"grouped digits", shear, "pressure: 100 kPa", "pressure: @100_000 Pa", "test.initial.pressure", "grouped"},
    {"two numbers", shear, "pressure: 100 kPa", "pressure: @100 200 Pa", "test.initial.pressure", "blank"},
    {"a word for a number", shear, "pressure: 100 kPa", "pressure: @high", "test.initial.pressure", "a pressure [Pa]"},
    {"nothing for a number", shear, "pressure: 100 kPa", "@pressure: ", "test.initial.pressure", "100 kPa"},
    {"a unit behind some list entries only", cell, "[0.0018 kg/m, 0.0065 kg/m]", "[0.0018 kg/m, @0.0065]", "test.k_v",
     "a mass per length [kg/m]"},
    {"a wrong unit behind a list", cell, "[0.0018 kg/m, 0.0065 kg/m]", "[@0.0018, 0.0065] kg", "test.k_v", "kg/m"},
    {"a wrong unit behind a matrix", point, "[0, 0, 0]] 1/s", "[0, 0, 0]] Pa", "test.L[1][1]", "1/s"},
    {"no unit behind a matrix", point, "[0, 0, 0]] 1/s", "[0, 0, 0]]", "test.L[1][1]", "a rate [1/s]"},
    {"a length for an angle", shear, "{use: peng2016_table1}", "{use: peng2016_table1, alpha_i: @35 m}",
     "material.alpha_i", "deg"},
    {"an angle without unit", shear, "{use: peng2016_table1}", "{use: peng2016_table1, alpha_i: @35}",
     "material.alpha_i", "30 deg"},
};

const std::vector<Bad> ranges{
    {"negative pressure", shear, "pressure: 100 kPa", "pressure: @-100 kPa", "test.initial.pressure", "above 0 Pa"},
    {"zero pressure", shear, "pressure: 100 kPa", "pressure: @0 Pa", "test.initial.pressure", "above 0 Pa"},
    {"void ratio 0", shear, "void_ratio: 0.845", "void_ratio: @0", "test.initial.void_ratio", "above 0"},
    {"void ratio below 0", shear, "void_ratio: 0.845", "void_ratio: @-0.2", "test.initial.void_ratio", "above 0"},
    {"solid fraction above 1", shear, "void_ratio: 0.845", "solid_fraction: @1.2", "test.initial.solid_fraction",
     "below 1"},
    {"solid fraction in percent above 100", cell, "void_ratio: [1.169, 0.908]", "solid_fraction: [@120, 50] %",
     "test.solid_fraction", "below 1"},
    {"negative collisional coefficient", cell, "0.0018 kg/m,", "@-0.0018 kg/m,", "test.k_v", "at least 0"},
    {"rtol 0", shear, "rtol: 1e-9", "rtol: @0", "integrator.rtol", "at least 1e-14"},
    {"rtol 1", shear, "rtol: 1e-9", "rtol: @1", "integrator.rtol", "at most 0.1"},
    {"negative atol", shear, "rtol: 1e-9", "atol: @-1 Pa", "integrator.atol", "at least 0"},
    {"step 0", elastic, "step: 1e-4", "step: @0", "integrator.step", "above 0"},
    {"negative step", elastic, "step: 1e-4", "step: @-1 ms", "integrator.step", "above 0"},
    {"ten billion steps", elastic, "step: 1e-4", "step: @1e-16", "more than ten billion steps", "larger"},
    {"negative strain", shear, "{shear_strain: 0.1}", "{shear_strain: @-0.1}", "test.until.shear_strain", "above 0"},
    {"time 0", shear, "{shear_strain: 0.1}", "{time: @0 s}", "test.until.time", "above 0"},
    {"pressure ratio above 1", shear, "{shear_strain: 0.1}", "{pressure_ratio: @2}", "test.until.pressure_ratio",
     "below 1"},
    {"rows of no width", shear, "{every: {shear_strain: 0.01}}", "{every: {shear_strain: @0}}",
     "output.every.shear_strain", "above 0"},
    {"too many rows", shear, "{every: {shear_strain: 0.01}}", "@{every: {shear_strain: 1e-12}}", "rows", "larger"},
    {"half a row", shear, "{every: {shear_strain: 0.01}}", "{rows: @2.5}", "output.rows", "10"},
    {"no row", shear, "{every: {shear_strain: 0.01}}", "{rows: @0}", "output.rows", "at least 1"},
    {"a piece that takes no time", cell, "over: 0.1 s", "over: @0 s", "test.kappa.0.over", "above 0"},
    {"negative axial rate", triaxial, "axial_rate: 0.01 1/s", "axial_rate: @-0.01 1/s", "test.axial_rate", "above 0"},
    {"no revolutions", rotation, "revolutions: 1", "revolutions: @0", "test.revolutions", "above 0"},
    {"no spin", rotation, "spin: 1 rad/s", "@spin: 0 rad/s", "test.spin", "1 rad/s"},
    {"negative stiffness", elastic, "K: 20 MPa", "K: @-20 MPa", "material.K", "at least"},
    {"friction angle of 90 degrees", triaxial, "{use: karlsruhe_fine_sand}",
     "{use: karlsruhe_fine_sand, calibrate: {E_over_p: 150, phi: @90 deg}}", "material.calibrate.phi",
     "an angle [rad]"},
    {"a calibration without a failure surface", triaxial, "{use: karlsruhe_fine_sand}",
     "{use: karlsruhe_fine_sand, @calibrate: {E_over_p: 150, phi: 30 deg, nu: 0.4}}", "c4", "lower nu"},
    {"negative tolerance of an expectation", shear, "within: 10", "within: @-0.1", "expect.0.within", "at least 0"},
};

const std::vector<Bad> unknown{
    {"at the root", shear, "output:", "@ouput:", "unknown key 'ouput'", "did you mean 'output'?"},
    {"in the material", elastic, "G: 10 MPa", "G: 10 MPa, @nu: 0.3", "unknown key 'material.nu'",
     "known: use, law, name, K, G"},
    {"in the test", shear, "  hold: volume", "  @holds: volume", "unknown key 'test.holds'", "did you mean 'hold'?"},
    {"in the initial state", shear, "void_ratio: 0.845}", "void_ratio: 0.845, @presure: 1 kPa}",
     "unknown key 'test.initial.presure'", "did you mean 'pressure'?"},
    {"in a stress", rotation, "zz: -100 kPa", "zz: -100 kPa, @zx: 1 kPa", "unknown key 'test.initial.stress.zx'",
     "did you mean"},
    {"in until", shear, "{shear_strain: 0.1}", "{shear_strain: 0.1, @tme: 3 s}", "unknown key 'test.until.tme'",
     "did you mean 'time'?"},
    {"in the integrator", shear, "{method: auto, rtol", "{method: auto, @rtoll: 1, rtol",
     "unknown key 'integrator.rtoll'", "did you mean 'rtol'?"},
    {"in the output", shear, "output: {every", "output: {@evry: 3, every", "unknown key 'output.evry'",
     "did you mean 'every'?"},
    {"in every", shear, "{every: {shear_strain: 0.01}}", "{every: {shear_strain: 0.01, @tim: 1 s}}",
     "unknown key 'output.every.tim'", "did you mean 'time'?"},
    {"in a piece of a programme", cell, "over: 0.1 s}", "over: 0.1 s, @ovr: 1 s}", "unknown key 'test.kappa.0.ovr'",
     "did you mean 'over'?"},
    {"in a comparison", shear, "{data: data.csv,", "{@lable: x, data: data.csv,", "unknown key 'compare.0.lable'",
     "did you mean 'label'?"},
    {"in an axis", shear, "x: {data: strain,", "x: {@units: s, data: strain,", "unknown key 'compare.0.x.units'",
     "did you mean 'unit'?"},
    {"in an expectation", shear, "within: 10}", "within: 10, @becaus: x}", "unknown key 'expect.0.becaus'",
     "did you mean 'because'?"},
    {"in a calibration", triaxial, "{use: karlsruhe_fine_sand}",
     "{use: karlsruhe_fine_sand, calibrate: {E_over_p: 150, phi: 30 deg, @ph: 1}}",
     "unknown key 'material.calibrate.ph'", "did you mean 'phi'?"},
    {"in Bagnold's formula", cell,
     "{use: peng2016_table2}\ntest:\n  kind: annular_shear_cell\n  void_ratio: [1.169, 0.908]\n  k_v: [0.0018 kg/m, "
     "0.0065 kg/m]",
     "{use: peng2016_table2, k_v: {rho_s: 1095 kg/m^3, d: 1 mm, @B: 1}}\ntest:\n  kind: annular_shear_cell\n  "
     "void_ratio: 0.908",
     "unknown key 'material.k_v.B'", "known: A, C_max, rho_s, d"},
    {"in other capitals", shear, "title:", "@Title:", "unknown key 'Title'", "did you mean 'title'?"},
    {"no blank behind the colon", shear, "{shear_strain: 0.1}", "{shear_strain: 0.1, @time:3s}", "test.until", "blank"},
};

const std::vector<Bad> inert{
    {"normal_stress at constant volume", shear, "hold: volume", "hold: volume\n  @normal_stress: 100 kPa",
     "'test.normal_stress' would change nothing", "keeps the volume"},
    {"rtol with euler", elastic, "step: 1e-4", "step: 1e-4, @rtol: 1e-9", "'integrator.rtol'", "fixed step"},
    {"atol with euler", elastic, "step: 1e-4", "step: 1e-4, @atol: 1 Pa", "'integrator.atol'", "fixed step"},
    {"step with bdf", held, "rtol: 1e-9", "@step: 1e-4", "'integrator.step'", "give rtol"},
    {"axial_strain in simple shear", shear, "{shear_strain: 0.1}", "{@axial_strain: 0.1}", "'test.until.axial_strain'",
     "shear_strain"},
    {"shear_strain in a triaxial test", triaxial, "{axial_strain: 0.1}", "{@shear_strain: 0.1}",
     "'test.until.shear_strain'", "axial_strain"},
    {"rows at axial strains in simple shear", shear, "{every: {shear_strain: 0.01}}", "{every: {@axial_strain: 0.01}}",
     "'output.every.axial_strain'", "shear_strain"},
    {"cycles in a monotonic test", shear, "{shear_strain: 0.1}", "{shear_strain: 0.1, @cycles: 3}",
     "'test.until.cycles'", "monotonic"},
    {"an integrator for a point", point, "test:", "@integrator: {method: bdf}\ntest:", "'integrator'", "point"},
    {"an output for a point", point, "test:", "@output: {rows: 10}\ntest:", "'output'", "one row"},
    {"until in a rotation", rotation, "spin:", "@until: {time: 1 s}\n  spin:", "'test.until'", "revolutions"},
    {"void ratio for an elastic solid", elastic, "pressure: 100 kPa", "pressure: 100 kPa, @void_ratio: 0.8",
     "'test.initial.void_ratio'", "does not depend on the density"},
    {"pressure and stress", rotation, "void_ratio: 0.845", "void_ratio: 0.845, @pressure: 100 kPa",
     "'test.initial.pressure'", "stress gives every component"},
    {"void ratio and solid fraction", shear, "void_ratio: 0.845", "void_ratio: 0.845, @solid_fraction: 0.5",
     "'test.initial.solid_fraction'", "already given"},
    {"a parameter of another law", elastic, "G: 10 MPa", "G: 10 MPa, @c1: -50", "'material.c1'",
     "it belongs to hypoplastic"},
    {"a parameter of another law beside a named material", triaxial, "{use: karlsruhe_fine_sand}",
     "{use: karlsruhe_fine_sand, @k_v: 0.01 kg/m}", "'material.k_v'", "it belongs to bagnold"},
    {"a calibration of an elastic solid", elastic, "G: 10 MPa", "G: 10 MPa, @calibrate: {E_over_p: 100, phi: 30 deg}",
     "'material.calibrate'", "c1 to c4"},
    {"c1 beside a calibration", triaxial, "{use: karlsruhe_fine_sand}",
     "{use: karlsruhe_fine_sand, calibrate: {E_over_p: 150, phi: 30 deg}, @c1: -50}", "'material.c1'", "calibrate"},
    {"k_v given twice", cell, "{use: peng2016_table2}", "{use: peng2016_table2, @k_v: 1 kg/m}", "'material.k_v'",
     "test.k_v"},
    {"k_v of a law without collisions", cell, "{use: peng2016_table2}", "{law: hypoplastic, use: peng2016_table2}",
     "'test.k_v'", "collisional"},
    {"rows with every", shear, "{every: {shear_strain: 0.01}}", "{@rows: 10, every: {shear_strain: 0.01}}",
     "'output.rows'", "every"},
    {"time and strain in every", shear, "{every: {shear_strain: 0.01}}", "{every: {shear_strain: 0.01, @time: 1 s}}",
     "'output.every.time'", "shear_strain"},
    {"shear_rate in the annular cell", cell, "  kappa:", "  @shear_rate: 1 1/s\n  kappa:", "'test.shear_rate'",
     "kappa"},
    {"the logarithmic state of an elastic solid", elastic, "step: 1e-4", "step: 1e-4, @state: logarithmic",
     "'integrator.state'", "elastic"},
    {"a density of a law that has none", point, "void_ratio: 0.845", "void_ratio: 0.845\n  @density: 1500 kg/m^3",
     "'test.density'", "void_ratio"},
};

const std::vector<Bad> missing{
    {"no material", shear, "material: {use: peng2016_table1}\n", "", "'material' is missing", "law"},
    {"no test", shear, "", "@material: {use: peng2016_table1}\n", "'test' is missing", "kind: simple_shear"},
    {"neither law nor named material", elastic, "{law: elastic, K", "@{K", "'material.law' is missing", "one of:"},
    {"no parameter", elastic, "{law: elastic, K: 20 MPa,", "@{law: elastic,", "material.K is missing", "[Pa]"},
    {"no kind", shear, "  kind: simple_shear\n  hold", "  @hold", "'test.kind' is missing", "one of: simple_shear"},
    {"a misspelt kind: key", shear, "  kind: simple_shear", "  @knd: simple_shear", "'test.kind' is missing",
     "is 'knd' at"},
    {"no initial state", shear, "  initial: {pressure: 100 kPa, void_ratio: 0.845}\n", "", "initial", "void_ratio"},
    {"no pressure", shear, "{pressure: 100 kPa, void_ratio: 0.845}", "@{void_ratio: 0.845}",
     "'test.initial.pressure' is missing", "a pressure [Pa]"},
    {"no void ratio", shear, "{pressure: 100 kPa, void_ratio: 0.845}", "@{pressure: 100 kPa}",
     "'test.initial.void_ratio' is missing", "solid_fraction"},
    {"no void ratio in the cell", cell, "kind: annular_shear_cell\n  void_ratio: [1.169, 0.908]\n",
     "@kind: annular_shear_cell\n", "'test.void_ratio' is missing", "void_ratio"},
    {"no shear rate", shear, "  shear_rate: 0.01 1/s\n", "", "'test.shear_rate' is missing", "0.01 1/s"},
    {"no until", shear, "  until: {shear_strain: 0.1}\n", "", "'test.until' is missing", "shear_strain"},
    {"an empty until", shear, "{shear_strain: 0.1}", "@{}", "test.until is empty", "shear_strain"},
    {"no drainage", triaxial, "  drainage: undrained\n", "", "'test.drainage' is missing", "drained, undrained"},
    {"no axial rate", triaxial, "  axial_rate: 0.01 1/s\n", "", "'test.axial_rate' is missing", "a rate [1/s]"},
    {"no kappa", cell, "  kappa: [{from: 10 1/s, to: 50 1/s, over: 0.1 s}]\n", "", "'test.kappa' is missing",
     "dv_x/dz"},
    {"half a piece", cell, "{from: 10 1/s, to: 50 1/s, over: 0.1 s}", "@{from: 10 1/s, over: 0.1 s}",
     "'test.kappa.0.to' is missing", "a rate [1/s]"},
    {"no spin", rotation, "  spin: 1 rad/s\n", "", "'test.spin' is missing", "rad/s"},
    {"no matrix", point, "  L: [[0, 0, 1], [0, 0, 0], [0, 0, 0]] 1/s\n", "", "'test.L' is missing", "by rows"},
    {"no stress at a point", point, "  stress: {xx: -50 kPa, yy: -50 kPa, zz: -100 kPa, xz: 5 kPa}\n", "",
     "'test.pressure' is missing", "a pressure [Pa]"},
    {"a normal stress forgotten", rotation, "{xx: -50 kPa, yy: -50 kPa, zz: -100 kPa}", "@{xx: -50 kPa, zz: -100 kPa}",
     "'test.initial.stress.yy' is missing", "a pressure [Pa]"},
    {"no step for euler", elastic, "{method: euler, step: 1e-4}", "@{method: euler}", "'integrator.step' is missing",
     "step: 1e-4"},
    {"no column in an expectation", shear, "{run: run, column: shear_stress, at", "@{run: run, at",
     "'expect.0.column' is missing", "column"},
    {"no value in an expectation", shear, "{run: run, column: shear_stress, at: end, value: 10 kPa,",
     "@{run: run, column: shear_stress, at: end,", "'expect.0.value' is missing", "unit"},
    {"no tolerance in an expectation", shear, "{run: run, column: shear_stress, at: end, value: 10 kPa, within: 10}",
     "@{run: run, column: shear_stress, at: end, value: 10 kPa}", "'expect.0.within' is missing", "relative"},
    {"no y in a comparison", shear,
     "{data: data.csv, x: {data: strain, unit: percent, run: shear_strain}, y: {data: tau, unit: kPa, run: "
     "shear_stress}}",
     "@{data: data.csv, x: {data: strain, unit: percent, run: shear_strain}}", "'compare.0.y' is missing", "map"},
    {"no unit in an axis", shear, "{data: tau, unit: kPa, run: shear_stress}", "@{data: tau, run: shear_stress}",
     "'compare.0.y.unit' is missing", "kPa"},
};

const std::vector<Bad> shapes{
    {"lists of unequal length", cell, "[0.0018 kg/m, 0.0065 kg/m]", "@[1, 2, 3] kg/m", "'k_v' has 3 values",
     "sweep: product"},
    {"an expectation with another length", cell, "test:",
     "expect: [{column: pressure, value: @[1, 2, 3] Pa, within: 1}]\ntest:", "'value' has 3 values", "equally long"},
    {"a list of expected values for one run", shear, "value: 10 kPa", "value: @[10, 20] kPa", "'value' is a list of 2",
     "--set 'expect=[]'"},
    {"an empty list", cell, "[1.169, 0.908]", "@[]", "'void_ratio' is an empty list", "at least one value"},
    {"an empty programme", cell, "[{from: 10 1/s, to: 50 1/s, over: 0.1 s}]", "@[]", "'kappa' is an empty list",
     "at least"},
    {"a matrix for a number", shear, "pressure: 100 kPa", "pressure: @[[1, 2], [3, 4]] kPa",
     "test.initial.pressure is a list", "a pressure [Pa]"},
    {"a number for a matrix", point, "[[0, 0, 1], [0, 0, 0], [0, 0, 0]] 1/s", "@0.01 1/s", "test.L", "3 by 3"},
    {"a list for a matrix", point, "[[0, 0, 1], [0, 0, 0], [0, 0, 0]] 1/s", "[@0, 0, 1] 1/s", "test.L", "three rows"},
    {"a matrix of two rows", point, "[[0, 0, 1], [0, 0, 0], [0, 0, 0]] 1/s", "@[[0, 0, 1], [0, 0, 0]] 1/s", "test.L",
     "3 by 3"},
    {"a row of two", point, "[[0, 0, 1], [0, 0, 0], [", "[[0, 0, 1], @[0, 0], [", "test.L", "3 by 3"},
    {"a map for a number", shear, "pressure: 100 kPa", "pressure: @{value: 100 kPa}", "test.initial.pressure is a map",
     "a pressure [Pa]"},
    {"a map for a rate", shear, "shear_rate: 0.01 1/s", "shear_rate: @{from: 0 1/s, to: 1 1/s, over: 1 s}",
     "test.shear_rate is a map", "a rate [1/s]"},
    {"a number for a map", shear, "{shear_strain: 0.1}", "@0.1", "test.until is '0.1'", "map"},
    {"a word for a map", elastic, "{law: elastic, K: 20 MPa, G: 10 MPa}", "@elastic", "material is 'elastic'", "map"},
    {"a list for a map", shear, "{pressure: 100 kPa, void_ratio: 0.845}", "@[{pressure: 100 kPa}]",
     "test.initial is a list", "map"},
    {"a map for a word", shear, "hold: volume", "hold: @{volume: true}", "test.hold is a map", "one of: volume"},
    {"a map for a list", shear, "expect:\n  - {run", "expect:\n  @{run", "expect is a map", "[a, b]"},
    {"a word in a list of maps", shear,
     "expect:\n  - {run: run, column: shear_stress, at: end, value: 10 kPa, within: 10}", "expect: [@shear_stress]",
     "expect.0 is 'shear_stress'", "map"},
    {"a list for a title", shear, "title: Undrained simple shear", "title: @[a, b]", "title is a list", "text"},
    {"a word for a flag", shear, "{data: data.csv,", "{optional: @yes, data: data.csv,", "compare.0.optional", "true"},
    {"a list in the output", shear, "{every: {shear_strain: 0.01}}", "{every: {shear_strain: @[0.01, 0.02]}}",
     "output.every.shear_strain is a list", "plain number"},
    {"a sweep that is neither", cell, "test:", "sweep: @cartesian\ntest:", "sweep is 'cartesian'", "zip"},
    {"no map at all", shear, "", "@- 1\n- 2\n", "not an element test", "title, material, test"},
};

const std::vector<Bad> choices{
    {"law", elastic, "law: elastic", "law: @elastik", "material.law = 'elastik'", "did you mean 'elastic'?"},
    {"material", shear, "peng2016_table1", "@peng2016_tabel1", "no material is called 'peng2016_tabel1'",
     "did you mean 'peng2016_table1'?"},
    {"a material by its path", shear, "peng2016_table1", "@../peng2016_table1.yaml", "no material is called", ""},
    {"kind", shear, "simple_shear\n", "@simple_sheer\n", "test.kind = 'simple_sheer'", "did you mean 'simple_shear'?"},
    {"method", held, "method: bdf", "method: @bdff", "integrator.method = 'bdff'", "did you mean 'bdf'?"},
    {"hold", shear, "hold: volume", "hold: @volumes", "test.hold = 'volumes'", "did you mean 'volume'?"},
    {"drainage", triaxial, "drainage: undrained", "drainage: @undraind", "test.drainage", "did you mean 'undrained'?"},
    {"mode", triaxial, "mode: compression", "mode: @compresion", "test.mode", "did you mean 'compression'?"},
    {"state", shear, "rtol: 1e-9", "rtol: 1e-9, state: @log", "integrator.state", "logarithmic"},
    {"a kind of later versions", shear, "simple_shear\n", "@oedometer\n",
     "'oedometer' is not available in this version", "available: simple_shear"},
    {"another kind of later versions", shear, "simple_shear\n", "@infinite_slope\n",
     "'infinite_slope' is not available", "available: simple_shear"},
    {"cyclic loading", triaxial, "axial_rate: 0.01 1/s", "@cyclic: {amplitude_q: 30 kPa, cycles: 10}",
     "test.cyclic is not available", "axial_rate"},
    {"expected column", shear, "column: shear_stress", "@column: shear_stres", "no column 'shear_stres'",
     "did you mean 'shear_stress'?"},
    {"a column of another law", elastic,
     "test:", "expect: [{@column: I_e, value: 1, within: 1}]\ntest:", "no column 'I_e'", "known: time"},
    {"a column of another kind", shear, "column: shear_stress", "@column: axial_strain", "no column 'axial_strain'",
     ""},
    {"expected unit", shear, "value: 10 kPa", "value: @10 m", "expect.0.value", "Pa"},
    {"expected value without unit", shear, "value: 10 kPa", "value: @10", "expect.0.value", "a pressure [Pa]"},
    {"tolerance in another unit", shear, "within: 10", "within: @10 m", "expect.0.within", "Pa"},
    {"expected run", shear, "run: run,", "run: @runn,", "no run is called 'runn'", "did you mean 'run'?"},
    {"expected place", shear, "at: end", "at: @ned", "expect.0.at", "did you mean 'end'?"},
    {"two places", shear, "at: end", "at: @{shear_strain: 0.1, time: 1 s}", "exactly one column", "shear_strain: 0.1"},
    {"a place in an unknown column", shear, "at: end", "at: {@shear_srain: 0.1}", "no column 'shear_srain'",
     "did you mean 'shear_strain'?"},
    {"a place in the wrong unit", shear, "at: end", "at: {shear_strain: @0.1 s}", "expect.0.at.shear_strain", "unit"},
    {"a place in time without unit", shear, "at: end", "at: {time: @3}", "expect.0.at.time", "a time [s]"},
    {"compared column of the run", shear, "run: shear_stress}", "@run: shear_sress}", "no column 'shear_sress'",
     "did you mean 'shear_stress'?"},
    {"compared column of the data", shear, "{data: tau,", "{@data: tua,", "the data file has no column 'tua'",
     "did you mean 'tau'?"},
    {"compared unit", shear, "unit: kPa", "@unit: mm",
     "compare.0.y.unit = 'mm' does not fit column 'shear_stress' [Pa]", "kPa"},
    {"compared sign", shear, "unit: kPa", "unit: kPa, sign: @-2", "sign must be 1 or -1", "convention"},
    {"a data file that is not there", shear, "{data: data.csv", "{@data: dat.csv", "there is no file 'dat.csv'",
     "optional: true"},
    {"no row selected", shear, "{data: data.csv,", "{data: data.csv, where: {column: tau, @equals: 77},",
     "no row has tau = 77", "empty"},
    {"selecting by an unknown column", shear, "{data: data.csv,",
     "{data: data.csv, where: {@column: tests, equals: 1},", "no column 'tests'", "did you mean 'test'?"},
    {"a role that there is not", shear, "{data: data.csv,", "{role: @validated, data: data.csv,", "compare.0.role",
     "did you mean 'validation'?"},
};

const std::vector<Bad> physics{
    {"the rate ends at zero before the strain", elastic, "to: 1 1/s, over: 1 s}]",
     "to: 0 1/s, over: 1 s}, {from: 1 1/s, to: 0 1/s, over: 1 s}]\n  until: {@shear_strain: 5}", "never reached",
     "lengthen the programme"},
    {"zero rate", shear, "shear_rate: 0.01 1/s", "shear_rate: @0 1/s", "test.shear_rate is zero",
     "different from zero"},
    {"a programme of zeros", elastic, "[{from: 0 1/s, to: 1 1/s, over: 1 s}]", "@[{from: 0 1/s, to: 0 1/s, over: 1 s}]",
     "zero throughout", "different from zero"},
    {"the end comes before the rate", elastic, "[{from: 0 1/s, to: 1 1/s, over: 1 s}]",
     "[{from: 0 1/s, to: 0 1/s, over: 5 s}, {from: 0 1/s, to: 1 1/s, over: 1 s}]\n  @until: {time: 2 s}", "still zero",
     "last longer"},
    {"tensile stress", rotation, "xx: -50 kPa", "xx: 50 kPa", "not compressive", "compression is negative"},
    {"a principal stress in tension", point, "xz: 5 kPa", "xz: 90 kPa", "not compressive", "tension positive"},
    {"not axisymmetric", triaxial, "pressure: 100 kPa", "stress: {xx: -50 kPa, yy: -60 kPa, zz: -100 kPa}",
     "not axisymmetric", "xx = yy"},
    {"shear in a triaxial test", triaxial, "pressure: 100 kPa",
     "stress: {xx: -50 kPa, yy: -50 kPa, zz: -100 kPa, xz: 1 kPa}", "not axisymmetric", "no shear"},
    {"a jump of the normal stress", held, "  normal_stress: 100 kPa", "  @normal_stress: 200 kPa", "jump",
     "make them equal"},
    {"drained test of a law without history", triaxial,
     "{use: karlsruhe_fine_sand}\ntest:\n  kind: triaxial\n  drainage: undrained\n  mode: compression\n  initial: "
     "{pressure: 100 kPa, void_ratio: 0.9}",
     "{law: newtonian, eta: 1 Pa s, K: 1 MPa}\ntest:\n  kind: triaxial\n  @drainage: drained\n  mode: compression",
     "no stress history", "undrained"},
    {"a pressure ratio without a pressure", elastic, "pressure: 100 kPa}",
     "pressure: 0 Pa}\n  until: {@pressure_ratio: 0.5}", "test.until.pressure_ratio", "without a pressure"},
};

const std::vector<Bad> yaml{
    {"a bracket that stays open", shear, "{shear_strain: 0.1}", "@{shear_strain: 0.1", "never closed", "'}'"},
    {"a quote that stays open", shear, "title: Undrained", "title: @\"Undrained", "never closed", "close it"},
    {"a tab", shear, "  hold: volume", "@\thold: volume", "tab", "spaces"},
    {"a colon in a text", shear, "source: nobody", "source: Peng: Acta", "not valid YAML", "quotes"},
    {"wrong indentation", shear, "  hold: volume", "    hold@: volume", "not valid YAML", "indentation"},
    {"a key twice", shear, "  hold: volume", "  hold: volume\n  @hold: volume", "the key 'hold' is given twice",
     "already given at"},
    {"a key twice in one line", shear, "{pressure: 100 kPa,", "{pressure: 100 kPa, @pressure: 50 kPa,",
     "the key 'pressure' is given twice", "keep one"},
    {"a key twice at the root", shear, "source: nobody", "source: nobody\n@title: b", "the key 'title' is given twice",
     "already given at"},
    {"two documents", shear, "test:", "@---\ntest:", "several documents", "one file"},
    {"an anchor", shear, "pressure: 100 kPa", "pressure: @&p 100 kPa", "anchors", "write the value out"},
    {"an alias", shear, "pressure: 100 kPa", "pressure: @*p", "aliases", "write the value out"},
    {"a merge key", shear, "  hold: volume", "  @<<: {hold: volume}", "merge keys", "write the keys out"},
    {"a tag", shear, "pressure: 100 kPa", "pressure: @!pressure 100 kPa", "tags", "remove the tag"},
    {"a type tag", shear, "void_ratio: 0.845", "void_ratio: @!!float 0.845", "tags", "remove the tag"},
    {"a list as a key", shear, "source: nobody", "@[a, b]: nobody", "a key must be a word", "key: value"},
    {"a text behind a value", shear, "pressure: 100 kPa", "pressure: \"100 kPa\" @x", "", ""},
    {"a control character", shear, "source: nobody", "source: nob@\x04ody", "control character", "remove"},
    {"no UTF-8", shear, "source: nobody", "source: M@\xFCller", "UTF-8", "save the file"},
};

/// Where '@' stands, as "file:line:column: ", and the text without it.
std::string take_mark(std::string& text) {
  const auto at = text.find('@');
  if (at == std::string::npos) return "test.yaml:";
  text.erase(at, 1);
  const auto line = std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n') + 1;
  const auto before = text.rfind('\n', at == 0 ? 0 : at - 1);
  const auto column = before == std::string::npos || at == 0 ? at + 1 : at - before;
  return "test.yaml:" + std::to_string(line) + ":" + std::to_string(column) + ": error: ";
}

void check_all(const std::vector<Bad>& cases) {
  for (const auto& bad : cases) {
    std::string text = edited(bad.file, bad.from, bad.to);
    const std::string place = take_mark(text);
    INFO(bad.what << "\n" << text);
    const Folder folder;
    folder.write("test.yaml", text);
    folder.write("data.csv", "test,strain,tau\n1,0,0\n1,5,12\n2,10,14\n");
    for (const Words& words : {Words{"check", "test.yaml"}, Words{"element", "test.yaml", "--out", "results"}}) {
      const auto run = grainlaw(folder, words);
      CHECK(run.code == 2);
      CHECK(run.out == "");
      CHECK_THAT(run.err, StartsWith(place));
      CHECK_THAT(run.err, Contains(bad.key));
      CHECK_THAT(run.err, Contains(bad.help));
      CHECK_THAT(run.err, Contains(" | ") && Contains("^") && Catch::Matchers::EndsWith("\n"));
      CHECK(folder.content() == std::set<std::string>{"data.csv", "test.yaml"});
    }
  }
}

}  // namespace

TEST_CASE("The files that are made wrong below are right", "[input][program]") {
  for (const auto* text : {&shear, &held, &elastic, &cell, &triaxial, &rotation, &point}) {
    const Folder folder;
    folder.write("test.yaml", *text);
    folder.write("data.csv", "test,strain,tau\n1,0,0\n1,5,12\n2,10,14\n");
    const auto run = grainlaw(folder, {"check", "test.yaml"});
    INFO(*text << run.err);
    CHECK(run.code == 0);
  }
}

TEST_CASE("Wrong units and numbers", "[input][program]") { check_all(units); }
TEST_CASE("Values out of range", "[input][program]") { check_all(ranges); }
TEST_CASE("Unknown keys", "[input][program]") { check_all(unknown); }
TEST_CASE("Keys that would change nothing", "[input][program]") { check_all(inert); }
TEST_CASE("Missing keys", "[input][program]") { check_all(missing); }
TEST_CASE("Lists, maps and scalars in the wrong place", "[input][program]") { check_all(shapes); }
TEST_CASE("Unknown choices", "[input][program]") { check_all(choices); }
TEST_CASE("Tests that make no sense", "[input][program]") { check_all(physics); }
TEST_CASE("Broken YAML", "[input][program]") { check_all(yaml); }

TEST_CASE("Wrong data files are named with the place in them", "[input][program]") {
  struct {
    std::string data, says;
  } const cases[]{
      {"", "data.csv: error: there is no header line"},
      {"# nothing\n", "data.csv: error: there is no header line"},
      {"strain,tau\n", "data.csv: error: there is no row of numbers"},
      {"strain,tau\n0,0\n1\n", "data.csv:3:1: error: 1 values under 2 column names"},
      {"strain,tau\n0,0\n1,2,3\n", "data.csv:3:1: error: 3 values under 2 column names"},
      {"# c\nstrain,tau\n0,0\n1, x\n", "data.csv:4:4: error: this is not a number, but column 'tau'"},
      {"strain,tau\n0,\n", "data.csv:2:3: error: this is not a number, but column 'tau'"},
      {"strain,tau\nnan,1\n", "data.csv:2:1: error: this is not a number, but column 'strain'"},
  };
  for (const auto& each : cases) {
    const Folder folder;
    folder.write("test.yaml", shear);
    folder.write("data.csv", each.data);
    const auto run = grainlaw(folder, {"element", "test.yaml"});
    INFO(each.data);
    CHECK(run.code == 2);
    CHECK_THAT(run.err, Contains(each.says));
    CHECK(folder.content() == std::set<std::string>{"data.csv", "test.yaml"});
  }
}

TEST_CASE("A wrong --set is shown as it was typed", "[input][program]") {
  struct {
    std::string set, place, key, help;
  } const cases[]{
      {"test.initial.pressure=100", "--set:1:23: error: ", "test.initial.pressure = '100' has no unit", "Pa"},
      {"test.initial.pressure=-5 kPa", "--set:1:23: error: ", "test.initial.pressure", "above 0 Pa"},
      {"test.initial.presure=5 kPa", "--set:1:14: error: ", "unknown key 'test.initial.presure'",
       "did you mean 'pressure'?"},
      {"tests.hold=volume", "--set:1:1: error: ", "unknown key 'tests'", "did you mean 'test'?"},
      {"test.initial.pressure", "--set:1:1: error: ", "no '='", "key.path=value"},
      {"test.initial.pressure=", "--set:1:23: error: ", "no value", "key.path=value"},
      {"=5", "--set:1:1: error: ", "a key is missing", "key.path=value"},
      {"test..pressure=5", "--set:1:6: error: ", "a key is missing", "key.path=value"},
      {"test.hold.x=1", "--set:1:11: error: ", "'test.hold' is 'volume'", "set 'test.hold' itself"},
      {"expect.3.value=1 Pa", "--set:1:8: error: ", "no entry '3'", "0 to 0"},
      {"test.until={shear_strain: 1", "--set:1:12: error: ", "never closed", "'}'"},
      {"material.law=hypoplastik", "--set:1:14: error: ", "material.law", "did you mean 'hypoplastic'?"},
  };
  for (const auto& each : cases) {
    const Folder folder;
    folder.write("test.yaml", edited(shear, "{data: data.csv,", "{optional: true, data: data.csv,"));
    const auto run = grainlaw(folder, {"element", "test.yaml", "--set", each.set});
    INFO(each.set);
    CHECK(run.code == 2);
    CHECK_THAT(run.err, StartsWith(each.place) && Contains(each.key) && Contains(each.help) && Contains("^"));
    CHECK(folder.content() == std::set<std::string>{"test.yaml"});
  }
}

TEST_CASE("Misuse of the command line", "[input][program]") {
  struct {
    Words words;
    std::string says;
  } const cases[]{
      {{}, "commands: element, check"},
      {{"elment", "good.yaml"}, "did you mean 'element'?"},
      {{"element"}, "FILE"},
      {{"element", "good.yaml", "--quite"}, "did you mean '--quiet'?"},
      {{"element", "good.yaml", "--ot=x"}, "did you mean '--out'?"},
      {{"--verson"}, "did you mean '--version'?"},
      {{"element", "good.yaml", "--out"}, "--out"},
      {{"element", "good.yaml", "--set"}, "--set"},
      {{"element", "missing.yaml"}, "missing.yaml: error: there is no such file"},
      {{"element", "folder"}, "folder: error: this is a directory"},
      {{"element", "empty.yaml"}, "empty.yaml: error: there is nothing in it"},
      {{"element", "comment.yaml"}, "comment.yaml: error: there is nothing in it"},
      {{"element", "good.yaml", "missing.yaml"}, "missing.yaml: error: there is no such file"},
      {{"element", "good.yaml", "folder/good.yaml"}, "'good.yaml' and 'folder/good.yaml' would write to the same"},
      {{"element", "good.yaml", "--out", "comment.yaml"}, "comment.yaml"},
      {{"element", "good.yaml", "--out", "comment.yaml/x"}, "comment.yaml/x"},
      {{"element", "good.yaml", "--out", "/proc/grainlaw"}, "/proc/grainlaw"},
      {{"check"}, "FILE"},
      {{"check", "missing.yaml"}, "missing.yaml: error: there is no such file"},
      {{"laws", "elastik"}, "did you mean 'elastic'?"},
      {{"laws", "elastic", "bagnold"}, "bagnold"},
      {{"materials", "peng2016_tabel1"}, "did you mean 'peng2016_table1'?"},
      {{"plot"}, "DIR"},
      {{"plot", "missing"}, "missing"},
      {{"plot", "folder"}, "summary.json"},
  };
  for (const auto& each : cases) {
    const Folder folder;
    folder.write("good.yaml", point);
    folder.write("folder/good.yaml", point);
    folder.write("empty.yaml", "");
    folder.write("comment.yaml", "# nothing\n\n");
    const auto before = folder.content();
    const auto run = grainlaw(folder, each.words);
    INFO("grainlaw " + (each.words.empty() ? "" : each.words[0] + " ... " + each.words.back()));
    CHECK(run.code == 2);
    CHECK_THAT(run.err, Contains(each.says) && Catch::Matchers::EndsWith("\n"));
    CHECK(folder.content() == before);
  }
}

TEST_CASE("One wrong file among several keeps all of them from running", "[input][program]") {
  const Folder folder;
  folder.write("a.yaml", point);
  folder.write("b.yaml", edited(point, "void_ratio: 0.845", "void_ratio: 0"));
  const auto run = grainlaw(folder, {"element", "a.yaml", "b.yaml"});
  CHECK(run.code == 2);
  CHECK_THAT(run.err, StartsWith("b.yaml:5:15: error: "));
  CHECK(folder.content() == std::set<std::string>{"a.yaml", "b.yaml"});
}

TEST_CASE("A material file with an error is shown at its own place", "[input][program]") {
  const Folder folder;
  folder.write("test.yaml", edited(elastic, "{law: elastic, K: 20 MPa, G: 10 MPa}", "{use: mine}"));
  folder.write("mine.yaml", "law: elastic\nparameters:\n  K: 20 MPa\n  G: 10 m\n");
  auto run = grainlaw(folder, {"element", "test.yaml"});
  CHECK(run.code == 2);
  CHECK_THAT(run.err, Contains("mine.yaml:4:6: error: ") && Contains("kPa"));
  folder.write("mine.yaml", "law: elastic\nparameters:\n  K: 20 MPa\n  H: 10 MPa\n");
  run = grainlaw(folder, {"element", "test.yaml"});
  CHECK(run.code == 2);
  CHECK_THAT(run.err, Contains("mine.yaml:4:3: error: unknown key 'parameters.H'"));
  CHECK(folder.content() == std::set<std::string>{"mine.yaml", "test.yaml"});
}
