// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "element_test.hpp"

namespace grainlaw::element {

/// Reads and validates one element YAML completely; `sets` are the --set assignments. Throws input::InputError.
ElementFile read_element(const std::filesystem::path& path, const std::vector<std::string>& sets);

}  // namespace grainlaw::element
