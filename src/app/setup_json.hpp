// Input of thawslide-report --setup: terrain, grid, bodies, boundaries and frames of a case as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "sim/simulation.hpp"

namespace thawslide::app {

// A map if the terrain is a DEM, otherwise a section along x. Heights of a DEM are thinned to the resolution of a
// figure.
template <int Dim>
nlohmann::ordered_json setup_json(const sim::Simulation<Dim>& simulation);

}  // namespace thawslide::app
