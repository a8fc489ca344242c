#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace grainlaw::report {

struct Point {
  double x;
  double y;
};

/// Points in drawing order; a point that is not finite interrupts the line.
using Curve = std::vector<Point>;

bool is_finite(const Point& point);

/// Maps plotted values to the unit square of the picture.
class Frame {
 public:
  Frame(bool log_x, bool log_y) : log_x_(log_x), log_y_(log_y) {}

  /// Widens the frame so that it holds every point of the curve.
  void include(const Curve& curve);

  /// Where the point lies in the unit square; not finite when it cannot be drawn.
  Point place(const Point& point) const;

  /// The smallest values along both axes, in decades on a logarithmic axis.
  Point low() const { return low_; }

  /// The extent of the data along both axes, in decades on a logarithmic axis.
  Point extent() const { return {high_.x - low_.x, high_.y - low_.y}; }

 private:
  Point transform(const Point& point) const;

  bool log_x_;
  bool log_y_;
  bool empty_ = true;
  Point low_{0.0, 0.0};
  Point high_{0.0, 0.0};
};

/// Keeps the points of a line that the eye can tell from their neighbours, at most `limit` and the breaks.
Curve thin_line(const Curve& curve, const Frame& frame, std::size_t limit);

/// Drops markers that would lie on top of the marker before them, then every n-th to stay within `limit`.
Curve thin_markers(const Curve& curve, const Frame& frame, std::size_t limit);

}  // namespace grainlaw::report
