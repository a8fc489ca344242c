// SPDX-License-Identifier: BSD-3-Clause
// Right inputs, written by the letter of the contract and run through the program.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "program.hpp"

using namespace program;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

const std::string shear = R"(title: Undrained simple shear
source: nobody
material: {law: hypoplastic_bagnold, use: peng2016_table1}
test:
  kind: simple_shear
  hold: volume
  initial: {pressure: 100 kPa, void_ratio: 0.845}
  shear_rate: 0.01 1/s
  until: {shear_strain: 0.1}
integrator: {method: auto, rtol: 1e-9, atol: 1e-6 Pa}
output: {every: {shear_strain: 0.01}}
)";

/// Every kind of test, as the contract spells it.
const std::map<std::string, std::string> kinds{
    {"simple_shear", shear},
    {"simple_shear_held", R"(material: {use: peng2016_table1}
test:
  kind: simple_shear
  hold: normal_stress
  normal_stress: 100 kPa
  initial: {pressure: 100 kPa, void_ratio: 0.845}
  shear_rate: [{from: 0 1/s, to: 0.01 1/s, over: 2 s}, {from: 0.01 1/s, to: 0.01 1/s, over: 4 s}]
output: {every: {time: 0.5 s}}
)"},
    {"annular_shear_cell", R"(material: {use: peng2016_table2}
test:
  kind: annular_shear_cell
  void_ratio: [1.169, 0.908]
  k_v: [0.0018 kg/m, 0.0065 kg/m]
  initial: {pressure: 500 Pa}
  kappa: [{from: 10 1/s, to: 10 1/s, over: 0.1 s}, {from: 10 1/s, to: 50 1/s, over: 0.2 s}]
)"},
    {"annular_shear_cell_fraction", R"(material: {use: peng2016_table2}
test:
  kind: annular_shear_cell
  solid_fraction: [0.461, 0.524]
  k_v: [0.0018, 0.0065] kg/m
  initial: {pressure: 500 Pa}
  kappa: [{from: 10 1/s, to: 50 1/s, over: 0.2 s}]
)"},
    {"annular_shear_cell_formula",
     R"(material: {use: peng2016_table2, k_v: {rho_s: 1095 kg/m^3, d: 1 mm, A: 0.016, C_max: 0.61}}
test:
  kind: annular_shear_cell
  solid_fraction: 0.524
  initial: {pressure: 500 Pa}
  kappa: 10 1/s
  until: {time: 0.1 s}
)"},
    {"triaxial_undrained_compression", R"(material: {use: karlsruhe_fine_sand}
test: {kind: triaxial, drainage: undrained, mode: compression, axial_rate: 0.01 1/s,
  initial: {pressure: [100, 200] kPa, void_ratio: 0.9}, until: {axial_strain: 0.05}}
)"},
    {"triaxial_undrained_extension", R"(material: {use: karlsruhe_fine_sand}
test: {kind: triaxial, drainage: undrained, mode: extension, axial_rate: 1 %/min,
  initial: {pressure: 100 kPa, void_ratio: 0.9}, until: {axial_strain: 5 %}}
)"},
    {"triaxial_drained_compression", R"(material: {use: karlsruhe_fine_sand}
test: {kind: triaxial, drainage: drained, mode: compression, axial_rate: 0.01 1/s,
  initial: {stress: {xx: -100 kPa, yy: -100 kPa, zz: -150 kPa}, void_ratio: 0.9}, until: {axial_strain: 0.05}}
output: {every: {axial_strain: 1e-3}}
)"},
    {"triaxial_drained_extension", R"(material: {use: karlsruhe_fine_sand}
test: {kind: triaxial, drainage: drained, mode: extension, axial_rate: 0.01 1/s,
  initial: {pressure: 100 kPa, void_ratio: 0.9}, until: {time: 2 s}}
)"},
    {"calibrated", R"(material: {use: karlsruhe_fine_sand, calibrate: {E_over_p: 120, nu: 0, phi: 31 deg, psi: 0 deg}}
test: {kind: triaxial, drainage: drained, axial_rate: 0.01 1/s,
  initial: {pressure: 100 kPa, void_ratio: [0.8, 0.95]}, until: {axial_strain: 0.05}}
)"},
    {"pure_rotation", R"(material: {law: elastic, K: 20 MPa, G: 10 MPa}
test: {kind: pure_rotation, spin: 1 rad/s, revolutions: 1, initial: {stress: {xx: -50 kPa, xz: 10 kPa}}}
)"},
    {"pure_rotation_of_sand", R"(material: {use: peng2016_table1}
test:
  kind: pure_rotation
  spin: 90 deg/s
  revolutions: 0.5
  initial: {stress: {xx: -50 kPa, yy: -60 kPa, zz: -100 kPa}, void_ratio: 0.845}
)"},
    {"point", R"(material: {use: peng2016_table1}
test:
  kind: point
  stress: {xx: -50 kPa, yy: -50 kPa, zz: -100 kPa, xz: 5 kPa}
  void_ratio: 0.845
  L: [[0, 0, 0.01], [0, 0, 0], [0, 0, 0]] 1/s
)"},
    {"point_entry_by_entry", R"(material: {law: newtonian, eta: 1 Pa s, K: 1 MPa}
test:
  kind: point
  L:
    - [0 1/s, 0 1/s, 1 1/s]
    - [0 1/s, 0 1/s, 0 1/s]
    - [1 1/min, 0 1/s, 0 1/s]
)"},
    {"fluid", R"(material: {law: newtonian, eta: 1 Pa s, K: 1 MPa}
test: {kind: simple_shear, hold: volume, shear_rate: [1, 2] 1/s, until: {time: 1 s}}
)"},
    {"collisions", R"(material: {law: bagnold, k_v: [0.01, 0.02] kg/m, alpha_i: 35 deg}
test: {kind: simple_shear, hold: volume, shear_rate: 1 1/s, until: {time: 1 s}}
)"},
    {"methods", edited(shear, "method: auto, rtol: 1e-9, atol: 1e-6 Pa",
                       "method: [dp54, euler, rk4, heun, midpoint], step: 1e-4, rtol: 1e-8")},
    {"adaptive_methods", edited(shear, "method: auto", "method: [bdf, adams, bs32, dp54, auto]")},
    {"product", edited(edited(shear, "test:", "sweep: product\ntest:"), "{pressure: 100 kPa, void_ratio: 0.845}",
                       "{pressure: [50, 100] kPa, void_ratio: [0.9, 0.8, 0.7]}")},
    {"stress_ratio", edited(shear, "{shear_strain: 0.1}", "{pressure_ratio: 0.7}")},
    {"compared", shear + R"(compare:
  - {data: ../data/measured.csv, x: {data: gamma, unit: percent, run: shear_strain}, y: {data: tau, unit: kPa, run: shear_stress}, label: measured, optional: true}
  - data: ../data/measured.csv
    where: {column: test, equals: 2}
    x: {data: gamma, unit: "%", run: shear_strain}
    y: {data: sigma, unit: kPa, run: stress_zz, sign: -1}
  - {data: not_there.csv, optional: true, x: {data: a, run: shear_strain}, y: {data: b, unit: Pa, run: shear_stress}}
expect:
  - {column: shear_stress, at: end, value: 15 kPa, within: 0.5}
  - {run: run, column: pressure, at: {shear_strain: 0}, value: 100 kPa, within: 1 Pa, because: it starts there}
  - {column: shear_stress, at: peak, value: 16 kPa, within: 10 kPa}
)"},
};

const std::string measured = "# kPa\ntest,gamma,tau,sigma,remark\n1,1,5,90,a\n1,2,8,80,b\n2,3,9,70,c\n2,4,10,60,d\n";

/// A folder with one test in it, in a folder beside a data folder.
struct Case : Folder {
  explicit Case(const std::string& yaml) {
    write("tests/test.yaml", yaml);
    write("data/measured.csv", measured);
  }
  Outcome run(Words words = {}) const {
    words.insert(words.begin(), {"element", "tests/test.yaml", "--out", "results", "--no-plot"});
    return grainlaw(*this, words);
  }
  Json summary() const { return Json::parse(read(path / "results/summary.json")); }
  Table table(const std::string& name = "run") const { return Table(path / "results" / (name + ".csv")); }
};

bool has_gnuplot() {
  std::istringstream folders(std::getenv("PATH"));
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (fs::exists(fs::path(folder) / "gnuplot")) return true;
  }
  return false;
}

std::set<std::string> tables(const Folder& folder, const std::string& under) {
  std::set<std::string> names;
  for (const auto& name : folder.content(under)) {
    if (name.ends_with(".csv") && name.find('/') == std::string::npos) names.insert(name);
  }
  return names;
}

}  // namespace

TEST_CASE("Every kind of test is understood, and as_run.yaml runs again to the same tables", "[input][program]") {
  for (const auto& [name, yaml] : kinds) {
    INFO(name);
    const Case test(yaml);
    const auto check = grainlaw(test, {"check", "tests/test.yaml"});
    CHECK(check.code == 0);
    CHECK_THAT(check.out, Contains("fine"));
    const auto first = test.run();
    INFO(first.err);
    REQUIRE(first.code == 0);
    const auto again =
        grainlaw(test, {"element", "results/as_run.yaml", "--out", "elsewhere/again", "--no-plot", "--quiet"});
    INFO(again.err);
    REQUIRE(again.code == 0);
    REQUIRE(tables(test, "results") == tables(test, "elsewhere/again"));
    for (const auto& table : tables(test, "results"))
      CHECK(read(test / "results" / table) == read(test / "elsewhere/again" / table));
    // and once more from there: nothing is lost on the way
    const auto third =
        grainlaw(test, {"element", "elsewhere/again/as_run.yaml", "--out", "third", "--no-plot", "--quiet"});
    CHECK(third.code == 0);
    const auto body = [](const std::string& text) { return text.substr(text.find('\n')); };
    const std::string second_text = body(read(test / "elsewhere/again/as_run.yaml"));
    if (name != "compared") CHECK(body(read(test / "third/as_run.yaml")) == second_text);
  }
}

TEST_CASE("Runs are named by the last key of the first list and the value as typed", "[input][program]") {
  const auto names = [](const std::string& yaml) {
    const Case test(yaml);
    const auto run = test.run();
    INFO(yaml << run.err);
    REQUIRE(run.code == 0);
    Words list;
    const Json summary = test.summary();
    for (const auto& each : summary["runs"]) {
      list.push_back(each["name"]);
      CHECK(fs::exists(test / "results" / (each["csv"].get<std::string>())));
    }
    CHECK(tables(test, "results").size() == list.size());
    return list;
  };
  const auto with = [](const std::string& from, const std::string& to) { return edited(shear, from, to); };
  CHECK(names(shear) == Words{"run"});
  CHECK(names(with("0.845", "[0.890, 0.80]")) == Words{"void_ratio=0.890", "void_ratio=0.80"});
  CHECK(names(with("0.845", "[0.890]")) == Words{"void_ratio=0.890"});
  CHECK(names(with("100 kPa", "[100 kPa, 5e1  kPa]")) == Words{"pressure=100kPa", "pressure=5e1kPa"});
  CHECK(names(with("100 kPa", "[50, 100] kPa")) == Words{"pressure=50kPa", "pressure=100kPa"});
  CHECK(names(with("0.01 1/s", "[0.01, 0.1] 1/s")) == Words{"shear_rate=0.011/s", "shear_rate=0.11/s"});
  CHECK(names(with("{pressure: 100 kPa, void_ratio: 0.845}", "{pressure: [50, 100] kPa, void_ratio: [0.9, 0.8]}")) ==
        Words{"pressure=50kPa", "pressure=100kPa"});
  CHECK(names(with("peng2016_table1}", "peng2016_table1, c4: [1220.8, 1000]}")) == Words{"c4=1220.8", "c4=1000"});
  CHECK(names(with("{pressure: 100 kPa,", "{stress: {xx: [-50 kPa, -60 kPa], yy: -50 kPa, zz: -100 kPa},")) ==
        Words{"xx=-50kPa", "xx=-60kPa"});
  CHECK(names(with("law: hypoplastic_bagnold, use: peng2016_table1",
                   "use: peng2016_table1, law: [hypoplastic, hypoplastic_bagnold]")) ==
        Words{"law=hypoplastic", "law=hypoplastic_bagnold"});
  CHECK(names(kinds.at("product")) == Words{"pressure=50kPa,void_ratio=0.9", "pressure=50kPa,void_ratio=0.8",
                                            "pressure=50kPa,void_ratio=0.7", "pressure=100kPa,void_ratio=0.9",
                                            "pressure=100kPa,void_ratio=0.8", "pressure=100kPa,void_ratio=0.7"});
}

TEST_CASE("Zipped lists keep their partners", "[input][program]") {
  const Case test(kinds.at("annular_shear_cell"));
  REQUIRE(test.run().code == 0);
  CHECK(test.table("void_ratio=1.169").last("void_ratio [-]") == Approx(1.169));
  // the looser specimen has lost its skeleton: tau = k_v (dv_x/dz)^2 with dv_x/dz = 2 kappa = 100/s
  CHECK(test.table("void_ratio=1.169").last("shear_rate [1/s]") == Approx(100));
  CHECK(test.table("void_ratio=1.169").last("shear_stress [Pa]") == Approx(0.0018 * 1e4).epsilon(1e-3));
  CHECK(test.table("void_ratio=0.908").last("shear_stress [Pa]") > 0.0065 * 1e4);
}

TEST_CASE("A table begins with comments, then names with units in the order of the contract", "[input][program]") {
  const auto header = [](const std::string& kind, const std::string& run = "run") {
    const Case test(kinds.at(kind));
    REQUIRE(test.run().code == 0);
    const Table table = test.table(run);
    CHECK(!table.comments.empty());
    CHECK(read(test / "results" / (run + ".csv")).starts_with("# "));
    std::string joined;
    for (const auto& name : table.names) joined += (joined.empty() ? "" : ",") + name;
    for (const auto& row : table.rows) CHECK(row.size() == table.names.size());
    return joined;
  };
  const std::string stress =
      "stress_xx [Pa],stress_yy [Pa],stress_zz [Pa],stress_yz [Pa],stress_xz [Pa],stress_xy [Pa],pressure [Pa],q [Pa]";
  const std::string sheared = header("simple_shear");
  CHECK_THAT(sheared, Catch::Matchers::StartsWith("time [s],shear_strain [-],shear_rate [1/s]," + stress));
  for (const char* name : {"shear_stress [Pa]", "excess_pore_pressure [Pa]", "void_ratio [-]", "solid_fraction [-]",
                           "collisional_fraction [-]", "ln_trace [-]", "I_e [-]", "e_crt [-]"})
    CHECK_THAT(sheared, Contains(name));
  CHECK_THAT(sheared, !Contains("axial_strain") && !Contains("inertial_number") && !Contains("density"));
  const std::string held = header("simple_shear_held");
  CHECK_THAT(held, Contains("volumetric_strain [-]") && !Contains("excess_pore_pressure"));
  const std::string triaxial = header("triaxial_drained_compression");
  CHECK_THAT(triaxial, Contains("axial_strain [-],lateral_strain [-],volumetric_strain [-]") &&
                           !Contains("shear_strain") && !Contains("excess_pore_pressure") &&
                           !Contains("collisional_fraction"));
  CHECK_THAT(header("triaxial_undrained_extension"), Contains("excess_pore_pressure [Pa]"));
  CHECK_THAT(header("pure_rotation"), !Contains("void_ratio") && !Contains("ln_trace"));
  CHECK_THAT(header("fluid", "shear_rate=11_s"), !Contains("void_ratio") && !Contains("excess_pore_pressure"));
  CHECK_THAT(header("point"), Contains("rate_xx [Pa/s],rate_yy [Pa/s],rate_zz [Pa/s],rate_yz [Pa/s],rate_xz "
                                       "[Pa/s],rate_xy [Pa/s]"));
}

TEST_CASE("Numbers in a table read back to the bit", "[input][program]") {
  const Case test(edited(shear, "{shear_strain: 0.1}", "{shear_strain: 0.3}"));
  REQUIRE(test.run().code == 0);
  std::size_t digits = 0;
  for (const auto& row : test.table().rows) {
    for (const auto& cell : row) {
      char exact[64];
      std::snprintf(exact, sizeof exact, "%.17g", std::stod(cell));
      CHECK(std::stod(exact) == std::stod(cell));
      const auto count =
          std::count_if(cell.begin(), cell.begin() + std::ptrdiff_t(std::min(cell.find('e'), cell.size())),
                        [](char c) { return c >= '0' && c <= '9'; });
      digits = std::max(digits, std::size_t(count));
    }
  }
  CHECK(digits >= 16);
}

TEST_CASE("Signs and sums in a table", "[input][program]") {
  const Case drained(kinds.at("triaxial_drained_compression"));
  REQUIRE(drained.run().code == 0);
  const Table t = drained.table();
  CHECK(t.rows.size() == 51);
  CHECK(t.at(0, "q [Pa]") == Approx(50e3));
  for (std::size_t i = 0; i < t.rows.size(); ++i) {
    CHECK(t.at(i, "stress_xx [Pa]") == -100e3);
    CHECK(t.at(i, "q [Pa]") == Approx(t.at(i, "stress_xx [Pa]") - t.at(i, "stress_zz [Pa]")));
    CHECK(t.at(i, "axial_strain [-]") == Approx(-1e-3 * double(i)).margin(1e-15));
    CHECK(t.at(i, "volumetric_strain [-]") ==
          Approx(t.at(i, "axial_strain [-]") + 2 * t.at(i, "lateral_strain [-]")).margin(1e-15));
  }
  const Case extended(kinds.at("triaxial_drained_extension"));
  REQUIRE(extended.run().code == 0);
  CHECK(extended.table().last("q [Pa]") < 0);
  CHECK(extended.table().last("axial_strain [-]") == Approx(0.02));
  const Case undrained(kinds.at("simple_shear"));
  REQUIRE(undrained.run().code == 0);
  const Table u = undrained.table();
  CHECK(u.last("shear_strain [-]") == Approx(0.1));
  CHECK(u.last("shear_stress [Pa]") == u.last("stress_xz [Pa]"));
  CHECK(u.last("shear_stress [Pa]") > 0);
  CHECK(u.last("pressure [Pa]") > 0);
  CHECK(u.last("ln_trace [-]") == Approx(std::log(3 * u.last("pressure [Pa]"))).epsilon(1e-6));
}

TEST_CASE("A point gives one row, its matrix by rows", "[input][program]") {
  // simple shear and pure rotation differ by one entry: each must act where it was typed
  const Case test(edited(kinds.at("point_entry_by_entry"), "1 1/min", "-3 1/s"));
  REQUIRE(test.run().code == 0);
  const Table table = test.table();
  REQUIRE(table.rows.size() == 1);
  CHECK(table.at(0, "stress_xz [Pa]") == Approx(-2));  // eta (L_xz + L_zx)
  const Case elastic(R"(material: {law: elastic, K: 20 MPa, G: 10 MPa}
test: {kind: point, stress: {xx: -1 kPa}, L: [[1e-3, 0, 0], [0, 0, 2e-3], [0, 0, 0]] 1/s}
)");
  REQUIRE(elastic.run().code == 0);
  CHECK(elastic.table().at(0, "rate_xx [Pa/s]") == Approx(20e6 * 1e-3 + 2 * 10e6 * (2.0 / 3) * 1e-3));
  CHECK(elastic.table().at(0, "rate_yz [Pa/s]") == Approx(10e6 * 2e-3));
  CHECK(elastic.table().at(0, "rate_xz [Pa/s]") == 0);
}

TEST_CASE("--set overrides what the file says", "[input][program]") {
  const Case test(edited(shear, "0.845", "[0.9, 0.8]"));
  REQUIRE(test.run({"--set", "test.initial.void_ratio=0.7", "--set", "test.initial.pressure=50 kPa", "--set",
                    "output={rows: 7}", "--set", "material.k_v=0 kg/m"})
              .code == 0);
  const Table table = test.table();
  CHECK(table.rows.size() == 8);
  CHECK(table.at(0, "void_ratio [-]") == 0.7);
  CHECK(table.at(0, "pressure [Pa]") == Approx(50e3).epsilon(1e-12));
  const std::string as_run = read(test / "results/as_run.yaml");
  CHECK_THAT(as_run, Contains("pressure: 50 kPa") && Contains("void_ratio: 0.7") && Contains("k_v: 0 kg/m"));
  REQUIRE(test.run({"--set", "test.initial.void_ratio=[0.7, 0.6, 0.65]"}).code == 0);
  CHECK(fs::exists(test / "results/void_ratio=0.65.csv"));
  const Case expecting(kinds.at("compared"));
  CHECK(expecting.run({"--set", "expect.0.value=1 kPa", "--set", "expect.0.within=1e-6"}).code == 1);
  CHECK(expecting.run({"--set", "expect=[]", "--set", "compare=[]"}).code == 0);
}

TEST_CASE("An expectation that is missed gives exit code 1 and says by how much", "[input][program]") {
  const auto code = [](const std::string& entry) {
    const Case test(shear + "expect: [" + entry + "]\n");
    const auto run = test.run();
    INFO(entry << run.out << run.err);
    if (run.code == 1) {
      CHECK_THAT(run.out, Contains("NOT MET"));
      CHECK(test.summary()["exit_code"] == 1);
    }
    CHECK(run.err == "");
    return run.code;
  };
  // the pressure starts at 100 kPa
  CHECK(code("{column: pressure, at: {shear_strain: 0}, value: 100.5 kPa, within: 0.01}") == 0);
  CHECK(code("{column: pressure, at: {shear_strain: 0}, value: 100.5 kPa, within: 0.001}") == 1);
  CHECK(code("{column: pressure, at: {shear_strain: 0}, value: 100.5 kPa, within: 1 kPa}") == 0);
  CHECK(code("{column: pressure, at: {shear_strain: 0}, value: 100.5 kPa, within: 100 Pa}") == 1);
  CHECK(code("{column: time, at: {shear_strain: 0.055}, value: 5.5 s, within: 1e-9}") == 0);  // between two rows
  CHECK(code("{column: shear_strain, at: {time: 5.5 s}, value: 5.5 %, within: 1e-9}") == 0);
  CHECK(code("{column: time, at: end, value: 10 s, within: 1e-12}") == 0);
  CHECK(code("{column: time, value: 10 s, within: 1e-12}") == 0);
  // a percentage is relative, of dimensionless columns too: 0.11 is 10 % off 0.1
  CHECK(code("{column: shear_strain, at: end, value: 11 %, within: 11 %}") == 0);
  CHECK(code("{column: shear_strain, at: end, value: 11 %, within: 9 %}") == 1);
  CHECK(code("{column: pressure, at: {shear_strain: 0}, value: 100.5 kPa, within: 1 %}") == 0);
  CHECK(code("{column: shear_strain, at: end, value: 0.11, within: 0.5 %}") == 1);
  CHECK(code("{column: time, at: {shear_strain: 3}, value: 10 s, within: 10}") == 1);  // never reached
  const Case several(edited(shear, "0.845", "[0.890, 0.80]") +
                     "expect: [{run: void_ratio=0.80, column: void_ratio, at: end, value: 0.80, within: 1e-9}, "
                     "{column: void_ratio, at: end, value: [0.890, 0.80], within: [1e-9, 1e-6]}]\n");
  CHECK(several.run().code == 0);
  CHECK(several.summary()["expect"].size() == 3);
}

TEST_CASE("The peak of any column is its own, and a point has none", "[input][program]") {
  const Case test(edited(shear, "0.845", "0.80") +
                  "expect: [{column: excess_pore_pressure, at: peak, value: 1 Pa, within: 1e9}]\n");
  REQUIRE(test.run().code == 0);
  const double got = test.summary()["expect"][0]["got"];
  double largest = 0;
  const Table table = test.table();
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    largest = std::max(largest, table.at(i, "excess_pore_pressure [Pa]"));
  }
  // located between two rows: not below the largest row, and above it by less than the curvature of one row spacing
  CHECK(got >= largest);
  CHECK(got < 1.01 * largest);
}

TEST_CASE("Laws without a history start at a pressure, an elastic one from nothing", "[input][program]") {
  const Case fluid(R"(material: {law: newtonian, eta: 2 Pa s, K: 1 MPa}
test: {kind: simple_shear, initial: {pressure: 100 Pa}, shear_rate: 3 1/s, until: {shear_strain: 1}}
)");
  REQUIRE(fluid.run().code == 0);
  const Table flow = fluid.table();
  CHECK(flow.at(0, "pressure [Pa]") == Approx(100).epsilon(1e-12));  // K times p/K
  CHECK(flow.at(1, "shear_stress [Pa]") == 6);                       // eta gamma_dot
  const Case solid(R"(material: {law: elastic, K: 2 MPa, G: 1 MPa}
test: {kind: simple_shear, shear_rate: 1 1/s, until: {shear_strain: 1}}
)");
  REQUIRE(solid.run().code == 0);
  const Table sheared = solid.table();
  // sigma_xz = G sin(gamma) of the Jaumann rate, to a hundred times the default tolerance
  CHECK(sheared.at(sheared.rows.size() - 1, "shear_stress [Pa]") == Approx(1e6 * std::sin(1.0)).epsilon(1e-7));
}

TEST_CASE("A reversal under a held stress passes with every method", "[input][program]") {
  const Case test(R"(material: {law: hypoplastic, use: peng2016_table1}
test:
  kind: simple_shear
  hold: normal_stress
  initial: {pressure: 100 kPa, void_ratio: 0.8}
  shear_rate: [{from: 1 1/s, to: -1 1/s, over: 0.2 s}]
output: {rows: 20}
)");
  for (const char* method : {"auto", "bs32", "dp54", "ck54", "fehlberg54", "zonneveld43", "bdf", "adams"}) {
    INFO(method);
    REQUIRE(test.run({"--set", std::string("integrator={method: ") + method + "}"}).code == 0);
    const Table table = test.table();
    // the methods agree with each other to some hundred times the default tolerance of 1e-9
    CHECK(table.at(table.rows.size() - 1, "shear_stress [Pa]") == Approx(-46496.0582).epsilon(1e-7));
    CHECK(table.at(table.rows.size() - 1, "stress_zz [Pa]") == -100000);
  }
}

TEST_CASE("A numerical failure gives exit code 3 and keeps the rows", "[input][program]") {
  const std::string held = R"(material: {use: peng2016_table1}
test:
  kind: simple_shear
  hold: normal_stress
  initial: {pressure: 100 kPa, void_ratio: 0.95}
  shear_rate: 0.01 1/s
  until: {shear_strain: 1}
output: {rows: 50}
)";
  SECTION("a fixed step beyond the stability limit") {
    const Case test(held + "integrator: {method: euler, step: 0.02}\n");
    const auto run = test.run();
    CHECK(run.code == 3);
    CHECK_THAT(run.err, Contains("error: run 'run' stopped at t = ") && Contains("fixed step"));
    const Json summary = test.summary();
    CHECK(summary["exit_code"] == 3);
    CHECK(summary["runs"][0]["status"] == "failed");
    CHECK(test.table().rows.size() == summary["runs"][0]["rows"]);
    CHECK(test.table().at(0, "pressure [Pa]") == Approx(100e3));
  }
  SECTION("a stress that cannot be held; the other runs are done nevertheless") {
    const Case test(edited(held, "0.95", "[1.3, 0.8]"));
    const auto run = test.run();
    CHECK(run.code == 3);
    CHECK_THAT(run.err, Contains("error: run 'void_ratio=1.3' stopped") && Contains("cannot be held"));
    const Json summary = test.summary();
    CHECK(summary["runs"][0]["status"] == "failed");
    CHECK(summary["runs"][1]["status"] == "done");
    CHECK(fs::exists(test / "results/void_ratio=1.3.csv"));
    CHECK(test.table("void_ratio=0.8").last("shear_strain [-]") == Approx(1));
  }
  SECTION("a failure outweighs a missed expectation") {
    const Case test(edited(held, "0.95", "[1.3, 0.8]") +
                    "expect: [{column: shear_stress, at: end, value: 1 Pa, within: 1e-9}]\n");
    CHECK(test.run().code == 3);
  }
}

TEST_CASE("summary.json has the fields of the contract", "[input][program]") {
  const Case test(kinds.at("compared"));
  REQUIRE(test.run().code == 0);
  const Json summary = test.summary();
  for (const char* key :
       {"program", "version", "commit", "file", "kind", "exit_code", "wall_s", "cpu_s", "peak_memory_mb", "runs"})
    CHECK(summary.contains(key));
  CHECK(summary["program"] == "grainlaw");
  CHECK(summary["kind"] == "simple_shear");
  CHECK(summary["file"] == "test.yaml");
  CHECK(summary["exit_code"] == 0);
  CHECK(summary["peak_memory_mb"] > 1);
  for (const auto& run : summary["runs"]) {
    for (const char* key :
         {"name", "status", "method", "rhs_evaluations", "steps", "global_error_estimate", "peak", "final", "admit"})
      CHECK(run.contains(key));
    CHECK(run["name"] == "run");
    CHECK(run["status"] == "done");
    CHECK(run["method"] == "dp54");
    CHECK(run["rhs_evaluations"] > 10);
    CHECK(run["global_error_estimate"] < 1e-6);
    CHECK(run["final"]["shear_strain [-]"] == Approx(0.1));
  }
  CHECK(summary["expect"].size() == 3);
  CHECK(summary["compare"].size() == 2);
  CHECK_THAT(read(test / "results/measured/run_2_stress_zz.csv"), Contains("0.03,-70000"));
}

TEST_CASE("Output goes where the contract says", "[input][program]") {
  const Folder folder;
  folder.write("a.yaml", shear);
  folder.write("b.yaml", kinds.at("point"));
  SECTION("by default to out/<file stem>, with a report") {
    REQUIRE(grainlaw(folder, {"element", "a.yaml"}).code == 0);
    for (const char* name : {"run.csv", "as_run.yaml", "summary.json", "report.html"})
      CHECK(fs::exists(folder / "out/a" / name));
    CHECK_THAT(read(folder / "out/a/report.html"), !Contains("src=\"http"));
    if (has_gnuplot()) CHECK_THAT(read(folder / "out/a/report.html"), Contains("<svg"));
    CHECK(grainlaw(folder, {"plot", "out/a"}).code == 0);
  }
  SECTION("with --no-plot without one") {
    REQUIRE(grainlaw(folder, {"element", "a.yaml", "--no-plot", "--out", "x/y/z"}).code == 0);
    CHECK(folder.content("x/y/z") == std::set<std::string>{"run.csv", "as_run.yaml", "summary.json"});
  }
  SECTION("several files get a folder each and a summary of all") {
    const auto run = grainlaw(folder, {"element", "a.yaml", "b.yaml", "--out", "both"});
    REQUIRE(run.code == 0);
    for (const char* name :
         {"a/run.csv", "b/run.csv", "a/as_run.yaml", "b/summary.json", "summary.json", "report.html"})
      CHECK(fs::exists(folder / "both" / name));
    CHECK(Json::parse(read(folder / "both/summary.json"))["exit_code"] == 0);
  }
  SECTION("several files without --out go to out") {
    REQUIRE(grainlaw(folder, {"element", "a.yaml", "b.yaml", "--no-plot"}).code == 0);
    CHECK(fs::exists(folder / "out/a/run.csv"));
    CHECK(fs::exists(folder / "out/b/run.csv"));
    CHECK(fs::exists(folder / "out/summary.json"));
  }
  SECTION("other people's files stay") {
    folder.write("mine/notes.txt", "mine");
    folder.write("mine/other.csv", "mine");
    folder.write("mine/run.csv", "old");
    REQUIRE(grainlaw(folder, {"element", "a.yaml", "--no-plot", "--out", "mine"}).code == 0);
    CHECK(read(folder / "mine/notes.txt") == "mine");
    CHECK(read(folder / "mine/other.csv") == "mine");
    CHECK_THAT(read(folder / "mine/run.csv"), Contains("time [s]"));
  }
  SECTION("--quiet prints nothing") {
    const auto run = grainlaw(folder, {"element", "a.yaml", "b.yaml", "--quiet"});
    CHECK(run.code == 0);
    CHECK(run.out == "");
    if (has_gnuplot()) CHECK(run.err == "");
  }
  SECTION("without gnuplot the scripts are there and a message says what is missing") {
    const auto run = grainlaw(folder, {"element", "a.yaml"}, folder.path.string());
    CHECK(run.code == 0);
    CHECK_THAT(run.err, Contains("gnuplot"));
    CHECK(fs::exists(folder / "out/a/report.html"));
    const auto content = folder.content("out/a");
    CHECK(std::any_of(content.begin(), content.end(), [](const auto& name) { return name.ends_with(".gp"); }));
  }
}

TEST_CASE("An interrupted run leaves what it had, and exit code 130", "[input][program]") {
  const Folder folder;
  folder.write("long.yaml", edited(edited(edited(shear, "method: auto, rtol: 1e-9, atol: 1e-6 Pa",
                                                 "method: euler, step: 1e-8, error_estimate: false"),
                                          "{shear_strain: 0.1}", "{shear_strain: 100}"),
                                   "{every: {shear_strain: 0.01}}", "{every: {shear_strain: 1e-4}}"));
  Child child(folder.path, {"element", "long.yaml", "--out", "results", "--no-plot"});
  for (int i = 0; i < 500 && !fs::exists(folder / "results/run.csv"); ++i) usleep(10'000);
  usleep(300'000);
  child.interrupt();
  const auto run = child.wait();
  INFO(run.err);
  CHECK(run.code == 130);
  CHECK_THAT(run.err, Contains("interrupted"));
  const Table table(folder / "results/run.csv");
  REQUIRE(!table.rows.empty());
  for (const auto& row : table.rows) CHECK(row.size() == table.names.size());
  const Json summary = Json::parse(read(folder / "results/summary.json"));
  CHECK(summary["exit_code"] == 130);
  CHECK(summary["runs"][0]["status"] == "interrupted");
  CHECK(fs::exists(folder / "results/as_run.yaml"));
}

TEST_CASE("What the program knows can be asked", "[input][program]") {
  const Folder folder;
  const auto says = [&](const Words& words) {
    const auto run = grainlaw(folder, words);
    CHECK(run.code == 0);
    CHECK(run.err == "");
    return run.out;
  };
  CHECK_THAT(says({"laws"}), Contains("hypoplastic_bagnold") && Contains("elastic") && Contains("newtonian"));
  CHECK_THAT(says({"laws", "elastic"}), Contains("K") && Contains("[Pa]") && !Contains("newtonian"));
  CHECK_THAT(says({"laws", "--markdown"}), Contains("| parameter | unit |"));
  CHECK_THAT(says({"laws", "bagnold", "--markdown"}), Contains("| `k_v` | kg/m |"));
  CHECK_THAT(says({"materials"}), Contains("peng2016_table1") && Contains("karlsruhe_fine_sand"));
  CHECK_THAT(says({"materials", "peng2016_table2"}), Contains("c1") && Contains("source"));
  CHECK_THAT(says({"--version"}), Contains("grainlaw 0."));
  CHECK_THAT(says({"--help"}), Contains("element") && Contains("130"));
  CHECK(folder.content().empty());
}

TEST_CASE("A material of one's own, beside the test or in the folder materials", "[input][program]") {
  const std::string mine = "title: Mine\nlaw: elastic\nparameters: {K: 3 MPa, G: 1 MPa}\n";
  const std::string yaml =
      "material: {use: mine}\ntest: {kind: simple_shear, initial: {pressure: 1 kPa}, "
      "shear_rate: 1 1/s, until: {shear_strain: 0.001}}\n";
  for (const char* place : {"tests/mine.yaml", "tests/materials/mine.yaml", "materials/mine.yaml"}) {
    const Case test(yaml);
    test.write(place, mine);
    REQUIRE(test.run().code == 0);
    CHECK(test.table().last("shear_stress [Pa]") == Approx(1e3).epsilon(1e-5));
    // as_run.yaml does not need it any more
    fs::remove(test / place);
    REQUIRE(grainlaw(test, {"element", "results/as_run.yaml", "--out", "again", "--no-plot"}).code == 0);
    CHECK(read(test / "again/run.csv") == read(test / "results/run.csv"));
  }
  // a test that is called as its material is
  const Folder folder;
  folder.write("peng2016_table1.yaml", shear);
  CHECK(grainlaw(folder, {"check", "peng2016_table1.yaml"}).code == 0);
}
