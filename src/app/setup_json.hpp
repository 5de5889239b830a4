// What thawslide-report --setup draws before a run: terrain, grid, bodies, boundaries and frames as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "sim/simulation.hpp"

namespace thawslide::app {

// A map where the terrain is a DEM, otherwise a section along x. Heights of a DEM are thinned out to what a picture
// shows.
template <int Dim>
nlohmann::ordered_json setup_json(const sim::Simulation<Dim, double>& simulation);

}  // namespace thawslide::app
