// Terrain that cells which follow it do not represent: slopes above their limit, narrow dykes and gullies.
#pragma once

#include <string>
#include <vector>

#include "base/rounding.hpp"
#include "sim/checks/body_figures.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

// Text such as "x = 120 m, y = 350 m".
template <int Dim>
std::string place_text(double x, double y) {
  const std::string text = fmt::format("x = {} m", coordinate_text(x));
  return Dim == 2 ? text : text + fmt::format(", y = {} m", coordinate_text(y));
}

// Elevation of the highest particle [m].
template <int Dim>
[[nodiscard]] double top_of_bodies(const Simulation<Dim>& simulation) {
  double top = -HUGE_VAL;
  for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
    top = std::max(top, simulation.particles().position(p, Dim - 1) + simulation.model().origin[Dim - 1]);
  }
  return top;
}

// Warnings about columns of nodes that were lowered to the limit of slopes, bodies whose ground is lower than the
// terrain, and ground on which steps become much shorter than at the start. terrain: the terrain on points. Empty
// without terrain.
template <int Dim>
[[nodiscard]] std::vector<std::string> warnings_of_steep_terrain(const Simulation<Dim>& simulation,
                                                                 const std::vector<BodyFigures>& bodies,
                                                                 const Raster& terrain);

// Warnings of warnings_of_steep_terrain, and about the narrow dyke and the narrow gully that lose most of their
// height. These are crests and thalwegs of the terrain before its filter, within the domain and outside the scars of
// releases, that
// - are lower than the top of the bodies, which may therefore reach them,
// - rise above (fall below) the terrain on both sides within two cells (four for gullies) by more than a quarter of the
//   median thickness of the thickest body, and reach two thirds of this height within half the distance,
// - have less than two thirds of this height in the ground of the grid.
// Empty without terrain.
template <int Dim>
[[nodiscard]] std::vector<std::string> warnings_of_unresolved_terrain(const Simulation<Dim>& simulation,
                                                                      const std::vector<BodyFigures>& bodies);

}  // namespace thawslide::sim
