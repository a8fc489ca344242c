// SPDX-License-Identifier: BSD-3-Clause
// The shipped element tests against measurement and against the published model. Misfits are stated, not hidden: a
// class that the law gets wrong is asserted to be wrong, so that an improvement is noticed.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>

#include "drivers/element/read_element.hpp"
#include "drivers/element/results.hpp"

using namespace grainlaw::element;

namespace {

struct Finished {
  ElementFile file;
  std::vector<RunRecord> records;
  const RunRecord& run(const std::string& name) const {
    return *std::find_if(records.begin(), records.end(), [&](const auto& r) { return r.name == name; });
  }
  ComparisonResult comparison(const std::string& name, const std::string& column) const {
    const auto c = std::find_if(file.comparisons.begin(), file.comparisons.end(),
                                [&](const auto& x) { return x.run == name && x.y.run == column; });
    REQUIRE(c != file.comparisons.end());
    return evaluate(*c, run(name));
  }
};

Finished finish(const std::string& name) {
  Finished all{read_element(std::filesystem::path(GRAINLAW_SOURCE) / "data/element" / name, {}), {}};
  for (const auto& test : all.file.tests) all.records.push_back(run(test));
  return all;
}

}  // namespace

TEST_CASE("every shipped element test runs and meets its expectations", "[validation]") {
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(GRAINLAW_SOURCE) / "data/element")) {
    INFO(entry.path().filename().string());
    const auto all = finish(entry.path().filename().string());
    for (const auto& r : all.records) CHECK(r.status == Status::done);
    for (const auto& e : all.file.expectations) {
      const auto result = evaluate(e, all.run(e.run));
      INFO(e.run << " " << e.column << ": got " << result.got << ", want " << e.value << ", because " << e.because);
      CHECK(result.met);
    }
  }
}

TEST_CASE("undrained compression of Karlsruhe sand: two of three blind classes are right, TMU5 is not",
          "[validation]") {
  // Classes of the measurements by the rule that the runs go through; TMU-MT1 and TMU-MT4 have a fitted void ratio and
  // are no validation. Misfits (rms of q over the largest measured q) documented in data/karlsruhe_fine_sand on
  // strains that favour the first percent: 0.13, 0.22, 0.21, 0.14, 0.09. On the logger's own strains they may be a
  // quarter larger.
  const auto all = finish("karlsruhe_undrained_triaxial.yaml");
  struct Row {
    const char *specimen, *measured, *computed;
    double misfit;
  };
  for (const auto& row :
       {Row{"TMU1", "dilative", "dilative", 0.13}, Row{"TMU6", "dilative", "dilative", 0.22},
        Row{"TMU5", "limited liquefaction", "dilative", 0.21}, Row{"TMU-MT1", "liquefaction", "liquefaction", 0.14},
        Row{"TMU-MT4", "liquefaction", "liquefaction", 0.09}}) {
    INFO(row.specimen);
    const std::string name = std::string("specimen=") + row.specimen;
    const auto c = all.comparison(name, "q");
    CHECK(c.response == row.measured);
    CHECK(all.run(name).response == row.computed);
    CHECK(c.rms / c.largest < 1.25 * row.misfit);
  }
}

TEST_CASE("drained compression of Karlsruhe sand keeps the misfit of its calibration", "[validation]") {
  // Documented misfits of q (rms over the measured maximum) at the end of the calibration: 8.5, 7.8, 8.8, 9.2 %, on
  // other strains than those of the logger rows; hence the factor 1.5.
  const auto all = finish("drained_triaxial.yaml");
  const std::map<std::string, double> documented{{"TMD1", 0.085}, {"TMD5", 0.078}, {"TMD10", 0.088}, {"TMD12", 0.092}};
  for (const auto& [specimen, misfit] : documented) {
    INFO(specimen);
    const auto c = all.comparison("specimen=" + specimen, "q");
    CHECK(c.used > 300);
    CHECK(c.rms / c.largest < 1.5 * misfit);
    const auto v = all.comparison("specimen=" + specimen, "volumetric_strain");
    CHECK(v.rms < 0.015);  // 1.5 percentage points; documented: 0.17 to 0.75
  }
}

TEST_CASE("the annular cell reproduces the scalings that Savage and Sayed report", "[validation]") {
  // Abstract of Savage & Sayed (1984): stresses go with the square of the shear rate at low solid fraction and high
  // rate; at high fraction and low rate the exponent is below two; stresses grow strongly with the solid fraction.
  const auto all = finish("annular_shear_cell.yaml");
  const auto exponent = [&](const std::string& name, double from, double to) {
    const auto& r = all.run(name);
    const auto rate = r.series("shear_rate"), tau = r.series("shear_stress"), time = r.series("time");
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    for (std::size_t i = 0; i < rate.size(); ++i) {
      if (time[i] < 0.6) continue;  // the first steady state and a little of the ramp
      if (x0 == 0 && rate[i] >= from) x0 = rate[i], y0 = tau[i];
      if (rate[i] <= to) x1 = rate[i], y1 = tau[i];
    }
    return std::log(y1 / y0) / std::log(x1 / x0);
  };
  for (const char* loose : {"void_ratio=1.169", "void_ratio=1.070", "void_ratio=0.984"}) {
    CHECK(exponent(loose, 500, 1000) == Approx(2).epsilon(1e-6));  // pure collisions: exactly quadratic
  }
  CHECK(exponent("void_ratio=0.908", 30, 60) < 1);        // friction carries most of the stress
  CHECK(exponent("void_ratio=0.908", 500, 1000) > 1.95);  // and hardly any at the highest rates
  double before = 0;
  for (const char* name : {"void_ratio=1.169", "void_ratio=1.070", "void_ratio=0.984", "void_ratio=0.908"}) {
    const double last = all.run(name).series("shear_stress").back();
    CHECK(last > 1.3 * before);
    before = last;
  }
}

TEST_CASE("the annular cell follows the published model lines", "[validation]") {
  // The lines are the paper's Eqs 8 and 9 with the residual stresses printed in its Table 3 (36.5 and 83.2 Pa); ours
  // are 36.78 and 83.72 Pa, a gap of 0.8 % that the rounding of the printed c2, c3, c4 explains.
  const auto all = finish("annular_shear_cell.yaml");
  for (const char* name : {"void_ratio=1.169", "void_ratio=1.070", "void_ratio=0.984", "void_ratio=0.908"}) {
    const auto& r = all.run(name);
    const auto rate = r.series("shear_rate"), tau = r.series("shear_stress"), time = r.series("time");
    const auto c = all.comparison(name, "shear_stress");
    std::size_t compared = 0;
    for (std::size_t k = 0; k < c.x.size(); ++k) {
      for (std::size_t i = 1; i < rate.size(); ++i) {
        if (time[i] < 0.51 || !(rate[i - 1] < c.x[k] && rate[i] >= c.x[k])) continue;
        const double model = tau[i - 1] + (tau[i] - tau[i - 1]) * (c.x[k] - rate[i - 1]) / (rate[i] - rate[i - 1]);
        INFO(name << " at " << c.x[k]);
        CHECK(model == Approx(c.y[k]).epsilon(0.01));  // 0.8 % and the interpolation of a parabola
        ++compared;
        break;
      }
    }
    CHECK(compared >= 10);
  }
}
