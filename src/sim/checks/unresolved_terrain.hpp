// Terrain that cells which follow it do not represent: slopes above their limit, narrow dykes and gullies.
#pragma once

#include <string>
#include <vector>

#include "sim/checks/body_figures.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

// Warnings of sim/checks/steep_terrain.hpp, and about the narrow dyke and the narrow gully that lose most of their
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
