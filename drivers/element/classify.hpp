// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <string>
#include <vector>

namespace grainlaw::element {

/// Index of the largest value.
inline std::size_t largest_index(const std::vector<double>& stress) {
  return std::size_t(std::max_element(stress.begin(), stress.end()) - stress.begin());
}

/// Index of the peak of an undrained test: the first maximum that a drop of more than 3 % follows, or the largest value
/// when there is none. (A drained test may be unloaded on its way; its peak is the largest value.)
inline std::size_t peak_index(const std::vector<double>& stress) {
  std::size_t top = 0;
  for (std::size_t i = 0; i < stress.size(); ++i) {
    if (stress[i] < 0.97 * stress[top]) return top;
    if (stress[i] > stress[top]) top = i;
  }
  return top;
}

/// The response of an undrained test from the size of its stress along the path.
///
///     dilative               never more than 3 % below an earlier maximum
///     liquefaction           ends below a fifth of its peak
///     limited liquefaction   drops and regains at least a twentieth of the drop
///     softening              drops and stays down
///
/// Measured curves go through the same rule, hence the 3 %: the noise of a load cell is below it.
inline std::string classify(const std::vector<double>& stress) {
  const std::size_t top = peak_index(stress);
  const double peak = stress[top], last = stress.back();
  const double least = *std::min_element(stress.begin() + std::ptrdiff_t(top), stress.end());
  if (!(least < 0.97 * peak)) return "dilative";
  if (last < 0.2 * peak) return "liquefaction";
  return last - least >= 0.05 * (peak - least) ? "limited liquefaction" : "softening";
}

}  // namespace grainlaw::element
