// Averages of band quantities at nodes.
#pragma once

#include "band/model.hpp"
#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// Temperature, pore pressure (Eq. 21 with normalised weights), saturation and solid fraction to the nodes, by volume
// with the linear hats.
template <int Dim, class Real>
void average_on_grid(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                     const BandModel<Dim, Real>& model, mpm::Nodes<Dim, Real>& nodes);

}  // namespace thawslide::band
