#include "band/averages.hpp"

#include "band/heat_nodes.hpp"
#include "base/instances.hpp"
#include "mpm/cell_sums.hpp"

namespace thawslide::band {

using mpm::HatLayout;

template <int Dim, class Real>
void average_on_grid(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                     const BandModel<Dim, Real>& model, mpm::Nodes<Dim, Real>& nodes,
                     HeatNodes<Dim, Real>& heat_nodes) {
  const auto patches = nodes.hats.patches(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    auto& patch = patches[t];
    patch.clear();
    auto sums = mpm::linear_cell_sums<false, HatLayout::size>(patch);
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      const Lanes<Real> volume = particles.volume.load(batch);
      mpm::Contribution<Dim, Real, HatLayout::size> carried;
      carried.value[HatLayout::volume] = volume;
      carried.value[HatLayout::temperature] = volume * particles.temperature.load(batch);
      carried.value[HatLayout::pore_pressure] = volume * particles.pore_pressure.load(batch);
      sums.add(hat_stencil(grid, particles, batch), batch.count, carried);
    }
  });
  heat_nodes.state.resize(grid.blocks().size());
  sum_patches(grid, nodes.hats, [&](std::size_t b) { set_node_state(grid, model, nodes, b, heat_nodes); });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                        \
  template void average_on_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const mpm::Particles<Dim, Real>&, \
                                           const BandModel<Dim, Real>&, mpm::Nodes<Dim, Real>&,                 \
                                           HeatNodes<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
