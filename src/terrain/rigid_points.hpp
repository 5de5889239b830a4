// The ground as rigid material points in layers, as the paper has it: what nodes know of it comes from the points, not
// from a signed distance. Nairn (2013) gives the contact area; the ground's surface is then known to within a cell.
#pragma once

#include "terrain/polyline.hpp"

namespace thawslide::terrain {

class RigidPoints {
 public:
  // Points stand at the centres of squares of side `spacing` [m] on the lattice of the domain's lower corner, below the
  // line and at most `layers` squares deep.
  RigidPoints(const Polyline& line, double spacing, int layers);

  struct AtNode {
    double volume;             // V_b = sum v S_i with the linear shape functions [m2]
    Vector<double, 2> normal;  // along minus sum v grad S_i: from the slide into the ground
  };
  // For the node at (x, height) of cells `cell`; volume 0 where no point is near.
  [[nodiscard]] AtNode at_node(double x, double height, double cell) const;

 private:
  [[nodiscard]] bool is_rock(long column, long row) const;

  const Polyline* line_;
  double spacing_;
  int layers_;
};

// A = sqrt(2 min(V_a, V_b) (V_a + V_b))/h [m2 per metre], the area of contact of the volumes V_a and V_b of two bodies
// at a node of cells h (Nairn 2013): h exactly on a flat surface along a grid line.
double nairn_area(double slide_volume, double rock_volume, double cell);

}  // namespace thawslide::terrain
