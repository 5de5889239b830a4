// Transfer from particles near the ground to candidate nodes: averages for the basal law, and the clearance between
// particle edges and the ground. GIMP shape functions reach nodes up to a cell ahead of the sliding mass; without a
// check of the clearance, contact acts from then on.
#pragma once

#include "mpm/motion.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::terrain {

// Sets particles.contact_offset [m], the height at which a particle touches the ground, for particles at memory index
// `first` and above. The lowest particles of a body that rests on the ground at the start touch at their initial
// height. Other particles touch with the lower side of their box. sizes: half sizes of particles, in cells.
template <int Dim>
void set_contact_offset(const mpm::BodySizes& sizes, double cell, mpm::Particles<Dim>& particles,
                        std::size_t first = 0);

// Fills nodes.near_ground of candidate nodes (other nodes of their blocks are undefined): the sums, and the clearance
// [m] along the vertical, the smallest one of the particles in reach; 0 or less at contact.
template <int Dim>
void near_ground_to_grid(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground,
                         const mpm::MotionModel<Dim>& model, mpm::Particles<Dim>& particles, mpm::Nodes<Dim>& nodes);

// Fills only the clearance; the sums in nodes.near_ground are then undefined.
template <int Dim>
void clearance_to_grid(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>& ground,
                       const mpm::MotionModel<Dim>& model, mpm::Particles<Dim>& particles, mpm::Nodes<Dim>& nodes);

}  // namespace thawslide::terrain
