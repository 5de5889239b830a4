#include "band/averages.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
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

template <int Dim, class Real>
std::uint64_t FlowDepth<Dim, Real>::column_key(const mpm::SparseGrid<Dim, Real>& grid,
                                               const mpm::Particles<Dim, Real>& particles, std::uint32_t p) {
  std::uint64_t key = 0;
  for (int a = 0; a < Dim - 1; ++a) {
    const auto cell = static_cast<std::int64_t>(std::floor(particles.position(p, a) * grid.inverse_cell()));
    key = (key << 32) | static_cast<std::uint32_t>(cell);
  }
  return key;
}

template <int Dim, class Real>
void FlowDepth<Dim, Real>::update(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                                  const std::function<Real(Real)>& slope_cosine,
                                  const mpm::Particles<Dim, Real>& particles) {
  // Serial, in canonical order, so that sums do not depend on threads.
  index_.clear();
  columns_.clear();
  for (const std::uint32_t p : grid.order()) {
    const auto number = static_cast<std::size_t>(index_.insert(column_key(grid, particles, p)));
    const Real half = model.half_size[static_cast<std::size_t>(particles.body(p))] * grid.cell();
    const Real top = particles.position(p, Dim - 1) + half;
    if (number == columns_.size()) {
      const Real middle = (std::floor(particles.position(p, 0) * grid.inverse_cell()) + Real(0.5)) * grid.cell();
      columns_.push_back({Real(0), top, model.normal_thickness && slope_cosine ? slope_cosine(middle) : Real(1)});
    }
    columns_[number].volume += particles.volume(p);
    columns_[number].top = std::max(columns_[number].top, top);
  }
}

template <int Dim, class Real>
void FlowDepth<Dim, Real>::depth_to_particles(const mpm::SparseGrid<Dim, Real>& grid,
                                              mpm::Particles<Dim, Real>& particles) const {
  const Real footprint = Dim == 2 ? grid.cell() : grid.cell() * grid.cell();
  for (const std::uint32_t p : grid.order()) {
    const Column& column = columns_[static_cast<std::size_t>(index_.find(column_key(grid, particles, p)))];
    const Real depth = particles.in_band(p) != 0 ? column.volume / footprint
                                                 : std::max(Real(0), column.top - particles.position(p, Dim - 1));
    particles.flow_depth(p) = depth * column.cosine;
  }
}

template <int Dim, class Real>
Real FlowDepth<Dim, Real>::depth_below_top(const mpm::SparseGrid<Dim, Real>& grid,
                                           const mpm::Particles<Dim, Real>& particles, std::uint32_t p) const {
  const std::int32_t number = index_.find(column_key(grid, particles, p));
  THAWSLIDE_ASSERT(number >= 0, "particle {} is in no column", particles.id(p));
  return columns_[static_cast<std::size_t>(number)].top - particles.position(p, Dim - 1);
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                        \
  template void average_on_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const mpm::Particles<Dim, Real>&, \
                                           const BandModel<Dim, Real>&, mpm::Nodes<Dim, Real>&);                \
  template class FlowDepth<Dim, Real>;
THAWSLIDE_INSTANTIATE(2, double)
THAWSLIDE_INSTANTIATE(3, double)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
