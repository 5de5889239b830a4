// Velocity filter that removes the particle velocities that the grid does not resolve and FLIP preserves: the
// projection of XPIC(m) (Hammerquist and Nairn 2017) and FMPM(m), V <- [1 - (1 - B)^m] V, in the form of Nairn's note
// of 2026 (Sec. 1.4.3; see docs/theory/momentum.md):
//   dg_1 = T+ V,  dg_l+1 = dg_l - T+ T dg_l,  V <- T (dg_1 + ... + dg_m),  B = T T+
// In these methods, T+ is the velocity of nodes with lumped masses and T the shape functions, which loses angular
// momentum at the edges of a rotating body. Here, T+ fits to each node a rigid motion (physics/rigid_motion.hpp) of the
// surrounding velocities, weighted by S m, and T averages these motions with S at the position of a particle. Rigid
// motion therefore remains unchanged, and B is symmetric with respect to the masses with eigenvalues from 0 to 1:
// momentum and angular momentum are conserved, and kinetic energy cannot increase. Without rotation around a node, the
// filter is identical to theirs.
#pragma once

#include "mpm/motion.hpp"

namespace thawslide::mpm {

// Applies the filter with the order of the model, after move_particles. The patches of nodes.velocity then contain the
// momenta of the filtered velocities. Requires nodal masses (momentum_to_grid). Returns the kinetic energy gained by
// particles [J], at most 0.
template <int Dim>
double filter_velocities(const SparseGrid<Dim>& grid, Particles<Dim>& particles, const MotionModel<Dim>& model,
                         Nodes<Dim>& nodes);

}  // namespace thawslide::mpm
