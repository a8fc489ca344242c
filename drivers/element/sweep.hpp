// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <vector>

#include "../input/node.hpp"

namespace grainlaw::element {

struct SingleRun {
  std::string name;  ///< "run", or "void_ratio=0.890"
  input::Node tree;  ///< the file with every list replaced by this run's entry
};

/// One run per entry of the list values in `material`, `test` and `integrator`; several lists are zipped, or multiplied
/// with `sweep: product`. Lists inside `compare` and `expect` follow the runs one by one.
std::vector<SingleRun> expand(const input::Node& file);

/// A run's name as a file name: a slash of a unit must not become a folder.
std::string file_stem(const std::string& run);

}  // namespace grainlaw::element
