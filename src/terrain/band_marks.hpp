// Marks of particles in the shear band, and their slip.
#pragma once

#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

// Marks particles in a cell with a candidate corner as band particles, and adds the slip of contact nodes to particles.
template <int Dim>
void mark_band_and_slip(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground, double dt,
                        mpm::Nodes<Dim>& nodes, mpm::Particles<Dim>& particles);

}  // namespace thawslide::terrain
