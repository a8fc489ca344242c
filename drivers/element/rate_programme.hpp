// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

namespace grainlaw::element {

/// A rate that is linear in time piece by piece; after the last piece it stays at its last value.
struct RateProgramme {
  struct Piece {
    double from, to;  ///< [1/s]
    double over;      ///< [s]
  };
  std::vector<Piece> pieces;

  static RateProgramme constant(double rate) { return {{{rate, rate, 0}}}; }

  double last() const { return pieces.back().to; }
  double duration() const {
    double sum = 0;
    for (const auto& p : pieces) sum += p.over;
    return sum;
  }
  double largest() const {
    double most = 0;
    for (const auto& p : pieces) most = std::max({most, std::abs(p.from), std::abs(p.to)});
    return most;
  }
  double at(double t) const {
    double begin = 0;  // summed as in kinks(), so that both agree to the last bit
    for (const auto& p : pieces) {
      if (t < begin + p.over) return p.from + (p.to - p.from) * ((t - begin) / p.over);
      begin += p.over;
    }
    return last();
  }
  double slope(double t) const {
    double begin = 0;
    for (const auto& p : pieces) {
      if (t < begin + p.over) return (p.to - p.from) / p.over;
      begin += p.over;
    }
    return 0;
  }
  /// Integral of the rate from 0 to t.
  double strain(double t) const {
    double sum = 0, begin = 0;
    for (const auto& p : pieces) {
      if (t <= begin) return sum;
      const double in = std::min(t - begin, p.over);
      if (in > 0) sum += in * (p.from + 0.5 * (p.to - p.from) * in / p.over);
      begin += p.over;
    }
    return sum + last() * std::max(t - begin, 0.0);
  }
  /// Integral of |rate| from 0 to t: the length of the strain path.
  double path(double t) const {
    double sum = 0, begin = 0;
    for (const auto& p : pieces) {
      if (t <= begin) return sum;
      const double in = std::min(t - begin, p.over);
      if (in > 0) {
        const double a = p.from, b = p.from + (p.to - p.from) * in / p.over;
        sum += a * b >= 0 ? 0.5 * in * std::abs(a + b) : 0.5 * in * (a * a + b * b) / std::abs(b - a);
      }
      begin += p.over;
    }
    return sum + std::abs(last()) * std::max(t - begin, 0.0);
  }
  /// The time at which path() reaches a length; infinity when it never does.
  double time_of_path(double length) const {
    double high = duration();
    if (path(high) < length) {
      const double rate = std::abs(last());
      return rate > 0 ? high + (length - path(high)) / rate : std::numeric_limits<double>::infinity();
    }
    double low = 0;  // monotone: bisection to the last bit
    for (int i = 0; i < 200 && low < high; ++i) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      (path(middle) < length ? low : high) = middle;
    }
    return high;
  }
  /// Instants at which the rate is not smooth, inside (0, t_end).
  std::vector<double> kinks(double t_end) const {
    std::vector<double> list;
    double t = 0;
    for (const auto& p : pieces) {
      if (p.over > 0 && p.from * p.to < 0) list.push_back(t + p.over * p.from / (p.from - p.to));
      t += p.over;
      if (t > 0) list.push_back(t);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    std::erase_if(list, [&](double x) { return !(x < t_end); });
    return list;
  }
};

}  // namespace grainlaw::element
