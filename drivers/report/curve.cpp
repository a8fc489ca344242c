#include "curve.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace grainlaw::report {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

// Fractions of the picture's width: a sixth of a pixel, and most of a marker's diameter.
constexpr double line_tolerance = 3e-4;
constexpr double marker_gap = 0.015;

double distance(const Point& point, const Point& from, const Point& to) {
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const double length2 = dx * dx + dy * dy;
  const double along = length2 > 0.0 ? ((point.x - from.x) * dx + (point.y - from.y) * dy) / length2 : 0.0;
  const double s = std::clamp(along, 0.0, 1.0);
  return std::hypot(point.x - from.x - s * dx, point.y - from.y - s * dy);
}

/// Douglas-Peucker: how far the line from first to last would move if an inner point and its kin were left out.
void rank(const Curve& placed, std::size_t first, std::size_t last, std::vector<double>& weight) {
  struct Span {
    std::size_t first, last;
    double bound;
  };
  weight[first] = weight[last] = infinite;
  std::vector<Span> spans{{first, last, infinite}};
  while (!spans.empty()) {
    const Span span = spans.back();
    spans.pop_back();
    double farthest = 0.0;
    std::size_t split_at = span.first;
    for (std::size_t i = span.first + 1; i < span.last; ++i) {
      const double d = distance(placed[i], placed[span.first], placed[span.last]);
      if (d > farthest) {
        farthest = d;
        split_at = i;
      }
    }
    if (farthest < line_tolerance) continue;
    // A point never outranks the one that split its span, so that any cut of the ranking is a valid line.
    weight[split_at] = std::min(span.bound, farthest);
    spans.push_back({span.first, split_at, weight[split_at]});
    spans.push_back({split_at, span.last, weight[split_at]});
  }
}

}  // namespace

bool is_finite(const Point& point) { return std::isfinite(point.x) && std::isfinite(point.y); }

Point Frame::transform(const Point& point) const {
  const auto logarithm = [](double value) { return value > 0.0 ? std::log10(value) : not_a_number; };
  return {log_x_ ? logarithm(point.x) : point.x, log_y_ ? logarithm(point.y) : point.y};
}

void Frame::include(const Curve& curve) {
  for (const Point& point : curve) {
    const Point at = transform(point);
    if (!is_finite(at)) continue;
    if (empty_) low_ = high_ = at;
    empty_ = false;
    low_ = {std::min(low_.x, at.x), std::min(low_.y, at.y)};
    high_ = {std::max(high_.x, at.x), std::max(high_.y, at.y)};
  }
}

Point Frame::place(const Point& point) const {
  const auto share = [](double value, double low, double high) {
    return high > low ? (value - low) / (high - low) : value - low;
  };
  const Point at = transform(point);
  return {share(at.x, low_.x, high_.x), share(at.y, low_.y, high_.y)};
}

Curve thin_line(const Curve& curve, const Frame& frame, std::size_t limit) {
  Curve placed;
  placed.reserve(curve.size());
  for (const Point& point : curve) placed.push_back(frame.place(point));

  std::vector<double> weight(curve.size(), 0.0);
  for (std::size_t first = 0; first < placed.size(); ++first) {
    if (!is_finite(placed[first])) continue;
    std::size_t last = first;
    while (last + 1 < placed.size() && is_finite(placed[last + 1])) ++last;
    rank(placed, first, last, weight);
    first = last;
  }

  double threshold = line_tolerance;
  if (std::vector<double> ranking = weight; limit > 0 && ranking.size() > limit) {
    const auto cut = ranking.begin() + static_cast<std::ptrdiff_t>(limit - 1);
    std::nth_element(ranking.begin(), cut, ranking.end(), std::greater<>());
    threshold = std::max(threshold, *cut);
  }
  Curve kept;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (!is_finite(placed[i])) {
      if (!kept.empty() && is_finite(kept.back())) kept.push_back({not_a_number, not_a_number});
    } else if (weight[i] >= threshold) {
      kept.push_back(curve[i]);
    }
  }
  return kept;
}

Curve thin_markers(const Curve& curve, const Frame& frame, std::size_t limit) {
  Curve apart;
  Point before{not_a_number, not_a_number};
  for (const Point& point : curve) {
    const Point at = frame.place(point);
    if (!is_finite(at)) continue;
    if (is_finite(before) && std::hypot(at.x - before.x, at.y - before.y) < marker_gap) continue;
    apart.push_back(point);
    before = at;
  }
  const std::size_t step = limit > 0 ? (apart.size() + limit - 1) / limit : 1;
  Curve kept;
  for (std::size_t i = 0; i < apart.size(); i += std::max<std::size_t>(step, 1)) kept.push_back(apart[i]);
  return kept;
}

}  // namespace grainlaw::report
