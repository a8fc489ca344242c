// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <ctime>
#include <map>
#include <set>

#include "../element/read_element.hpp"
#include "../element/sweep.hpp"
#include "../element/write.hpp"
#include "../input/source.hpp"
#include "../report/report.hpp"
#include "commands.hpp"

namespace grainlaw::commands {

namespace fs = std::filesystem;
using namespace element;

namespace {

volatile std::sig_atomic_t stop_asked = 0;
void ask_to_stop(int /*signal*/) { stop_asked = 1; }

double cpu_now() { return double(std::clock()) / CLOCKS_PER_SEC; }

using Clock = std::chrono::steady_clock;
double since(Clock::time_point from) { return std::chrono::duration<double>(Clock::now() - from).count(); }

/// One line on a terminal for anything that takes longer than two seconds.
class Progress {
 public:
  explicit Progress(bool quiet) : wanted(!quiet && isatty(STDERR_FILENO) != 0) {}
  ~Progress() { clear(); }
  void begin(std::string name) {
    run = std::move(name);
    from = Clock::now();
  }
  void show(double share, double step) {
    if (!wanted || since(from) < 2 || since(last) < 0.2) return;
    last = Clock::now();
    shown = true;
    fmt::print(stderr, "\r\033[K  {}: {:.0f} %, {:.0f} s to go, step {:.3g} s", run, 100 * share,
               since(from) * (1 - share) / share, step);
    std::fflush(stderr);
  }
  void clear() {
    if (shown) fmt::print(stderr, "\r\033[K");
    shown = false;
  }

 private:
  bool wanted, shown = false;
  std::string run;
  Clock::time_point from = Clock::now(), last = Clock::now();
};

std::size_t width(std::string_view text) {  // characters, not bytes
  return std::size_t(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

void print_table(const std::string& title, const std::vector<ResultRow>& rows) {
  const std::vector<std::string> head{"run", "peak", "residual", "class", "reference", "difference"};
  std::vector<std::vector<std::string>> cells{head};
  for (const auto& r : rows) cells.push_back({r.run, r.peak, r.residual, r.response, r.reference, r.difference});
  std::vector<std::size_t> widths(head.size(), 0);
  for (const auto& line : cells) {
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], width(line[c]));
  }
  fmt::print("{}\n", title);
  for (const auto& line : cells) {
    std::string text;
    for (std::size_t c = 0; c < line.size(); ++c) text += "  " + line[c] + std::string(widths[c] - width(line[c]), ' ');
    text.erase(text.find_last_not_of(' ') + 1);
    fmt::print("{}\n", text);
  }
}

FileOutcome run_file(const ElementFile& file, const fs::path& dir, bool quiet) {
  FileOutcome outcome;
  const auto wall_from = Clock::now();
  const double cpu_from = cpu_now();
  Progress progress(quiet);
  for (const auto& test : file.tests) {
    CsvWriter csv(dir / (file_stem(test.run) + ".csv"), file, test);
    progress.begin(test.run);
    Hooks hooks;
    hooks.row = [&](const RunRecord& record, const double* row) { csv.row(record.columns, row); };
    hooks.progress = [&](double share, double step) { progress.show(share, step); };
    hooks.interrupted = [] { return stop_asked != 0; };
    RunRecord record = run(test, hooks);
    csv.close(record.columns);
    progress.clear();
    if (record.status != Status::done)
      fmt::print(stderr, "{}: {}: {}\n", file.path.string(), record.status == Status::failed ? "error" : "stopped",
                 record.failure);
    std::vector<ExpectationResult> expectations;
    std::vector<ComparisonResult> comparisons;
    for (const auto& e : file.expectations) {
      if (e.run == test.run) expectations.push_back(evaluate(e, record));
    }
    for (const auto& c : file.comparisons) {
      if (c.run == test.run) comparisons.push_back(evaluate(c, record));
    }
    outcome.table.push_back(summarise(test, record, expectations, comparisons));
    int code = done;
    if (std::any_of(expectations.begin(), expectations.end(), [](const auto& e) { return !e.met; }))
      code = expectation_missed;
    if (record.status == Status::failed) code = numerical_failure;
    outcome.exit_code = std::max(outcome.exit_code, code);
    outcome.expectations.insert(outcome.expectations.end(), expectations.begin(), expectations.end());
    outcome.comparisons.insert(outcome.comparisons.end(), comparisons.begin(), comparisons.end());
    const bool stopped = record.status == Status::interrupted;
    outcome.records.push_back(std::move(record));
    if (stopped) {
      outcome.exit_code = interrupted;
      break;
    }
  }
  outcome.wall_s = since(wall_from);
  outcome.cpu_s = cpu_now() - cpu_from;
  return outcome;
}

/// Makes every folder, or none of them.
void make_all(const std::vector<fs::path>& folders) {
  std::vector<fs::path> made;
  std::error_code failed, none;
  for (const auto& folder : folders) {
    fs::path fresh;  // the topmost folder that is not there yet
    for (fs::path at = fs::absolute(folder); !at.empty() && !fs::exists(at, none); at = at.parent_path()) fresh = at;
    fs::create_directories(folder, failed);
    if (!fresh.empty()) made.push_back(fresh);
    if (!failed) continue;
    for (const auto& path : made) fs::remove_all(path, none);
    throw input::InputError(
        fmt::format("error: the folder '{}' cannot be made: {}\n", folder.string(), failed.message()));
  }
}

void print_outcome(const ElementFile& file, const FileOutcome& outcome) {
  print_table(file.title, outcome.table);
  const auto& e = outcome.expectations;
  if (!e.empty()) {
    const auto met = std::count_if(e.begin(), e.end(), [](const auto& x) { return x.met; });
    fmt::print("  expect: {} of {} met\n", met, e.size());
    for (const auto& x : e) {
      if (x.met) continue;
      const auto& want = x.expectation;
      if (std::isnan(x.got)) {
        fmt::print(
            "    NOT MET {}: {}: the run never reaches {}\n", want.run, want.column,
            want.at == Expectation::At::value ? fmt::format("{} = {:.6g}", want.at_column, want.at_value) : "its end");
        continue;
      }
      fmt::print("    NOT MET {}: {} = {:.9g} {}, expected {:.9g} {} ({}: {:.3g}, allowed {:.3g}){}{}\n", want.run,
                 want.column, x.got, want.unit, want.value, want.unit,
                 want.relative ? "relative difference" : "difference", x.difference, want.within,
                 want.because.empty() ? "" : "; ", want.because);
    }
  }
  for (const auto& note : file.notes) fmt::print("  note: {}\n", note);
}

}  // namespace

int element(const ElementOptions& options) {
  // everything is read and validated before anything is written
  std::vector<ElementFile> files;
  std::map<std::string, std::string> stems;
  for (const auto& name : options.files) {
    files.push_back(read_element(name, options.sets));
    const auto [at, fresh] = stems.emplace(fs::path(name).stem().string(), name);
    if (!fresh)
      throw input::InputError(fmt::format(
          "error: '{}' and '{}' would write to the same folder '{}'\n  = run them one at a time with --out\n",
          at->second, name, at->first));
  }
  const bool several = files.size() > 1;
  const fs::path out = !options.out.empty() ? fs::path(options.out)
                       : several            ? fs::path("out")
                                            : fs::path("out") / files[0].path.stem();
  std::error_code failed;
  if (fs::exists(out, failed) && !fs::is_directory(out, failed))
    throw input::InputError(fmt::format("error: --out {}: is a file, not a folder\n", out.string()));
  std::vector<fs::path> folders;
  for (const auto& file : files) folders.push_back(several ? out / file.path.stem() : out);
  make_all(folders);
  if (!options.quiet) {
    for (const auto& file : files) {
      for (const auto& w : file.warnings) fmt::print(stderr, "{}: warning: {}\n", file.path.string(), w);
    }
  }

  stop_asked = 0;
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
  std::vector<FileOutcome> outcomes;
  int code = done;
  for (std::size_t i = 0; i < files.size() && code != interrupted; ++i) {
    outcomes.push_back(run_file(files[i], folders[i], options.quiet));
    code = std::max(code, outcomes.back().exit_code);
    write_results(folders[i], files[i], outcomes.back());
    if (!options.quiet) {
      print_outcome(files[i], outcomes.back());
      std::fflush(stdout);
    }
  }
  files.resize(outcomes.size());
  folders.resize(outcomes.size());
  if (several) write_combined(out, files, folders, outcomes, code);

  if (!options.no_plot) {
    std::vector<fs::path> pages;
    if (several) pages = folders;
    pages.push_back(out);
    std::set<std::string> said;
    for (const auto& page : pages) {
      const auto report = report::build(page);
      if (!options.quiet && !report.message.empty() && said.insert(report.message).second)
        fmt::print(stderr, "note: {}\n", report.message);
    }
    if (!options.quiet) fmt::print("report: {}\n", (out / "report.html").string());
  } else {
    std::error_code none;  // a report of earlier results would lie
    auto stale = folders;
    stale.push_back(out);
    for (const auto& folder : stale) {
      fs::remove(folder / "report.html", none);
      fs::remove_all(folder / "plots", none);
    }
    if (!options.quiet) fmt::print("results: {}\n", (out / "summary.json").string());
  }
  return code;
}

int check(const std::string& file, const std::vector<std::string>& sets) {
  const auto read = read_element(file, sets);
  for (const auto& w : read.warnings) fmt::print(stderr, "{}: warning: {}\n", file, w);
  fmt::print("{}: fine, {} of kind {} with law {}\n", file,
             read.tests.size() == 1 ? "one run" : fmt::format("{} runs", read.tests.size()), read.kind,
             read.tests[0].material.law);
  return done;
}

int plot(const std::string& dir) {
  const auto report = report::build(dir);
  if (!report.message.empty()) fmt::print(stderr, "note: {}\n", report.message);
  fmt::print("report: {}\n", report.page.string());
  return done;
}

}  // namespace grainlaw::commands
