#include "band/averages.hpp"

#include "band/heat_nodes.hpp"
#include "base/instances.hpp"
#include "mpm/cell_sums.hpp"

namespace thawslide::band {

using mpm::LinearLayout;

template <int Dim, class Real>
void average_on_grid(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                     const BandModel<Dim, Real>& model, mpm::Nodes<Dim, Real>& nodes,
                     HeatNodes<Dim, Real>& heat_nodes) {
  const auto patches = nodes.linear.patches(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    auto& patch = patches[t];
    patch.clear();
    auto sums = mpm::linear_cell_sums<false, LinearLayout::size>(patch);
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      const Lanes<Real> volume = particles.volume.load(batch);
      mpm::Contribution<Dim, Real, LinearLayout::size> carried;
      carried.value[LinearLayout::volume] = volume;
      carried.value[LinearLayout::temperature] = volume * particles.temperature.load(batch);
      carried.value[LinearLayout::pore_pressure] = volume * particles.pore_pressure.load(batch);
      sums.add(linear_stencil(grid, particles, batch), batch.count, carried);
    }
  });
  heat_nodes.state.resize(grid.blocks().size());
  sum_patches(grid, nodes.linear, [&](std::size_t b) { set_node_state(grid, model, nodes, b, heat_nodes); });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                        \
  template void average_on_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const mpm::Particles<Dim, Real>&, \
                                           const BandModel<Dim, Real>&, mpm::Nodes<Dim, Real>&,                 \
                                           HeatNodes<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
