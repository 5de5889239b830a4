// Temperature and pore pressure at the nodes (Eq. 21).
#pragma once

#include "band/model.hpp"
#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// Averages temperature and pore pressure of particles to the nodes with the linear shape functions: nodes.averages
// (sums) and nodes.state.
template <int Dim>
void average_on_grid(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model, mpm::Particles<Dim>& particles,
                     mpm::Nodes<Dim>& nodes);

// With sealed or vented frozen rows: replaces the mean pore pressure over all material in nodes.state by that of the
// seeping water. The stages after contact, conduct_heat and drain_pore_pressure, use it. At nodes without seepage, the
// mean remains.
template <int Dim>
void average_seeping_water(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model,
                           mpm::Particles<Dim>& particles, mpm::Nodes<Dim>& nodes);

}  // namespace thawslide::band
