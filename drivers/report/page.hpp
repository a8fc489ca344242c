#pragma once

#include <string>
#include <vector>

#include "figure.hpp"

namespace grainlaw::report {

/// One element file of a report: its summary and its figures.
struct Part {
  std::string name;
  Json summary;
  std::vector<Figure> figures;
};

/// The page of one element file.
std::string single_page(const Part& part);

/// The page of several element files: contents, the overall results, and a section for each file.
std::string combined_page(const Json& summary, const std::vector<Part>& parts);

}  // namespace grainlaw::report
