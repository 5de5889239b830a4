// Temperature and pore pressure at the nodes (Eq. 21).
#pragma once

#include "band/model.hpp"
#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// What the nodes see of the particles' temperature and pore pressure by the linear shape functions: nodes.averages, the
// sums, and nodes.state.
template <int Dim, class Real>
void average_on_grid(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                     mpm::Particles<Dim, Real>& particles, mpm::Nodes<Dim, Real>& nodes);

// Where frozen rows are sealed or vented: the pressure of the water that seeps takes the place of the mean over all
// matter in nodes.state, for the stages after contact, conduct_heat and drain_pore_pressure. Elsewhere it is that mean.
template <int Dim, class Real>
void average_seeping_water(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                           mpm::Particles<Dim, Real>& particles, mpm::Nodes<Dim, Real>& nodes);

}  // namespace thawslide::band
