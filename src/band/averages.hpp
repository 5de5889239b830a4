// Averages of band quantities at nodes.
#pragma once

#include "band/heat.hpp"
#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// Temperature and pore pressure (Eq. 21 with normalised weights) to the nodes, by volume with the linear shape
// functions: their sums, and in heat_nodes.state the averages.
template <int Dim, class Real>
void average_on_grid(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                     const BandModel<Dim, Real>& model, mpm::Nodes<Dim, Real>& nodes, HeatNodes<Dim, Real>& heat_nodes);

}  // namespace thawslide::band
