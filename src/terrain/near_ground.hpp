// Transfer from particles near the ground to candidate nodes: averages for the basal law, and the clearance between
// particle edges and the ground. GIMP shape functions reach nodes up to a cell ahead of the sliding mass; without a
// check of the clearance, contact acts from then on.
#pragma once

#include "mpm/motion.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

// Sets particles.contact_offset [m], the distance from nodal planes at which a particle touches the ground, for
// particles at memory index `first` and above. The lowest particles of a body that rests on the ground at the start
// touch at their initial distance, which varies on a slope across the grid. Other particles touch with the edge of
// their box, in the initial direction of the ground below them.
template <int Dim, class Real>
void set_contact_offset(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                        const mpm::MotionModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles,
                        std::size_t first = 0);

// Fills nodes.near_ground of candidate nodes (other nodes of their blocks are undefined): the sums, and the clearance
// [m], the smallest gap between the node's plane and the particles in reach (mpm/records.hpp); 0 or less at contact. A
// distance to any ground would let particles on a floor close the gap of nodes that face a wall.
template <int Dim, class Real>
void near_ground_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                         const mpm::MotionModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles,
                         mpm::Nodes<Dim, Real>& nodes);

// Fills only the clearance; the sums in nodes.near_ground are then undefined.
template <int Dim, class Real>
void clearance_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>& ground,
                       const mpm::MotionModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles,
                       mpm::Nodes<Dim, Real>& nodes);

}  // namespace thawslide::terrain
