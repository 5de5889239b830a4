// Nodal velocities from the momentum mapped back by moved particles (MUSL), with constraints.
#pragma once

#include "terrain/contact.hpp"

namespace thawslide::terrain {

// Sums the momenta that particles mapped back (MUSL), applies constraints again, and converts them to velocities. At
// contact nodes, the inward normal component is removed except for the part that closes the clearance (no friction, no
// heat). Returns sum f_int.(v_mid - v_mapped) dt [J]: the work of internal forces on the nodes, minus the stress work
// at the mapped-back velocities.
template <int Dim>
double constrain_mapped_back(const mpm::SparseGrid<Dim>& grid, const GroundOnGrid<Dim>* ground,
                             const mpm::Constraints<Dim>& constraints, const ContactModel<Dim>& model,
                             const Vector<double, Dim>& gravity, double time, double dt, mpm::Nodes<Dim>& nodes);

}  // namespace thawslide::terrain
