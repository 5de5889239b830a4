#include "band/averages.hpp"

#include "band/averages_kernel.hpp"
#include "band/heat_nodes.hpp"
#include "band/nodal_seepage.hpp"
#include "band/seeping_tiles.hpp"
#include "base/instances.hpp"
#include "mpm/particle_pass.hpp"

namespace thawslide::band {

template <int Dim>
void average_on_grid(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model, mpm::Particles<Dim>& particles,
                     mpm::Nodes<Dim>& nodes) {
  mpm::particle_pass(grid, mpm::LinearWeights{}, particles, nodes, mpm::every_tile, AddAverages<Dim>{});
  nodes.averages.resize(grid.blocks().size());
  nodes.state.resize(grid.blocks().size());
  const SetNodalState<Dim> set_state{grid, model};
  mpm::node_pass<mpm::NoTotals>(
      grid, [&](std::size_t b) { return mpm::sum_block<mpm::Averages>(grid, b, nodes); },
      [&](const mpm::NodeAt& at, mpm::NoTotals& /*totals*/) { set_state(nodes, at); });
}

template <int Dim>
void average_seeping_water(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model,
                           mpm::Particles<Dim>& particles, mpm::Nodes<Dim>& nodes) {
  if (!model.has_seepage() || model.frozen_rows == FrozenRows::draining) {
    return;
  }
  const auto hydraulic = model.hydraulic();
  const bool any_seeps = find_seepage<Dim>(
      grid, nodes.marks, [&](const mpm::SimdBatch& batch) { return any(seeps(model, hydraulic, particles, batch)); });
  if (!any_seeps) {
    return;
  }
  const auto& blocks = nodes.marks.seeping_blocks;
  mpm::particle_pass(
      grid, mpm::LinearWeights{}, particles, nodes, [&](std::size_t t) { return grid.any_about_tile(t, blocks); },
      AddSeepingWater<Dim>{model, hydraulic});
  nodes.seeping_water.allocate(grid.blocks().size(), [&](std::size_t b) { return blocks[b] != 0; });
  mpm::node_pass<mpm::NoTotals>(
      grid, [&](std::size_t b) { return blocks[b] != 0 ? mpm::sum_block<mpm::SeepingWater>(grid, b, nodes) : 0; },
      [&](const mpm::NodeAt& at, mpm::NoTotals& /*totals*/) {
        nodes.state(at)[mpm::NodalState::pore_pressure] = seeping_pressure(nodes.seeping_water(at));
      });
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                   \
  template void average_on_grid<Dim>(const mpm::SparseGrid<Dim>&, const BandModel<Dim>&, mpm::Particles<Dim>&,       \
                                     mpm::Nodes<Dim>&);                                                              \
  template void average_seeping_water<Dim>(const mpm::SparseGrid<Dim>&, const BandModel<Dim>&, mpm::Particles<Dim>&, \
                                           mpm::Nodes<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
