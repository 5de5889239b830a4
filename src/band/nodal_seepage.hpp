// Seepage at a node in a step. For host and device. Nodes: as in band/nodal_state.hpp.
#pragma once

#include "base/portability.hpp"
#include "mpm/records.hpp"

namespace thawslide::band {

// Pressure change by seepage (Eq. 22). Sums what frozen pores absorb: pressure change times their pore space [Pa m3].
template <class Nodes>
struct SolveSeepage {
  using Totals = double;

  Nodes nodes;
  double dt;

  template <class Node>
  THAWSLIDE_HD void operator()(const Node& node, double& absorbed) const {
    using mpm::Seepage;
    const double* sums = nodes.template read<Seepage>(node);
    const double pore_space = sums[Seepage::pore_space];
    const double change = pore_space > 0.0 ? (dt * sums[Seepage::inflow] - sums[Seepage::subgrid]) / pore_space : 0.0;
    nodes.template write<mpm::NodalState>(node)[mpm::NodalState::pressure_change] = change;
    absorbed += (pore_space - sums[Seepage::seeping]) * change;
  }
};

}  // namespace thawslide::band
