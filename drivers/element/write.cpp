// SPDX-License-Identifier: BSD-3-Clause
#include "write.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <fstream>
#include <stdexcept>

#include "figures.hpp"
#include "sweep.hpp"
#include "version.hpp"

namespace grainlaw::element {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

double seconds() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC_COARSE, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

void save(const fs::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
}

/// JSON has no NaN: null.
Json finite(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

const char* word(Status status) {
  return status == Status::done ? "done" : status == Status::failed ? "failed" : "interrupted";
}

Json counts(const std::array<std::size_t, reason_names.size()>& fired) {
  Json object = Json::object();
  for (std::size_t i = 0; i < fired.size(); ++i) {
    if (reason_names[i] != "too_many_steps") object[std::string(reason_names[i])] = fired[i];
  }
  return object;
}

Json runs_of(const FileOutcome& outcome, const std::string& prefix, const std::string& folder) {
  Json runs = Json::array();
  for (const auto& r : outcome.records) {
    Json final_row = Json::object(), at = Json::object();
    if (r.rows() > 0) {
      for (std::size_t c = 0; c < r.columns.size(); ++c)
        final_row[r.columns[c].header()] = finite(r.at(r.rows() - 1, c));
    }
    for (std::size_t c = 0; c < r.columns.size() && c < r.peak.row.size(); ++c) {
      const auto& name = r.columns[c].name;
      if (name == "time" || name == "shear_strain" || name == "axial_strain" || name == "pressure")
        at[r.columns[c].header()] = finite(r.peak.row[c]);
    }
    Json run{
        {"name", prefix + r.name},
        {"csv", folder + file_stem(r.name) + ".csv"},
        {"status", word(r.status)},
        {"failure", r.failure},
        {"method", r.method},
        {"state", r.state_form},
        {"rhs_evaluations", r.counters.rhs_evaluations},
        {"steps", r.counters.steps},
        {"rejected_steps", r.counters.rejected},
        {"retries", r.counters.retries},
        {"solver_ms", r.solver_ms},
        {"global_error_estimate", r.global_error_estimate < 0 ? Json(nullptr) : finite(r.global_error_estimate)},
        {"rows", r.rows()},
        {"class", r.response},
        {"peak",
         r.peak.row.empty()
             ? Json(nullptr)
             : Json{{"column", r.peak.column}, {"unit", r.peak.unit}, {"value", finite(r.peak.value)}, {"at", at}}},
        {"final", final_row},
        {"admit", counts(r.admit)}};
    runs.push_back(std::move(run));
  }
  return runs;
}

Json table(const std::vector<ResultRow>& rows) {
  Json list = Json::array();
  for (const auto& r : rows) list.push_back({r.run, r.peak, r.residual, r.response, r.reference, r.difference});
  return {{"columns", {"run", "peak", "residual", "class", "reference", "difference"}}, {"rows", list}};
}

}  // namespace

double peak_memory_mb() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;
}

CsvWriter::CsvWriter(const fs::path& p, const ElementFile& file, const ElementTest& test) : path(p) {
  out = std::fopen(p.c_str(), "wb");
  if (!out) throw std::runtime_error(fmt::format("{}: cannot be written: {}", p.string(), std::strerror(errno)));
  std::setvbuf(out, nullptr, _IONBF, 0);
  std::string title = file.title;
  for (char& c : title) c = c == '\n' ? ' ' : c;
  head = fmt::format(
      "# {}\n# run {}: {}, law {}{}{}\n# SI units in brackets; stress and strain tension and extension positive, "
      "pressure compression positive\n",
      title, test.run, test.kind_name, test.material.law, test.material.name.empty() ? "" : ", material ",
      test.material.name);
  buffer.reserve(1 << 16);
  last_flush = seconds();
}

CsvWriter::~CsvWriter() {
  if (out) {
    std::fwrite(buffer.data(), 1, buffer.size(), out);
    std::fclose(out);
  }
}

void CsvWriter::header(const std::vector<Column>& columns) {
  if (header_written) return;
  header_written = true;
  buffer = head;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i > 0) buffer += ',';
    buffer += columns[i].header();
  }
  buffer += '\n';
}

void CsvWriter::row(const std::vector<Column>& columns, const double* values) {
  header(columns);
  // 17 significant digits read back to the same double
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i > 0) buffer += ',';
    fmt::format_to(std::back_inserter(buffer), FMT_COMPILE("{:.17g}"),
                   values[i] + 0.0);  // + 0.0: no minus before a zero
  }
  buffer += '\n';
  if (buffer.size() > (1 << 16) - 4096 || seconds() - last_flush > 1) flush();
}

void CsvWriter::flush() {
  last_flush = seconds();
  if (std::fwrite(buffer.data(), 1, buffer.size(), out) != buffer.size()) {
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
  }
  buffer.clear();
}

void CsvWriter::close(const std::vector<Column>& columns) {
  header(columns);  // of a run that failed before its first row
  flush();
  const int failed = std::fclose(out);
  out = nullptr;
  if (failed != 0)
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
}

void write_results(const fs::path& dir, const ElementFile& file, const FileOutcome& outcome) {
  std::error_code none;
  std::vector<std::string> comparison_files;
  fs::remove_all(dir / "measured", none);
  for (std::size_t k = 0; k < outcome.comparisons.size(); ++k) {
    const auto& c = outcome.comparisons[k];
    fs::create_directories(dir / "measured");
    const std::string name =
        fmt::format("measured/{}_{}_{}.csv", file_stem(c.comparison.run), k + 1, c.comparison.y.run);
    std::string text =
        fmt::format("# {} ({}), from {}\n# SI units and the signs of the run\n{},{}\n", c.comparison.label,
                    c.comparison.role, c.comparison.file.filename().string(), c.comparison.x.run, c.comparison.y.run);
    for (std::size_t i = 0; i < c.x.size(); ++i) text += fmt::format("{},{}\n", c.x[i], c.y[i]);
    save(dir / name, text);
    comparison_files.push_back(name);
  }

  // the YAML as understood: data files are named relative to where it is written
  input::Node as_run = file.as_run;
  if (input::Node* compare = as_run.find("compare")) {
    const fs::path from = fs::absolute(file.path).parent_path(), to = fs::absolute(dir);
    const auto moved = [&](input::Node& node) {
      if (node.is_scalar()) node.text = fs::proximate(from / node.text, to).generic_string();
    };
    for (auto& entry : compare->items) {
      if (input::Node* data = entry.find("data")) {
        moved(*data);
        for (auto& item : data->items) moved(item);
      }
    }
  }
  save(dir / "as_run.yaml", fmt::format("# {} as understood by grainlaw {}; runs again to the same result\n{}",
                                        file.path.filename().string(), program_version, input::to_yaml(as_run)));

  const Json runs = runs_of(outcome, "", "");

  Json expects = Json::array();
  for (const auto& e : outcome.expectations) {
    const auto& x = e.expectation;
    const std::string at = x.at == Expectation::At::end    ? "end"
                           : x.at == Expectation::At::peak ? "peak"
                                                           : fmt::format("{} = {}", x.at_column, x.at_value);
    expects.push_back({{"run", x.run},
                       {"column", x.column},
                       {"at", at},
                       {"got", finite(e.got)},
                       {"want", x.value},
                       {"unit", x.unit},
                       {"difference", finite(e.difference)},
                       {"within", x.within},
                       {"within_unit", x.relative ? "" : x.unit},
                       {"met", e.met},
                       {"because", x.because}});
  }
  Json compares = Json::array();
  for (const auto& c : outcome.comparisons) {
    compares.push_back({{"run", c.comparison.run},
                        {"label", c.comparison.label},
                        {"column", c.comparison.y.run},
                        {"against", c.comparison.x.run},
                        {"points", c.used},
                        {"rms", finite(c.rms)},
                        {"unit", c.y_unit},
                        {"rms_of_largest", finite(c.largest > 0 ? c.rms / c.largest : 0)},
                        {"class", c.response},
                        {"role", c.comparison.role},
                        {"validation", c.comparison.role == "validation"},
                        {"note", c.comparison.note}});
  }
  const ElementTest& first = file.tests.front();
  Json parameters = Json::array();
  for (const auto& p : first.material.parameters) {
    bool varies = false;
    for (const auto& t : file.tests) {
      for (const auto& q : t.material.parameters) varies = varies || (q.name == p.name && q.value != p.value);
    }
    parameters.push_back({{"name", p.name},
                          {"value", p.value},
                          {"unit", p.unit},
                          {"meaning", p.meaning},
                          {"source", p.source},
                          {"varies", varies}});
  }
  std::vector<std::string> notes = file.notes;
  if (!first.material.source.empty())
    notes.push_back(fmt::format("Material {}: {}", first.material.name, first.material.source));
  if (first.integration.chosen_automatically && first.kind != Kind::point) {
    notes.push_back(fmt::format("The integrator was chosen automatically: {} ({}).",
                                info(first.integration.method).name, info(first.integration.method).description));
  }
  notes.emplace_back(
      "The error estimate is the largest difference of the stress along the path from a companion run with a ten times "
      "larger tolerance, hence an upper estimate; for fixed steps it is extrapolated from half the step. It is "
      "relative to the "
      "largest stress.");
  Json summary{{"program", "grainlaw"},
               {"version", program_version},
               {"commit", program_commit},
               {"file", file.path.filename().string()},
               {"kind", file.kind},
               {"title", file.title},
               {"source", file.source},
               {"exit_code", outcome.exit_code},
               {"wall_s", outcome.wall_s},
               {"cpu_s", outcome.cpu_s},
               {"peak_memory_mb", peak_memory_mb()},
               {"law", first.material.law},
               {"material", first.material.name},
               {"parameters", parameters},
               {"notes", notes},
               {"warnings", file.warnings},
               {"runs", runs},
               {"expect", expects},
               {"compare", compares},
               {"results", table(outcome.table)},
               {"figures", figures(file, outcome.records, outcome.comparisons, comparison_files)}};
  save(dir / "summary.json", summary.dump(1) + "\n");
}

void write_combined(const fs::path& dir, const std::vector<ElementFile>& files, const std::vector<fs::path>& folders,
                    const std::vector<FileOutcome>& outcomes, int exit_code) {
  std::vector<ResultRow> rows;
  Json names = Json::array(), runs = Json::array();
  std::string inputs;
  double wall = 0, cpu = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    names.push_back(folders[i].filename().string());
    for (auto row : outcomes[i].table) {
      row.run = files[i].path.stem().string() + ": " + row.run;
      rows.push_back(std::move(row));
    }
    const std::string stem = folders[i].filename().string();
    for (auto& run : runs_of(outcomes[i], stem + ": ", stem + "/")) runs.push_back(std::move(run));
    inputs += (i > 0 ? " " : "") + files[i].path.filename().string();
    wall += outcomes[i].wall_s;
    cpu += outcomes[i].cpu_s;
  }
  const Json summary{{"program", "grainlaw"},
                     {"version", program_version},
                     {"commit", program_commit},
                     {"file", inputs},
                     {"kind", "several"},
                     {"title", "Element tests"},
                     {"exit_code", exit_code},
                     {"wall_s", wall},
                     {"cpu_s", cpu},
                     {"peak_memory_mb", peak_memory_mb()},
                     {"files", names},
                     {"results", table(rows)},
                     {"runs", runs}};
  save(dir / "summary.json", summary.dump(1) + "\n");
}

}  // namespace grainlaw::element
