#pragma once

#include <filesystem>
#include <string>

namespace grainlaw::report {

/// What became of a report: the page, whether every picture was drawn, and what to do if not.
struct Outcome {
  std::filesystem::path page;
  bool pictures = true;
  std::string message;
};

/// Draws every figure listed in dir/summary.json and writes dir/report.html (self-contained, opens offline).
/// Throws std::runtime_error naming the file when a summary is missing or malformed.
Outcome build(const std::filesystem::path& dir);

}  // namespace grainlaw::report
