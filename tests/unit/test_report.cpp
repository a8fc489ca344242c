#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "drivers/report/curve.hpp"
#include "drivers/report/html.hpp"
#include "drivers/report/report.hpp"

namespace {

namespace fs = std::filesystem;
using grainlaw::report::build;
using grainlaw::report::Json;
using grainlaw::report::Outcome;

/// An empty folder that goes away with its test; its name needs quoting wherever quoting can go wrong.
class Folder {
 public:
  Folder() {
    static int count = 0;
    const auto stamp = std::chrono::steady_clock::now().time_since_epoch().count();
    path_ = fs::temp_directory_path() / ("grainlaw it's a \"test\" " + std::to_string(stamp + count++));
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Sets PATH until the end of a scope.
class SearchPath {
 public:
  explicit SearchPath(const std::string& value) {
    if (const char* old = std::getenv("PATH")) before_ = old;
    setenv("PATH", value.c_str(), 1);
  }
  ~SearchPath() { before_ ? setenv("PATH", before_->c_str(), 1) : unsetenv("PATH"); }
  SearchPath(const SearchPath&) = delete;
  SearchPath& operator=(const SearchPath&) = delete;

 private:
  std::optional<std::string> before_;
};

void write(const fs::path& file, const std::string& content) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << content;
}

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// A simple shear summary with one run, one figure of a line and circles, and the CSV files behind it.
Json write_sample(const fs::path& dir, const std::string& title = "Simple shear") {
  const std::string csv = "void_ratio=0.890 'a' \"b\" <c>.csv";
  std::string rows = "# grainlaw\n# a second comment\nshear_strain [-],shear_stress [Pa]\n";
  for (int i = 0; i <= 2000; ++i) {
    const double strain = 1e-4 * i;
    rows += std::to_string(strain) + "," + std::to_string(14e3 * (1.0 - std::exp(-strain / 0.01))) + "\n";
  }
  write(dir / csv, rows);
  write(dir / "measured/TMU1 q.csv", "gamma,tau\n0.01,9000\n0.05,14000\n0.2,13900\n");
  const Json line = {{"csv", csv}, {"label", "e = 0.890 & <b>"}};
  const Json circles = {{"csv", "measured/TMU1 q.csv"}, {"x", 1},         {"y", 2},
                        {"label", "measured"},          {"points", true}, {"color", 0}};
  const Json x = {{"column", "shear_strain [-]"}, {"label", "shear strain"}, {"unit", "-"}, {"scale", 1.0}};
  const Json y = {{"column", "shear_stress [Pa]"}, {"label", "it's <tau>"}, {"unit", "kPa"}, {"scale", 1e-3}};
  const Json figure = {{"id", "../odd id"}, {"title", "Stress"}, {"x", x}, {"y", y}, {"series", {line, circles}}};
  const Json run = {{"name", "void_ratio=0.890"}, {"csv", csv},   {"status", "done"},
                    {"method", "dp54"},           {"steps", 170}, {"class", "liquefaction"},
                    {"admit", {{"tension", 0}}}};
  const Json expect = {{"run", "void_ratio=0.890"},
                       {"column", "shear_stress"},
                       {"at", "end"},
                       {"got", 14161.0},
                       {"want", 14400.0},
                       {"unit", "Pa"},
                       {"met", false}};
  Json summary = {{"program", "grainlaw"},
                  {"version", "0.1.0"},
                  {"kind", "simple_shear"},
                  {"title", title},
                  {"exit_code", 1},
                  {"runs", Json::array({run})},
                  {"expect", Json::array({expect})},
                  {"figures", Json::array({figure})}};
  write(dir / "summary.json", summary.dump());
  return summary;
}

/// Whether the pictures were drawn; a machine without gnuplot skips what only a picture can show.
bool drawn(const Outcome& outcome) {
  if (outcome.pictures) return true;
  WARN(outcome.message);
  CHECK(has(outcome.message, "gnuplot not found"));
  return false;
}

}  // namespace

TEST_CASE("a report shows the summary and escapes its text", "[report]") {
  const Folder folder;
  write_sample(folder.path(), "<script>alert('x')</script> & more");
  const Outcome outcome = build(folder.path());
  CHECK(outcome.page == folder.path() / "report.html");
  const std::string page = read(outcome.page);
  CHECK(has(page, "<h1>&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; more</h1>"));
  CHECK_FALSE(has(page, "<script"));
  CHECK(has(page, "1 of 1 expectation not met (exit code 1)"));
  CHECK(has(page, "NOT MET"));
  CHECK(has(page, "Nothing fired in any run (watched: tension)."));
  CHECK_FALSE(has(page, "Parameters"));
  CHECK_FALSE(has(page, "Notes and warnings"));
  CHECK_FALSE(has(page, folder.path().string()));

  if (!drawn(outcome)) return;
  CHECK(outcome.message.empty());
  CHECK(count(page, "<svg") == 1);
  CHECK_FALSE(has(page, "<?xml"));
  CHECK_FALSE(has(page, "<tau>"));
  CHECK(has(page, "it's &lt;tau"));
}

TEST_CASE("the scripts of a report stay in its folder and hold thinned data", "[report]") {
  const Folder folder;
  write_sample(folder.path());
  build(folder.path());
  CHECK(has(read(folder.path() / "plots/odd_id.gp"), "set ylabel 'it''s <tau> [kPa]'"));
  const std::string data = read(folder.path() / "plots/odd_id.dat");
  CHECK(has(data, "# index 0"));
  CHECK(has(data, "\n\n\n# index 1: measured\n0.01 9\n0.05 14\n0.2 13.9\n"));
  CHECK(count(data, "\n") < 200);
}

TEST_CASE("a report without gnuplot keeps its scripts and says what to install", "[report]") {
  const Folder folder;
  write_sample(folder.path());
  const SearchPath nowhere("");
  const Outcome outcome = build(folder.path());
  CHECK_FALSE(outcome.pictures);
  CHECK(outcome.message ==
        "gnuplot not found: install gnuplot-nox; the scripts are in " + (folder.path() / "plots").string());
  CHECK(fs::exists(folder.path() / "plots/odd_id.gp"));
  const std::string page = read(outcome.page);
  CHECK(has(page, "No picture here. Its script is <code>plots/odd_id.gp</code>."));
  CHECK(has(page, "gnuplot not found: install gnuplot-nox"));
}

TEST_CASE("a report tells what gnuplot complained about", "[report]") {
  const Folder folder;
  write_sample(folder.path() / "out");
  const fs::path fake = folder.path() / "bin/gnuplot";
  write(fake, "#!/bin/sh\necho 'line 7: <bad> terminal'\nexit 1\n");
  fs::permissions(fake, fs::perms::owner_all);
  const SearchPath only_fake(fake.parent_path().string());
  const Outcome outcome = build(folder.path() / "out");
  CHECK_FALSE(outcome.pictures);
  CHECK(has(outcome.message, "gnuplot could not draw odd_id: line 7: <bad> terminal"));
  CHECK(has(read(outcome.page), "gnuplot: line 7: &lt;bad&gt; terminal"));
}

TEST_CASE("the same folder gives the same report, wherever it lies", "[report]") {
  const Folder here;
  const Folder there;
  write_sample(here.path());
  write_sample(there.path());
  const std::string first = read(build(here.path()).page);
  CHECK(first == read(build(here.path()).page));
  CHECK(first == read(build(there.path()).page));
}

TEST_CASE("a combined report has a section for each file", "[report]") {
  const Folder folder;
  write_sample(folder.path() / "first one", "First & foremost");
  write_sample(folder.path() / "second's", "Second");
  const Json row = {"first one", "14.2 kPa"};
  const Json results = {{"columns", {"file", "peak"}}, {"rows", Json::array({row})}};
  const Json summary = {{"files", {"first one", "second's"}}, {"results", results}, {"exit_code", 1}};
  write(folder.path() / "summary.json", summary.dump());
  const Outcome outcome = build(folder.path());
  const std::string page = read(outcome.page);
  CHECK(has(page, "<h1>2 element tests</h1>"));
  CHECK(has(page, "<h2>First &amp; foremost</h2>"));
  CHECK(has(page, "<h2>Second</h2>"));
  CHECK(has(page, "<a href=\"#part-1\">first one</a>"));
  CHECK(has(page, "2 of 2 expectations not met (exit code 1)"));
  CHECK_FALSE(fs::exists(folder.path() / "first one/report.html"));

  if (!drawn(outcome)) return;
  CHECK(count(page, "<svg") == 2);
  CHECK(count(page, "id='f1-gpPt0'") == 1);
  CHECK(count(page, "id='f2-gpPt0'") == 1);
}

TEST_CASE("a report that cannot draw one series draws the others", "[report]") {
  const Folder folder;
  Json summary = write_sample(folder.path());
  summary["figures"][0]["series"].push_back({{"csv", "gone.csv"}});
  summary["figures"][0]["series"].push_back({{"csv", "measured/TMU1 q.csv"}, {"x", 1}, {"y", 9}});
  write(folder.path() / "summary.json", summary.dump());
  const Outcome outcome = build(folder.path());
  const std::string page = read(outcome.page);
  CHECK(has(page, "gone.csv: cannot be read"));
  CHECK(has(page, "measured/TMU1 q.csv: has no column number 9"));
  if (drawn(outcome)) CHECK(count(page, "<svg") == 1);
}

TEST_CASE("a summary that is missing or malformed is named", "[report]") {
  const Folder folder;
  const std::string file = (folder.path() / "summary.json").string();
  const auto complaint = [&folder]() -> std::string {
    try {
      build(folder.path());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  CHECK(complaint() == file + ": cannot be read");
  for (const char* content :
       {"{\"kind\": ", "[]", "7", "{\"kind\":\"x\",\"title\":\"y\"}", "{\"kind\":\"x\",\"title\":\"y\",\"runs\":3}",
        "{\"kind\":\"x\",\"title\":\"y\",\"runs\":[3]}", "{\"files\":[1]}"}) {
    write(file, content);
    INFO(content);
    CHECK(has(complaint(), file + ": "));
  }
  write(file, "{\"files\":[\"none\"]}");
  CHECK(complaint() == (folder.path() / "none/summary.json").string() + ": cannot be read");
  write(file, "{\"kind\":\"x\",\"title\":\"Bare\",\"runs\":[]}");
  CHECK(complaint().empty());
}

TEST_CASE("numbers in a report are short and keep their magnitude", "[report]") {
  using grainlaw::report::show;
  CHECK(show(0.0) == "0");
  CHECK(show(-50.0) == "\u221250");
  CHECK(show(14161.04) == "14161");
  CHECK(show(141610.4) == "141610");
  CHECK(show(0.0078) == "0.0078");
  CHECK(show(1.234567) == "1.2346");
  CHECK(show(99999.96) == "100000");
  CHECK(show(-1.5e-9) == "\u22121.5×10<sup>\u22129</sup>");
  CHECK(show(2e11, "m^-2") == "2×10<sup>11</sup>\u00a0m⁻²");
  CHECK(show(3.0, "-") == "3");
}

TEST_CASE("thinning keeps the shape of a line and its breaks", "[report]") {
  using namespace grainlaw::report;
  Curve curve;
  for (int i = 0; i <= 10000; ++i) curve.push_back({1e-3 * i, std::sin(1e-3 * i)});
  curve[5000].y = std::nan("");
  Frame frame(false, false);
  frame.include(curve);
  const Curve thin = thin_line(curve, frame, 60);
  CHECK(thin.size() <= 61);
  CHECK(thin.front().x == curve.front().x);
  CHECK(thin.back().x == curve.back().x);
  int breaks = 0;
  for (std::size_t i = 0; i + 1 < thin.size(); ++i) {
    if (!is_finite(thin[i])) ++breaks;
    if (!is_finite(thin[i]) || !is_finite(thin[i + 1])) continue;
    const double middle = 0.5 * (thin[i].x + thin[i + 1].x);
    CHECK(std::abs(0.5 * (thin[i].y + thin[i + 1].y) - std::sin(middle)) < 0.02);
  }
  CHECK(breaks == 1);
}
