#pragma once

#include <string>
#include <vector>

#include "figure.hpp"

namespace grainlaw::report {

/// Runs gnuplot over the scripts of all figures and reads the pictures back, each made fit to be inlined in a page
/// beside the others; returns "" or what went wrong, which each figure without a picture also notes.
std::string draw(std::vector<Figure*> figures);

}  // namespace grainlaw::report
