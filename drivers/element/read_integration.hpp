// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// For how long a test runs, how it is integrated and which rows it writes.
#include <string>
#include <utility>
#include <vector>

#include "../input/reader.hpp"
#include "element_test.hpp"

namespace grainlaw::element {

/// What was filled in because the file did not say it: path and text, for as_run.yaml.
struct Defaults {
  std::vector<std::pair<std::string, std::string>> list;
  void add(std::string path, std::string text) { list.emplace_back(std::move(path), std::move(text)); }
};

/// What the law of a material needs, known without building it.
struct LawNeeds {
  bool void_ratio = false, stress = false, forms = false;
};
LawNeeds needs_of(const std::string& law);

/// Reads `until` of the test.
void read_until(ElementTest& test, input::Reader& reader, Defaults& defaults);

/// Reads `integrator`; `mixed` when a list of methods has some with a fixed step and some with error control.
void read_integrator(ElementTest& test, const input::Node* node, bool mixed, Defaults& defaults);
bool mixed_methods(const input::Node& file);

/// Reads `output` into the times of the rows; needs the end of the test and its integrator.
void read_output(ElementTest& test, const input::Node* node, Defaults& defaults);

}  // namespace grainlaw::element
