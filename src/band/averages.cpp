#include "band/averages.hpp"

#include "mpm/motion.hpp"

namespace thawslide::band {

using mpm::HatLayout;

template <int Dim, class Real>
void average_on_grid(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                     const BandModel<Dim, Real>& model, mpm::Nodes<Dim, Real>& nodes) {
  auto& patches = nodes.hats.patches(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    auto& patch = patches[t];
    patch.clear();
    const auto& tile = grid.tiles()[t];
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      const Real volume = particles.volume(p);
      const Real temperature = particles.temperature(p);
      const Real pore_pressure = particles.pore_pressure(p);
      const Real saturation = particles.liquid_saturation(p);
      const Real solid_fraction = mpm::basal_solid_fraction(particles, model.phases, model.lubrication, p);
      const auto stencil = mpm::hat_stencil(grid, tile.key, particles, p);
      stencil.for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& /*gradient*/) {
        auto& node = patch.records[place];
        const Real v = weight * volume;
        node[HatLayout::volume] += v;
        node[HatLayout::temperature] += v * temperature;
        node[HatLayout::pore_pressure] += v * pore_pressure;
        node[HatLayout::saturation] += v * saturation;
        node[HatLayout::solid_fraction] += v * solid_fraction;
      });
    }
  });
  sum_patches(grid, nodes.hats);
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                        \
  template void average_on_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const mpm::Particles<Dim, Real>&, \
                                           const BandModel<Dim, Real>&, mpm::Nodes<Dim, Real>&);
THAWSLIDE_INSTANTIATE(2, double)
THAWSLIDE_INSTANTIATE(3, double)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
