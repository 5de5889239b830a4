// Terrain that cells which follow it do not represent.
#pragma once

#include <string>
#include <vector>

#include "sim/simulation.hpp"

namespace thawslide::sim {

// Warning about columns that the limit of slopes has lowered. Empty on level cells.
template <int Dim>
[[nodiscard]] std::vector<std::string> warnings_of_unresolved_terrain(const Simulation<Dim>& simulation);

}  // namespace thawslide::sim
