// Nodal part of drain_pore_pressure and average_seeping_water, for one node. For host and device.
#pragma once

#include "base/portability.hpp"
#include "mpm/records.hpp"
#include "physics/mixture.hpp"

namespace thawslide::band {

// Pressure change of a node by seepage in a step [Pa], Eq. 22. sums: record of Seepage.
template <class Sums>
THAWSLIDE_HD double pressure_change(const Sums& sums, double dt) {
  using mpm::Seepage;
  return sums[Seepage::pore_space] > 0.0
             ? (dt * sums[Seepage::inflow] - sums[Seepage::subgrid]) / sums[Seepage::pore_space]
             : 0.0;
}

// Seepage absorbed by frozen pores at a node [Pa m3]: pressure change of the node times their pore space.
template <class Sums>
THAWSLIDE_HD double absorbed_by_frozen(const Sums& sums, double change) {
  return (sums[mpm::Seepage::pore_space] - sums[mpm::Seepage::seeping]) * change;
}
// Mass of that water [kg].
inline THAWSLIDE_HD double mass_of_absorbed(const physics::Phases& phases, double absorbed) {
  return phases.water_density / phases.water_bulk_modulus * absorbed;
}

// Pore pressure of a node with seeping water [Pa]. water: record of SeepingWater.
template <class Water>
THAWSLIDE_HD double seeping_pressure(const Water& water) {
  const double volume = water[mpm::SeepingWater::volume];
  return volume > 0.0 ? water[mpm::SeepingWater::pore_pressure] / volume : 0.0;
}

}  // namespace thawslide::band
