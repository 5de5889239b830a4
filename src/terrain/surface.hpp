// Interface of the terrain surface over the horizontal plane. Coordinates are relative to the domain's lower corner
// [m]; the vertical is the last axis.
#pragma once

#include <array>
#include <cmath>

#include "base/linear.hpp"

namespace thawslide::terrain {

// Ground at a node, computed once.
template <int Dim>
struct GroundAtNode {
  bool candidate = false;    // the node's linear shape function overlaps the ground
  int substrate = 0;         // below the node (substrates.hpp)
  Vector<Real, Dim> normal;  // unit vector from the sliding mass into the ground, along G = integral of S n dA
  Real area = 0;         // B = integral of the shape function S over the ground's surface [m2]; sums to that surface
  Real bend = 1;         // B/|G|: 1 on a plane, larger where the ground bends within reach of the node
  Real plane = 0;        // c.n with c = integral of x S dA / B: places x with x.n = c.n are the node's plane [m];
                         // infinite unless the node is a candidate
  Real space = 0;        // integral of the shape function over the space above the ground [m3]
  Real distance = 0;     // from the ground, positive above it [m]
  Real elevation = 0;    // of the node, only on cells that follow the ground [m]
  Real plane_scale = 1;  // factor of both sides of x.n = c.n; `plane` includes it (terrain/following_ground.hpp)
};

template <int Dim>
class Surface {
 public:
  using Point = Vector<double, Dim - 1>;  // x in 2D; x, y in 3D
  using NodeIndex = std::array<int, Dim>;

  Surface() = default;
  virtual ~Surface() = default;
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  // Elevation at a place [m].
  [[nodiscard]] virtual double height(const Point& point) const = 0;
  // Gradient at a place; on a surface of finer detail, its mean over a square of side `width` [m].
  [[nodiscard]] virtual Point gradient(const Point& point, double width) const = 0;
  // Highest elevation over the rectangle between two places [m].
  [[nodiscard]] virtual double highest(const Point& from, const Point& to) const = 0;

  // Upper bound of the slope over the rectangle between two places, as a gradient.
  [[nodiscard]] virtual double steepest(const Point& from, const Point& to) const = 0;

  // Means over the hat function of a column of nodes, max(0, 1 - |x - x_at|/cell) along each axis: elevation [m], and
  // area of the ground per horizontal area.
  struct ColumnMeans {
    double height, area;
  };
  [[nodiscard]] virtual ColumnMeans column_means(const Point& at, double cell) const = 0;

  // Fills the ground data of the `edge`^Dim nodes of a block, x fastest. first: index of its first node along each axis
  // of a grid with cells of side `cell` [m].
  virtual void at_block(const NodeIndex& first, double cell, int edge, GroundAtNode<Dim>* nodes) const = 0;

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
