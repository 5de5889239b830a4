// Interface of the terrain surface over the horizontal plane. Coordinates are relative to the domain's lower corner
// [m]; the vertical is the last axis.
#pragma once

#include <cmath>

#include "base/linear.hpp"

namespace thawslide::terrain {

template <int Dim>
class Surface {
 public:
  using Point = Vector<double, Dim - 1>;  // x in 2D; x, y in 3D

  Surface() = default;
  virtual ~Surface() = default;
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  // Elevation at a place [m].
  [[nodiscard]] virtual double height(const Point& point) const = 0;
  // Gradient at a place; on a surface of finer detail, its mean over a square of side `width` [m].
  [[nodiscard]] virtual Point gradient(const Point& point, double width) const = 0;
  // Upper bound of the slope over the rectangle between two places, as a gradient.
  [[nodiscard]] virtual double steepest(const Point& from, const Point& to) const = 0;

  // Means over the hat function of a column of nodes, max(0, 1 - |x - x_at|/cell) along each axis: elevation [m], and
  // area of the ground per horizontal area.
  struct ColumnMeans {
    double height, area;
  };
  [[nodiscard]] virtual ColumnMeans column_means(const Point& at, double cell) const = 0;

  // True if the ground is known at a place, or everywhere in the rectangle between two places. On unknown ground, the
  // other functions extrapolate.
  [[nodiscard]] virtual bool is_known(const Point& /*point*/) const { return true; }
  [[nodiscard]] virtual bool is_known(const Point& /*from*/, const Point& /*to*/) const { return true; }

  // Cosine of the slope, averaged over `width` [m].
  [[nodiscard]] double slope_cosine(const Point& point, double width) const {
    return 1.0 / std::hypot(1.0, gradient(point, width).norm());
  }
  // Unit normal into the ground below a place, averaged over `width` [m].
  [[nodiscard]] Vector<double, Dim> normal_below(const Point& point, double width) const {
    Vector<double, Dim> normal;
    normal.template head<Dim - 1>() = gradient(point, width);
    normal[Dim - 1] = -1.0;
    return normal.normalized();
  }
};

}  // namespace thawslide::terrain
