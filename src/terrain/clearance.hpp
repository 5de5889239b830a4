// How far the slide still is from the ground, by its particles' own edges: GIMP lets nodes feel the slide up to a cell
// before it arrives, and without this check contact acts from then on.
#pragma once

#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

// Sets particles.reach [m]: the distance from the ground at which a particle touches it. A body that stands on the
// ground at the start touches with its lowest particles as they stand, which on a slope across the grid are not all
// equally far from it; the others touch with the edge of their box, as the ground lies below them at the start.
template <int Dim, class Real>
void set_reach(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
               const std::vector<Real>& half_size, mpm::Particles<Dim, Real>& particles);

// Fills nodes.clearance [m]: the smallest distance left between the ground and the particles that a node sees, 0 where
// they touch, beyond all bounds where it sees none near ground.
template <int Dim, class Real>
void clearances_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                        mpm::ShapeKind shape, const std::vector<Real>& half_size, const mpm::HeldSides<Dim>& sides,
                        const mpm::Particles<Dim, Real>& particles, mpm::Nodes<Dim, Real>& nodes);

}  // namespace thawslide::terrain
