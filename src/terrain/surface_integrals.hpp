// What the nodes of a block take of a triangulated surface that is a height over the plane:
//   B = integral of S over the surface,   V = integral of S over the space above it,   G = integral of S n dA,
//   c = integral of x S over the surface / B,
// with a node's linear shape function S = s(x) s(y) s(z), s(x) = max(0, 1 - |x - x_node|/h), and n the unit vector into
// the ground. With the gradient g of a triangle, dA = sqrt(1 + |g|^2) dx dy and n dA = (g, -1) dx dy.
//
// A triangle is cut by the grid's planes into convex pieces that lie in one grid cell each. There S is a polynomial of
// third degree in the plane's coordinates, and the integral of s(z) upwards from the surface one of second degree in
// the height; a rule for triangles that is exact to the fourth degree makes all of them exact to round-off.
#pragma once

#include <vector>

#include "terrain/convex_polygon.hpp"
#include "terrain/surface.hpp"

namespace thawslide::terrain {

class SurfaceIntegrals {
 public:
  // Nodes as Surface::at_block has them; it sets all but `distance`, and `plane` where there is area.
  SurfaceIntegrals(const Vector<double, 3>& lowest, double cell, int edge, GroundAtNode<3, double>* nodes);

  // Takes in a triangle of the surface, counter-clockwise as seen from above. All triangles that overlap the footprint
  // of the shape functions are needed, each once.
  void add(const std::array<Vector<double, 3>, 3>& triangle);

  // After the last triangle. A node of no area gets no normal (zero).
  void finish();

  // In place of all triangles: the surface is wholly below, or wholly above, what the shape functions reach.
  void finish_in_space();
  void finish_in_ground();

 private:
  struct Facet {
    double slope_x, slope_y, stretch;  // dz/dx, dz/dy, sqrt(1 + dz/dx^2 + dz/dy^2)
  };
  void add_to_column(int column, int row, const Facet& facet, const ConvexPolygon& segment);
  void add_to_cell(int column, int row, int layer, const Facet& facet, const ConvexPolygon& segment);
  [[nodiscard]] int node(int i, int j, int k) const { return i + edge_ * (j + edge_ * k); }

  Vector<double, 3> corner_;  // lowest corner of what the shape functions reach
  double cell_;
  int edge_;
  GroundAtNode<3, double>* nodes_;
  std::vector<Vector<double, 3>> moment_;  // by node: integral of S (x - x_node) over the surface, in cells
  std::vector<double>
      top_;  // highest ground over a grid cell's column, by cells from the corner; shape [edge+1, edge+1]
};

}  // namespace thawslide::terrain
