// SPDX-License-Identifier: BSD-3-Clause
// The command line: reads what was asked for and hands it to one command.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "commands/commands.hpp"
#include "input/source.hpp"
#include "version.hpp"

namespace {

/// What may have been meant by the first word or option that nobody knows.
std::string advice(CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string> known;
  for (const auto* each : app.get_subcommands({})) known.push_back(each->get_name());
  if (words.empty()) return "commands: " + grainlaw::input::join(known);
  if (std::find(known.begin(), known.end(), words[0]) == known.end() && !words[0].starts_with('-'))
    return fmt::format("'{}' is no command; {}", words[0], grainlaw::input::did_you_mean(words[0], known));
  const CLI::App& chosen = words[0].starts_with('-') ? app : *app.get_subcommand(words[0]);
  known.clear();
  for (const auto* option : chosen.get_options()) {
    if (option->nonpositional()) known.push_back(option->get_name(false, false));
  }
  for (const auto& word : words) {
    const std::string name = word.substr(0, word.find('='));
    if (name.starts_with("--") && std::find(known.begin(), known.end(), name) == known.end())
      return fmt::format("'{}' is no option of it; {}", name, grainlaw::input::did_you_mean(name, known));
  }
  return fmt::format("see '{} --help'", &chosen == &app ? "grainlaw" : "grainlaw " + chosen.get_name());
}

}  // namespace

int main(int argc, char** argv) {
  using namespace grainlaw;
  CLI::App app{"Constitutive laws for dense granular flow, put on trial.", "grainlaw"};
  app.set_version_flag("--version", fmt::format("grainlaw {} ({})", program_version, program_commit));
  app.require_subcommand(1);
  app.footer("Exit codes: 0 done, 1 an expectation was not met, 2 bad input, 3 numerical failure, 130 interrupted.");

  int code = commands::done;
  commands::ElementOptions run;
  auto* element = app.add_subcommand("element", "Run element tests from YAML files and write CSV, summary and report");
  element->add_option("FILE", run.files, "element test files")->required();
  element->add_option("--out", run.out, "output folder (default: out/<file stem>, or out for several files)");
  element->add_option("--set", run.sets, "override a key: test.initial.pressure='50 kPa' (may be repeated)")
      ->allow_extra_args(false);
  element->add_flag("--quiet", run.quiet, "print errors only");
  element->add_flag("--no-plot", run.no_plot, "write no pictures and no report");
  element->callback([&] { code = commands::element(run); });

  std::string checked, name, folder;
  std::vector<std::string> check_sets;
  bool markdown = false;
  auto* check = app.add_subcommand("check", "Validate a file without running it");
  check->add_option("FILE", checked, "element test file")->required();
  check->add_option("--set", check_sets, "override a key")->allow_extra_args(false);
  check->callback([&] { code = commands::check(checked, check_sets); });

  auto* laws = app.add_subcommand("laws", "List the laws, or show one with parameters, units, ranges and source");
  laws->add_option("NAME", name, "name of a law");
  laws->add_flag("--markdown", markdown, "write tables in Markdown");
  laws->callback([&] { code = commands::laws(name, markdown); });

  auto* materials = app.add_subcommand("materials", "List the named materials, or show one with its critical states");
  materials->add_option("NAME", name, "name of a material");
  materials->callback([&] { code = commands::materials(name); });

  auto* plot = app.add_subcommand("plot", "Draw the pictures and the report of an output folder again");
  plot->add_option("DIR", folder, "output folder")->required();
  plot->callback([&] { code = commands::plot(folder); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& wrong) {
    fmt::print(stderr, "grainlaw: error: {}\n  = {}\n", wrong.what(), advice(app, {argv + 1, argv + argc}));
    return commands::bad_input;
  } catch (const input::InputError& wrong) {
    const std::string_view text = wrong.what();
    fmt::print(stderr, "{}{}", text, text.ends_with('\n') ? "" : "\n");
    return commands::bad_input;
  } catch (const std::exception& wrong) {
    fmt::print(stderr, "grainlaw: error: {}\n", wrong.what());
    return commands::bad_input;
  }
  return code;
}
