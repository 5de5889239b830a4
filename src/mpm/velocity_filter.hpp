// A filter that takes out of the particles' velocities what the grid cannot see and FLIP keeps for ever: the projection
// of XPIC(m) (Hammerquist and Nairn 2017) and FMPM(m), V <- [1 - (1 - B)^m] V, in the form of Nairn's note of 2026
// (Sec. 1.4.3; see docs/theory/momentum.md):
//   dg_1 = T+ V,  dg_l+1 = dg_l - T+ T dg_l,  V <- T (dg_1 + ... + dg_m),  B = T T+
// Theirs has T+ the velocities of nodes by lumped masses and T the shape functions, which loses angular momentum at the
// edges of a body that turns. Here T+ fits each node a rigid motion (physics/rigid_motion.hpp) to the velocities about
// it, weighed by S m, and T averages these motions by S at the place of a particle. So rigid motion passes as it is,
// and B stays symmetric about the masses with no eigenvalue outside 0 to 1: momentum and angular momentum are kept, and
// the kinetic energy only falls. Where nothing turns about a node it is theirs.
#pragma once

#include "mpm/motion.hpp"

namespace thawslide::mpm {

// Filters in the order of the model, after move_particles: in place of the momenta that it has mapped back, those of
// the filtered velocities are in the patches of nodes.velocity. Nodes have their mass (momentum_to_grid). Returns the
// kinetic energy that particles gained [J], which is not above 0.
template <int Dim, class Real>
Real filter_velocities(const SparseGrid<Dim, Real>& grid, Particles<Dim, Real>& particles,
                       const MotionModel<Dim, Real>& model, Nodes<Dim, Real>& nodes);

}  // namespace thawslide::mpm
