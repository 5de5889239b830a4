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

#include "mpm/filter_kernels.hpp"
#include "mpm/filter_node.hpp"

namespace thawslide::mpm::stages {

// Next increment of the rigid motion of each node. Nodes: access to their records by name.
template <class Nodes, int Dim>
struct MakeIncrements {
  using Totals = NoTotals;

  Nodes nodes;
  bool first;
  double least_square;

  template <class Node>
  THAWSLIDE_HD void operator()(const Node& node, Totals& /*totals*/) const {
    double *increment = nodes.template write<FilterIncrement>(node), *total = nodes.template write<FilterTotal>(node);
    make_increment<Dim>(first, least_square, nodes.template read<Momentum>(node),
                        nodes.template read<FilterMoments>(node), nodes.template read<FilterMomentum>(node), increment,
                        total);
  }
};

// Applies the filter of an order, at least 1, after move_particles (mpm/motion_stages.hpp). The patches of Velocity
// then contain the momenta of the filtered velocities. Requires nodal masses. gained: kinetic energy gained by
// particles [J], at most 0.
template <int Dim, class Passes>
void filter_velocities(Passes& passes, int order, double* gained) {
  passes.template resize_records<FilterMoments, FilterMomentum, FilterIncrement, FilterTotal>();
  const auto make_increments = [&](bool first) {
    using Nodes = decltype(passes.node_access());
    passes.template solve<FilterMomentum>(
        nullptr, MakeIncrements<Nodes, Dim>{passes.node_access(), first, least_square_of(passes.cell())});
  };
  passes.run(passes.momentum(), AddFilterMoments<Dim>{});
  passes.template sum_all<FilterMoments>();
  passes.run(passes.momentum(), AddFilterMomentum<Dim>{});
  make_increments(true);
  for (int done = 1; done < order; ++done) {
    passes.run(passes.momentum(), SweepFilter<Dim>{});
    make_increments(false);
  }
  passes.total(passes.momentum(), ApplyFiltered<Dim>{}, gained);
}

}  // namespace thawslide::mpm::stages
