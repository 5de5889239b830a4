// Integrals of nodal shape functions over a triangulated surface z(x, y):
//   B = integral of S over the surface,   V = integral of S over the space above it,   G = integral of S n dA,
//   c = integral of x S over the surface / B,
// with a node's linear shape function S = s(x) s(y) s(z), s(x) = max(0, 1 - |x - x_node|/h), and n the unit vector into
// the ground. With the gradient g of a triangle, dA = sqrt(1 + |g|^2) dx dy and n dA = (g, -1) dx dy.
//
// Triangles are cut by the grid's planes into convex polygons that each lie in one grid cell. There, S is a polynomial
// of third degree in the plane's coordinates, and the integral of s(z) upwards from the surface one of second degree in
// the height. A quadrature rule of fourth degree on triangles integrates all of them exactly to round-off.
#pragma once

#include <vector>

#include "terrain/convex_polygon.hpp"
#include "terrain/surface.hpp"

namespace thawslide::terrain {

class SurfaceIntegrals {
 public:
  // nodes: as in Surface::at_block. Sets all members except `distance`, and `plane` only if there is area.
  SurfaceIntegrals(const Vector<double, 3>& lowest, double cell, int edge, GroundAtNode<3>* nodes);

  // Adds a triangle of the surface, counter-clockwise from above. All triangles that overlap the footprint of the shape
  // functions are required, each once.
  void add(const std::array<Vector<double, 3>, 3>& triangle);

  // Call after the last triangle. A node without area has a zero normal.
  void finish();

  // Call instead of adding triangles if the surface is entirely below, or entirely above, the reach of the shape
  // functions.
  void finish_in_space();
  void finish_in_ground();

 private:
  struct Facet {
    double slope_x, slope_y, stretch;  // dz/dx, dz/dy, sqrt(1 + dz/dx^2 + dz/dy^2)
  };
  void add_to_column(int column, int row, const Facet& facet, const ConvexPolygon& segment);
  void add_to_cell(int column, int row, int layer, const Facet& facet, const ConvexPolygon& segment);
  [[nodiscard]] int node(int i, int j, int k) const { return i + edge_ * (j + edge_ * k); }

  Vector<double, 3> corner_;  // lowest corner of the shape functions' reach
  double cell_;
  int edge_;
  GroundAtNode<3>* nodes_;
  std::vector<Vector<double, 3>> moment_;  // by node: integral of S (x - x_node) over the surface, in cells
  std::vector<double>
      top_;  // highest ground over a grid cell's column, by cells from the corner; shape [edge+1, edge+1]
};

}  // namespace thawslide::terrain
