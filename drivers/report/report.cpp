#include "report.hpp"

#include <fstream>
#include <stdexcept>

#include "gnuplot.hpp"
#include "page.hpp"

namespace grainlaw::report {
namespace {

namespace fs = std::filesystem;

Json read_summary(const fs::path& dir) {
  const fs::path file = dir / "summary.json";
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  try {
    return Json::parse(in);
  } catch (const Json::exception& error) {
    throw std::runtime_error(file.string() + ": is not valid JSON: " + error.what());
  }
}

Part read_part(const fs::path& dir, const std::string& name, const Json& summary) {
  for (const char* key : {"kind", "title", "runs"}) {
    if (!summary.contains(key)) throw std::runtime_error(std::string("the field '") + key + "' is missing");
  }
  return {name, summary, read_figures(summary, dir)};
}

/// Runs a step that reads a summary, so that whatever is wrong with it names the file.
template <typename Step>
auto naming(const fs::path& dir, Step step) {
  try {
    return step();
  } catch (const Json::exception& error) {
    throw std::runtime_error((dir / "summary.json").string() + ": " + error.what());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error((dir / "summary.json").string() + ": " + error.what());
  }
}

}  // namespace

Outcome build(const fs::path& dir) {
  const Json summary = read_summary(dir);
  const bool combined = naming(dir, [&] { return !list(summary, "files").empty(); });
  std::vector<Part> parts;
  if (combined) {
    for (const Json& entry : summary["files"]) {
      const std::string name = naming(dir, [&] { return entry.get<std::string>(); });
      const Json own = read_summary(dir / name);
      parts.push_back(naming(dir / name, [&] { return read_part(dir / name, name, own); }));
    }
  } else {
    parts.push_back(naming(dir, [&] { return read_part(dir, "", summary); }));
  }

  std::vector<Figure*> figures;
  for (Part& part : parts) {
    for (Figure& figure : part.figures) {
      write_plot(figure);
      figures.push_back(&figure);
    }
  }
  Outcome outcome{.page = dir / "report.html", .pictures = true, .message = draw(figures)};
  for (const Figure* figure : figures) outcome.pictures = outcome.pictures && !figure->svg.empty();
  if (!outcome.pictures && outcome.message.empty()) {
    outcome.message = "some figures have no data to draw, as the page tells";
  } else if (!outcome.message.empty()) {
    const fs::path scripts = combined ? dir / "*" / "plots" : dir / "plots";
    outcome.message += "; the scripts are in " + scripts.string();
  }

  const std::string html =
      naming(dir, [&] { return combined ? combined_page(summary, parts) : single_page(parts[0]); });
  std::ofstream out(outcome.page, std::ios::binary);
  out << html;
  if (!out.flush()) throw std::runtime_error(outcome.page.string() + ": cannot be written");
  return outcome;
}

}  // namespace grainlaw::report
