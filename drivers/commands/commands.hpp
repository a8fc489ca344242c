// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace grainlaw::commands {

/// Exit codes of every command.
enum Exit : int { done = 0, expectation_missed = 1, bad_input = 2, numerical_failure = 3, interrupted = 130 };

struct ElementOptions {
  std::vector<std::string> files;
  std::string out;
  std::vector<std::string> sets;
  bool quiet = false, no_plot = false;
};
int element(const ElementOptions& options);
int check(const std::string& file, const std::vector<std::string>& sets);
int laws(const std::string& name, bool markdown);
int materials(const std::string& name);
int plot(const std::string& dir);

}  // namespace grainlaw::commands
