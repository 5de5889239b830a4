// How thick the cells along the ground are which make up the band: one cell on level ground along a grid line, 1.5 to
// 2.3 cells where a slope cuts through them.
#pragma once

#include <vector>

#include "terrain/ground.hpp"

namespace thawslide::terrain {

class LayerThickness {
 public:
  // For the band cells (those with a candidate corner, see GroundAtNode) over 0 <= x <= extent [m], filled by particles
  // as bodies are: at the centres of the cells' equal parts, `spacing` apart, where these lie above the ground.
  template <int Dim>
  LayerThickness(const Ground<Dim>& ground, double cell, double spacing, double extent);

  // Volume of the particles in the band cells over the ground's surface [m], both averaged over some columns of cells
  // about x with weights that fall off linearly: without that it would jump from column to column, and with it the
  // heat of particles that slide through them.
  [[nodiscard]] double at(double x) const;
  [[nodiscard]] double largest() const;

 private:
  double cell_;
  std::vector<double> at_middle_;  // of the columns, from the one before x = 0 on
};

}  // namespace thawslide::terrain
