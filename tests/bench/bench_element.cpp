// SPDX-License-Identifier: BSD-3-Clause
// What an element test costs: the solver alone, and the whole process from exec to exit. Best of several; the machine
// is not ours alone.
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "drivers/element/read_element.hpp"
#include "drivers/element/run.hpp"

extern char** environ;  // NOLINT

namespace {

using namespace grainlaw;
const std::filesystem::path folder = std::filesystem::path(GRAINLAW_SOURCE) / "data/element";

void solver(const char* title, const char* file, std::vector<std::string> sets, int repeats) {
  const auto test = element::read_element(folder / file, sets).tests.front();
  double best = 1e300;
  element::RunRecord record;
  for (int i = 0; i < repeats; ++i) {
    record = element::run(test);
    best = std::min(best, record.solver_ms);
  }
  fmt::print("  {:<58} {:7.3f} ms  {:6} rates  {:5} steps  {:5} rows  error {:.1e}\n", title, best,
             record.counters.rhs_evaluations, record.counters.steps, record.rows(), record.global_error_estimate);
}

void process(const char* title, std::vector<std::string> words, int repeats) {
  words.insert(words.begin(), GRAINLAW_PROGRAM);
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  double best = 1e300;
  for (int i = 0; i < repeats; ++i) {
    const auto from = std::chrono::steady_clock::now();
    pid_t child = 0;
    int status = 0;
    if (posix_spawn(&child, GRAINLAW_PROGRAM, nullptr, nullptr, arguments.data(), environ) != 0) std::exit(1);
    waitpid(child, &status, 0);
    if (status != 0) std::exit(1);
    best = std::min(best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - from).count());
  }
  fmt::print("  {:<58} {:7.2f} ms\n", title, best);
}

}  // namespace

int main(int argc, char** argv) {
  const int repeats = argc > 1 && std::string(argv[1]) == "--smoke" ? 1 : 30;
  const std::string one = "test.initial.void_ratio=0.845";
  fmt::print("solver alone, best of {}\n", repeats);
  solver("undrained shear to gamma = 1, rtol 1e-9, a row every 1e-3", "undrained_simple_shear.yaml",
         {one, "expect=[]", "integrator.rtol=1e-9"}, repeats);
  solver("the same with one row", "undrained_simple_shear.yaml",
         {one, "expect=[]", "integrator.rtol=1e-9", "output={rows: 1}"}, repeats);
  solver("drained triaxial to 25 %, rtol 1e-9, 1000 rows", "drained_triaxial.yaml",
         {"test.specimen=TMD1", "test.initial={pressure: 50 kPa, void_ratio: 0.9961}", "compare=[]",
          "integrator.rtol=1e-9"},
         repeats);
  const auto out = std::filesystem::temp_directory_path() / fmt::format("grainlaw_bench_{}", getpid());
  const std::vector<std::string> quick{"--out", out.string(), "--no-plot", "--quiet"};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.end(), quick.begin(), quick.end());
    return words;
  };
  fmt::print("whole process with --no-plot --quiet, best of {}\n", repeats);
  const std::string shear = (folder / "undrained_simple_shear.yaml").string();
  process("one undrained shear test, 1000 rows", with({"element", shear, "--set", one, "--set", "expect=[]"}), repeats);
  process("the five of Sect. 4.1", with({"element", shear}), repeats);
  std::filesystem::remove_all(out);
}
