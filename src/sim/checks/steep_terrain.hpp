// Ground steeper than cells represent, or so steep that steps become short.
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

}  // namespace thawslide::sim
