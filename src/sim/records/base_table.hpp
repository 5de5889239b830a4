// Table of the basal segments for snapshots: one row per segment at one time.
#pragma once

#include "base/state_numbers.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

// Columns by name with unit; `position_m` holds x, y, z of each segment (z = 0 in 2D). The table is empty unless the
// band consists of columns. P, T and S are means over the band; `max_temperature_C` is the maximum of the column's
// cells above the ground.
template <int Dim>
NamedNumbers base_table(const Simulation<Dim>& simulation);

}  // namespace thawslide::sim
