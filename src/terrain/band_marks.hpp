// Marks of particles in the shear band, and their slip.
#pragma once

#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

// Marks particles in a cell with a candidate corner as band particles, and adds the slip of contact nodes to particles.
template <int Dim, class Real>
void mark_band_and_slip(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground, Real dt,
                        mpm::Nodes<Dim, Real>& nodes, mpm::Particles<Dim, Real>& particles);

}  // namespace thawslide::terrain
