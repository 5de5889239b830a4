// The velocities that moved particles map back to the nodes (MUSL), with the constraints on them.
#pragma once

#include "terrain/contact.hpp"

namespace thawslide::terrain {

// Sums the momenta that particles mapped back (MUSL) and makes them velocities: constraints again, and at contact nodes
// the inward normal component is removed but for what closes the clearance (no friction, no heat). Returns sum
// f_int.(v_mid - v_mapped) dt [J]: the work that internal forces did on the nodes, less the stress work that the
// mapped-back velocities will book.
template <int Dim, class Real>
Real constrain_mapped_back(const mpm::SparseGrid<Dim, Real>& grid, const GroundOnGrid<Dim, Real>* ground,
                           const mpm::Constraints<Dim, Real>& constraints, const ContactModel<Dim, Real>& model,
                           const Vector<Real, Dim>& gravity, Real time, Real dt, mpm::Nodes<Dim, Real>& nodes);

}  // namespace thawslide::terrain
