#include "band/averages.hpp"

#include "base/instances.hpp"
#include "mpm/batch_transfer.hpp"
#include "mpm/motion.hpp"

namespace thawslide::band {

using mpm::HatLayout;

template <int Dim, class Real>
void average_on_grid(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                     const BandModel<Dim, Real>& model, mpm::Nodes<Dim, Real>& nodes) {
  const auto patches = nodes.hats.patches(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    auto& patch = patches[t];
    patch.clear();
    const auto& tile = grid.tiles()[t];
    mpm::for_each_batch<Real>(grid.order(), tile.first, tile.last, [&](const mpm::Batch<Real>& batch) {
      const Lanes<Real> volume = particles.volume.load(batch);
      mpm::Contribution<Dim, Real, HatLayout::size> carried;
      carried.value[HatLayout::volume] = volume;
      carried.value[HatLayout::temperature] = volume * particles.temperature.load(batch);
      carried.value[HatLayout::pore_pressure] = volume * particles.pore_pressure.load(batch);
      carried.value[HatLayout::saturation] = volume * particles.liquid_saturation.load(batch);
      carried.value[HatLayout::solid_fraction] =
          volume * mpm::basal_solid_fraction(particles, model.phases, model.lubrication, batch);
      add_to_nodes<false>(hat_stencil(grid, tile.key, particles, batch), batch.count, carried, patch);
    });
  });
  sum_patches(grid, nodes.hats);
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                        \
  template void average_on_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const mpm::Particles<Dim, Real>&, \
                                           const BandModel<Dim, Real>&, mpm::Nodes<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
