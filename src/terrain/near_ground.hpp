// What the particles near the ground tell the nodes that may touch it: the averages that the basal law takes, and how
// far the slide still is from the ground by its particles' own edges. GIMP lets nodes feel the slide up to a cell
// before it arrives, and without a check of that distance contact acts from then on.
#pragma once

#include "mpm/motion.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

// Sets particles.contact_offset [m]: the distance from the planes of nodes at which a particle touches the ground. A
// body that stands on the ground at the start touches with its lowest particles as they stand, which on a slope across
// the grid are not all equally far from it; the others touch with the edge of their box, as the ground lies below them
// at the start. Only of the particles that stand in memory from `first` on.
template <int Dim, class Real>
void set_contact_offset(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                        const mpm::MotionModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles,
                        std::size_t first = 0);

// Fills nodes.near_ground of candidate nodes (others of their blocks hold nothing meaningful): the sums, and the
// clearance [m], the smallest gap between the node's plane and the particles that it sees (mpm/records.hpp), 0 or less
// where they touch. Measured to any ground, particles on a floor would close the gap of nodes that face a wall.
template <int Dim, class Real>
void near_ground_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                         const mpm::MotionModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles,
                         mpm::Nodes<Dim, Real>& nodes);

// Fills the clearance alone; the sums in nodes.near_ground are then undefined.
template <int Dim, class Real>
void clearance_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                       const mpm::MotionModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles,
                       mpm::Nodes<Dim, Real>& nodes);

}  // namespace thawslide::terrain
