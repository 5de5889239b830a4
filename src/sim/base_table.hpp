// The base of a slide at one time, a row for each piece that carries a band column: for snapshots.
#pragma once

#include "base/named_numbers.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

// Columns by name, each with its unit; `position_m` has x, y, z of each piece (z = 0 in 2D). Empty where the band is
// not of columns. P, T and S are means over the band; `hottest_C` is of the column's hottest cell above the ground.
template <int Dim, class Real>
NamedNumbers base_table(const Simulation<Dim, Real>& simulation);

}  // namespace thawslide::sim
