// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "../input/reader.hpp"
#include "element_test.hpp"

namespace grainlaw::element {

/// Every folder in which a named material is looked for, nearest first: beside the file that names it, the folder
/// `materials` beside and above it, $GRAINLAW_DATA, and the data that came with the program.
std::vector<std::filesystem::path> material_folders(const std::filesystem::path& beside);

/// The names that `use:` accepts, sorted.
std::vector<std::string> material_names(const std::filesystem::path& beside);

/// The file of a named material, or nothing.
std::optional<std::filesystem::path> find_material(const std::string& name, const std::filesystem::path& beside);

/// A material file as it stands in data/materials.
struct NamedSet {
  std::string name, title, law, source, notes;
  input::Node tree;
};

/// The law and the named set behind it: what must be known before anything else of a test can be read.
struct MaterialChoice {
  std::string law;
  std::optional<NamedSet> set;
};
MaterialChoice choose_material(input::Reader& reader, const std::filesystem::path& beside);

/// Reads `material:`; void_ratio is needed where k_v comes from Bagnold's formula, k_v where the test gives it.
Material read_material(input::Reader reader, const MaterialChoice& choice, std::optional<double> void_ratio,
                       std::optional<double> k_v_of_test);

/// A named material alone, as `grainlaw materials NAME` shows it.
Material read_named_material(const std::string& name, const std::filesystem::path& beside);

}  // namespace grainlaw::element
