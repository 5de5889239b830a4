// Ground as rigid material points in layers, as published: ground data at nodes follow from the points instead of a
// signed distance. The contact area is that of Nairn (2013); the surface is then resolved to within a cell.
#pragma once

#include "terrain/polyline.hpp"

namespace thawslide::terrain {

class RigidPoints {
 public:
  // Points are at the centres of squares of side `spacing` [m], on the lattice of the domain's lower corner, below the
  // line and at most `layers` squares deep.
  RigidPoints(const Polyline& line, double spacing, int layers);

  struct AtNode {
    double volume;             // V_b = sum v S_i with the linear shape functions [m2]
    Vector<double, 2> normal;  // along minus sum v grad S_i: from the sliding mass into the ground
  };
  // Values at the node at (x, height) on a grid of cell size `cell`; volume 0 if no point is near.
  [[nodiscard]] AtNode at_node(double x, double height, double cell) const;

 private:
  [[nodiscard]] bool is_rock(long column, long row) const;

  const Polyline* line_;
  double spacing_;
  int layers_;
};

// A = sqrt(2 min(V_a, V_b) (V_a + V_b))/h [m2 per metre], contact area of two bodies of volumes V_a and V_b at a node
// of cell size h (Nairn 2013); equal to h on a flat surface along a grid line.
double nairn_area(double slide_volume, double rock_volume, double cell);

}  // namespace thawslide::terrain
