#include "band/averages.hpp"

#include "band/averages_kernel.hpp"
#include "band/heat_nodes.hpp"
#include "band/nodal_seepage.hpp"
#include "band/seeping_tiles.hpp"
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
      grid, [&](std::size_t b) { return mpm::sum_block<mpm::Averages>(grid, b, nodes); },
      [&](const mpm::NodeAt& at, mpm::NoAccount& /*account*/) { set_state(nodes, at); });
}

template <int Dim, class Real>
void average_seeping_water(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                           mpm::Particles<Dim, Real>& particles, mpm::Nodes<Dim, Real>& nodes) {
  if (!model.lets_water_seep() || model.frozen_rows == FrozenRows::draining) {
    return;
  }
  const auto hydraulic = model.hydraulic();
  const bool any_seeps = find_seepage<Dim, Real>(grid, nodes.marks, [&](const mpm::SimdBatch<Real>& batch) {
    return any(seeps(model, hydraulic, particles, batch));
  });
  if (!any_seeps) {
    return;
  }
  const auto& blocks = nodes.marks.seeping_blocks;
  mpm::particle_pass(
      grid, mpm::LinearWeights{}, particles, nodes, [&](std::size_t t) { return grid.any_about_tile(t, blocks); },
      AddSeepingWater<Dim, Real>{model, hydraulic});
  nodes.seeping_water.hold(grid.blocks().size(), [&](std::size_t b) { return blocks[b] != 0; });
  mpm::node_pass<mpm::NoAccount>(
      grid, [&](std::size_t b) { return blocks[b] != 0 ? mpm::sum_block<mpm::SeepingWater>(grid, b, nodes) : 0; },
      [&](const mpm::NodeAt& at, mpm::NoAccount& /*account*/) {
        nodes.state(at)[mpm::NodalState::pore_pressure] = seeping_pressure<Real>(nodes.seeping_water(at));
      });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                         \
  template void average_on_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const BandModel<Dim, Real>&,       \
                                           mpm::Particles<Dim, Real>&, mpm::Nodes<Dim, Real>&);                  \
  template void average_seeping_water<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const BandModel<Dim, Real>&, \
                                                 mpm::Particles<Dim, Real>&, mpm::Nodes<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
