#include "page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "html.hpp"

namespace grainlaw::report {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

std::string section(int level, const std::string& title, const std::string& content) {
  return content.empty() ? "" : fmt::format("<h{0}>{1}</h{0}>\n{2}", level, escape(title), content);
}

std::string counted(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

bool is_met(const Json& expectation) { return expectation.value("met", false); }

bool is_failed(const Json& run) { return !text(run, "failure").empty() || text(run, "status") == "failed"; }

std::size_t count_failed(const Json& summary) {
  const Json& runs = list(summary, "runs");
  return static_cast<std::size_t>(std::count_if(runs.begin(), runs.end(), is_failed));
}

std::size_t count_unmet(const Json& summary) {
  const Json& all = list(summary, "expect");
  return all.size() - static_cast<std::size_t>(std::count_if(all.begin(), all.end(), is_met));
}

/// A condition or place in words: "end", or "shear_strain = 0.0078".
std::string in_words(const Json& value) {
  if (!value.is_object()) return cell(value).html;
  std::string out;
  for (const auto& [key, inner] : value.items()) {
    out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", escape(key), cell(inner).html);
  }
  return out;
}

std::string place_in_words(const Json& object) {
  const auto found = object.find("at");
  return found == object.end() ? "" : in_words(*found);
}

Cell quantity(const Json& object, const std::string& key, const std::string& unit, int digits = 5) {
  return {show(number(object, key, missing), unit, digits), true};
}

/// The law and material, the program, and where the input came from.
std::string facts(const Json& summary, bool with_program) {
  std::string out;
  const auto fact = [&out](const std::string& name, const std::string& value) {
    if (!value.empty()) out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, escape(value));
  };
  fact("Law", text(summary, "law"));
  fact("Material", text(summary, "material"));
  fact("Test", text(summary, "kind"));
  fact("Input", text(summary, "file"));
  if (with_program) {
    const std::string commit = text(summary, "commit");
    const std::string version = text(summary, "version");
    fact("Computed with", text(summary, "program") + (version.empty() ? "" : " " + version) +
                              (commit.empty() ? "" : " (" + commit + ")"));
  }
  return out.empty() ? out : "<dl class=\"facts\">\n" + out + "</dl>\n";
}

/// What went wrong, in words; "" when the exit code is 0.
std::string status(const Json& summary, std::size_t runs, std::size_t failed, std::size_t expected, std::size_t unmet) {
  const double code = number(summary, "exit_code", 0.0);
  if (code == 0.0) return "";
  std::vector<std::string> reasons;
  if (failed > 0) reasons.push_back(fmt::format("{} of {} did not finish", failed, counted(runs, "run")));
  if (unmet > 0) reasons.push_back(fmt::format("{} of {} not met", unmet, counted(expected, "expectation")));
  std::string words = fmt::format("{}", fmt::join(reasons, ", "));
  if (words.empty()) words = "the program reported a failure";
  std::string failures;
  for (const Json& run : list(summary, "runs")) {
    const std::string why = text(run, "failure").empty() ? text(run, "status") : text(run, "failure");
    if (is_failed(run)) failures += fmt::format("<li>{}: {}</li>\n", escape(text(run, "name")), escape(why));
  }
  if (!failures.empty()) failures = "<ul>\n" + failures + "</ul>\n";
  return fmt::format("<div class=\"status\"><b>Not successful:</b> {} (exit code {:g}).{}</div>\n", words, code,
                     failures);
}

std::string status(const Part& part) {
  const Json& summary = part.summary;
  return status(summary, list(summary, "runs").size(), count_failed(summary), list(summary, "expect").size(),
                count_unmet(summary));
}

/// The HTML id of a file's section.
std::string anchor(std::size_t index) { return fmt::format("part-{}", index + 1); }

/// The results as the program tabulated them, or else the class and peak of every run.
std::string results(const Json& summary, const std::vector<Part>& linked = {}) {
  const Json& given = object(summary, "results");
  std::vector<std::string> header;
  for (const Json& name : list(given, "columns")) header.push_back(name.is_string() ? name.get<std::string>() : "");
  if (!header.empty()) {
    Table table(header);
    for (const Json& row : list(given, "rows")) {
      std::vector<Cell> cells;
      for (const Json& value : row) cells.push_back(cell(value));
      for (std::size_t i = 0; i < linked.size() && !cells.empty(); ++i) {
        if (cells[0].html != escape(linked[i].name)) continue;
        cells[0].html = fmt::format("<a href=\"#{}\">{}</a>", anchor(i), cells[0].html);
        break;
      }
      table.add(std::move(cells));
    }
    return table.html();
  }
  Table table({"run", "class", "peak", "value", "at"});
  for (const Json& run : list(summary, "runs")) {
    const Json& peak = object(run, "peak");
    table.add({cell(run, "name"),
               cell(run, "class"),
               cell(peak, "column"),
               quantity(peak, "value", text(peak, "unit")),
               {place_in_words(peak)}});
  }
  return table.html();
}

std::string figures(const Part& part, std::size_t& counter) {
  std::string out;
  for (const Figure& figure : part.figures) {
    ++counter;
    out += "<figure>\n";
    out += figure.svg.empty() ? fmt::format(
                                    "<div class=\"missing\">No picture here. Its script is "
                                    "<code>{}plots/{}.gp</code>.</div>\n",
                                    part.name.empty() ? "" : escape(part.name) + "/", escape(figure.id))
                              : figure.svg;
    out += fmt::format("<figcaption><b>Figure {}. {}</b> {}</figcaption>\n", counter,
                       figure.title.empty() ? "" : escape(figure.title) + ".", escape(figure.caption));
    for (const std::string& problem : figure.problems) {
      out += fmt::format("<p class=\"remark\">{}</p>\n", escape(problem));
    }
    out += "</figure>\n";
  }
  return out.empty() ? out : "<div class=\"figures\">\n" + out + "</div>\n";
}

std::string comparisons(const Json& summary) {
  Table table({"run", "quantity", "against", "compared with", "points", "rms difference", "of largest", "class",
               "counts as", "note"});
  for (const Json& entry : list(summary, "compare")) {
    Cell share;
    if (const auto of = entry.find("rms_of_largest"); of != entry.end() && of->is_number()) {
      share = {fmt::format("{:.1f} %", 100 * of->get<double>()), true, ""};
    }
    table.add({cell(entry, "run"), cell(entry, "column"), cell(entry, "against"), cell(entry, "label"),
               cell(entry, "points"), quantity(entry, "rms", text(entry, "unit"), 3), share, cell(entry, "class"),
               cell(entry, "role"), cell(entry, "note")});
  }
  return table.html();
}

std::string expectations(const Json& summary) {
  Table table({"run", "quantity", "at", "got", "wanted", "difference", "allowed", "verdict", "because"});
  for (const Json& entry : list(summary, "expect")) {
    const std::string unit = text(entry, "unit");
    const std::string within_unit = text(entry, "within_unit");
    // A check of a class or a status wants a word, not a number.
    const auto value = [&entry, &unit](const std::string& key) {
      const auto found = entry.find(key);
      return found != entry.end() && found->is_number() ? quantity(entry, key, unit, 6) : cell(entry, key);
    };
    const auto margin = [&entry, &within_unit](const std::string& key) {
      const auto found = entry.find(key);
      return found != entry.end() && found->is_number() ? quantity(entry, key, within_unit, 3) : cell(entry, key);
    };
    const Cell verdict = is_met(entry) ? Cell{"met", false, "met"} : Cell{"NOT MET", false, "unmet"};
    table.add({cell(entry, "run"),
               cell(entry, "column"),
               {place_in_words(entry)},
               value("got"),
               value("want"),
               margin("difference"),
               margin("within"),
               verdict,
               cell(entry, "because")});
  }
  return table.html();
}

std::string parameters(const Json& summary) {
  constexpr int digits_as_given = 9;
  Table table({"parameter", "value", "unit", "meaning", "source"});
  for (const Json& entry : list(summary, "parameters")) {
    Cell value = cell(entry, "value", digits_as_given);
    if (entry.value("varies", false)) {
      value.html += (value.html.empty() ? "" : " ") + std::string("<span class=\"soft\">varies</span>");
    }
    const std::string unit = shown_unit(text(entry, "unit"));
    table.add({cell(entry, "name"), value, {escape(unit)}, cell(entry, "meaning"), cell(entry, "source")});
  }
  return table.html();
}

/// How often each admissibility check fired in each run.
std::string fired(const Json& summary) {
  Table table({"run", "fired"});
  bool any = false;
  std::vector<std::string> watched;
  for (const Json& run : list(summary, "runs")) {
    std::string counts;
    for (const auto& [check, count] : object(run, "admit").items()) {
      if (std::find(watched.begin(), watched.end(), check) == watched.end()) watched.push_back(check);
      if (count.is_number() ? count.get<double>() == 0.0 : count.empty()) continue;
      counts += fmt::format("{}{}: {}", counts.empty() ? "" : ", ", escape(check), cell(count).html);
    }
    if (object(run, "admit").empty()) continue;
    any = any || !counts.empty();
    table.add({cell(run, "name"), counts.empty() ? Cell{"nothing", false, "soft"} : Cell{counts}});
  }
  if (watched.empty()) return "";
  return any ? table.html()
             : fmt::format("<p>Nothing fired in any run (watched: {}).</p>\n",
                           escape(fmt::format("{}", fmt::join(watched, ", "))));
}

std::string solver(const Json& summary) {
  Table table({"run", "status", "method", "steps", "rhs evaluations", "estimated error", "solver time"});
  for (const Json& run : list(summary, "runs")) {
    Cell error = cell(run, "global_error_estimate", 2);
    table.add({cell(run, "name"), cell(run, "status"), cell(run, "method"), cell(run, "steps", 9),
               cell(run, "rhs_evaluations", 9), error, quantity(run, "solver_ms", "ms", 3)});
  }
  std::vector<std::string> totals;
  const auto total = [&](const std::string& key, const std::string& unit, const std::string& what) {
    const std::string amount = show(number(summary, key, missing), unit, 3);
    if (!amount.empty()) totals.push_back(amount + " " + what);
  };
  total("wall_s", "s", "elapsed");
  total("cpu_s", "s", "of processor time");
  total("peak_memory_mb", "MB", "of memory at most");
  const std::string whole =
      totals.empty() ? "" : fmt::format("<p class=\"soft\">All runs together: {}.</p>\n", fmt::join(totals, ", "));
  return table.html() + whole;
}

std::string notes(const Json& summary) {
  std::string out;
  for (const Json& warning : list(summary, "warnings")) {
    out += fmt::format("<li><span class=\"warning\">Warning:</span> {}</li>\n", cell(warning).html);
  }
  for (const Json& note : list(summary, "notes")) out += fmt::format("<li>{}</li>\n", cell(note).html);
  return out.empty() ? out : "<ul class=\"notes\">\n" + out + "</ul>\n";
}

std::string content(const Part& part, int level, std::size_t& counter) {
  const Json& summary = part.summary;
  return section(level, "Results", results(summary)) + section(level, "Figures", figures(part, counter)) +
         section(level, "Comparison with reference data", comparisons(summary)) +
         section(level, "Expectations", expectations(summary)) + section(level, "Parameters", parameters(summary)) +
         section(level, "What fired", fired(summary)) + section(level, "Solver", solver(summary)) +
         section(level, "Notes and warnings", notes(summary));
}

std::string source(const Json& summary) {
  const std::string words = text(summary, "source");
  return words.empty() ? "" : fmt::format("<p class=\"source\">{}</p>\n", escape(words));
}

std::string footer(const Json& summary) {
  const std::string program = text(summary, "program").empty() ? "grainlaw" : text(summary, "program");
  return fmt::format(
      "<footer>The curves are in the CSV files {}, the gnuplot scripts of the figures in <code>plots</code> beside "
      "them; <code>{} plot</code> with the name of this folder draws this page again.</footer>\n",
      summary.contains("files") ? "in the folder of each file" : "in this folder", escape(program));
}

/// A line of the contents: how many runs, and how they fared.
std::string outline(const Part& part) {
  const std::size_t expected = list(part.summary, "expect").size();
  const std::size_t unmet = count_unmet(part.summary);
  const std::size_t failed = count_failed(part.summary);
  std::vector<std::string> words{counted(list(part.summary, "runs").size(), "run")};
  if (failed > 0) words.push_back(fmt::format("<span class=\"unmet\">{} did not finish</span>", failed));
  if (expected > 0 && unmet == 0) words.push_back(counted(expected, "expectation") + " met");
  if (unmet > 0) {
    words.push_back(
        fmt::format("<span class=\"unmet\">{} of {} NOT MET</span>", unmet, counted(expected, "expectation")));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

std::string single_page(const Part& part) {
  const Json& summary = part.summary;
  std::size_t counter = 0;
  const std::string title = text(summary, "title");
  return document(title, fmt::format("<header>\n<h1>{}</h1>\n{}{}{}</header>\n", escape(title), source(summary),
                                     facts(summary, true), status(part)) +
                             content(part, 2, counter) + footer(summary));
}

std::string combined_page(const Json& summary, const std::vector<Part>& parts) {
  std::size_t runs = 0;
  std::size_t failed = 0;
  std::size_t expected = 0;
  std::size_t unmet = 0;
  std::string contents;
  std::string sections;
  std::size_t counter = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    runs += list(part.summary, "runs").size();
    failed += count_failed(part.summary);
    expected += list(part.summary, "expect").size();
    unmet += count_unmet(part.summary);
    const std::string title = escape(text(part.summary, "title"));
    contents +=
        fmt::format("<li><a href=\"#{}\">{}</a> <span>\u2013 {}</span></li>\n", anchor(i), title, outline(part));
    sections += fmt::format("<section class=\"part\" id=\"{}\">\n<h2>{}</h2>\n{}{}{}{}</section>\n", anchor(i), title,
                            source(part.summary), facts(part.summary, false), status(part), content(part, 3, counter));
  }
  // The overall summary may leave the program to its parts.
  Json about = summary;
  for (const char* key : {"program", "version", "commit"}) {
    if (text(about, key).empty() && !parts.empty()) about[key] = text(parts.front().summary, key);
  }
  std::string title = text(about, "title");
  if (title.empty()) title = fmt::format("{} element tests", parts.size());
  return document(title, fmt::format("<header>\n<h1>{}</h1>\n{}{}{}</header>\n", escape(title), source(about),
                                     facts(about, true), status(about, runs, failed, expected, unmet)) +
                             section(2, "Contents", "<ol class=\"contents\">\n" + contents + "</ol>\n") +
                             section(2, "Results", results(about, parts)) +
                             section(2, "Notes and warnings", notes(about)) + sections + footer(about));
}

}  // namespace grainlaw::report
