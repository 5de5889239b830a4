#include "band/averages.hpp"

#include "band/averages_kernel.hpp"
#include "band/heat_nodes.hpp"
#include "base/instances.hpp"
#include "mpm/particle_pass.hpp"

namespace thawslide::band {

template <int Dim, class Real>
void average_on_grid(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                     mpm::Particles<Dim, Real>& particles, mpm::Nodes<Dim, Real>& nodes) {
  mpm::particle_pass(grid, mpm::LinearWeights{}, particles, nodes, mpm::every_tile, AddAverages<Dim, Real>{});
  nodes.averages.resize(grid.blocks().size());
  nodes.state.resize(grid.blocks().size());
  const SetNodalState<Dim, Real> set_state{grid, model};
  mpm::node_pass<mpm::NoAccount>(
      grid, [&](std::size_t b) { mpm::sum_block<mpm::Averages>(grid, b, nodes); },
      [&](const mpm::NodeAt& at, mpm::NoAccount& /*account*/) { set_state(nodes, at); });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                   \
  template void average_on_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const BandModel<Dim, Real>&, \
                                           mpm::Particles<Dim, Real>&, mpm::Nodes<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
