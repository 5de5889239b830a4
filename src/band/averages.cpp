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
std::size_t FlowDepth<Dim, Real>::place_in_tile(const mpm::SparseGrid<Dim, Real>& grid,
                                                const mpm::Particles<Dim, Real>& particles, std::size_t t,
                                                std::uint32_t p) {
  const auto tile = mpm::Tile<Dim>::index(grid.tiles()[t].key);
  std::size_t place = 0;
  for (int a = Dim - 2; a >= 0; --a) {
    const auto cell = static_cast<int>(std::floor(particles.position(p, a) * grid.inverse_cell()));
    const int local = cell - tile[static_cast<std::size_t>(a)] * mpm::Tile<Dim>::edge + 1;
    THAWSLIDE_ASSERT(local >= 0 && local < columns_per_axis, "particle {} stands in cell {} of its tile",
                     particles.id(p), local);
    place = place * static_cast<std::size_t>(columns_per_axis) + static_cast<std::size_t>(local);
  }
  return place;
}

template <int Dim, class Real>
std::uint64_t FlowDepth<Dim, Real>::column_key(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t,
                                               std::size_t place) {
  const auto tile = mpm::Tile<Dim>::index(grid.tiles()[t].key);
  std::uint64_t key = 0;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    const int local = static_cast<int>(place % static_cast<std::size_t>(columns_per_axis));
    place /= static_cast<std::size_t>(columns_per_axis);
    key = (key << 32) | static_cast<std::uint32_t>(tile[a] * mpm::Tile<Dim>::edge + local - 1);
  }
  return key;
}

template <int Dim, class Real>
void FlowDepth<Dim, Real>::update(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                                  const std::function<Real(Real)>& slope_cosine,
                                  const mpm::Particles<Dim, Real>& particles) {
  tiles_.resize(grid.tiles().size());
  parallel_for(tiles_.size(), [&](std::size_t t) {
    tiles_[t].part.fill({});
    const auto& tile = grid.tiles()[t];
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      Column& part = tiles_[t].part[place_in_tile(grid, particles, t, p)];
      const Real half = model.half_size[static_cast<std::size_t>(particles.body(p))] * grid.cell();
      const Real top = particles.position(p, Dim - 1) + half;
      part.top = part.volume > Real(0) ? std::max(part.top, top) : top;
      part.volume += particles.volume(p);
    }
  });
  // The tiles' parts add up in the order of tiles, so that sums do not depend on threads.
  index_.clear();
  columns_.clear();
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    for (std::size_t place = 0; place < columns_per_tile; ++place) {
      const Column& part = tiles_[t].part[place];
      if (!(part.volume > Real(0))) {
        continue;
      }
      const std::uint64_t key = column_key(grid, t, place);
      const auto number = static_cast<std::size_t>(index_.insert(key));
      tiles_[t].number[place] = static_cast<std::int32_t>(number);
      if (number == columns_.size()) {
        const int cell = mpm::Tile<Dim>::index(grid.tiles()[t].key)[0] * mpm::Tile<Dim>::edge - 1 +
                         static_cast<int>(place % static_cast<std::size_t>(columns_per_axis));
        const Real middle = (static_cast<Real>(cell) + Real(0.5)) * grid.cell();
        columns_.push_back(
            {Real(0), part.top, model.normal_thickness && slope_cosine ? slope_cosine(middle) : Real(1)});
      }
      columns_[number].volume += part.volume;
      columns_[number].top = std::max(columns_[number].top, part.top);
    }
  }
}

template <int Dim, class Real>
void FlowDepth<Dim, Real>::depth_to_particles(const mpm::SparseGrid<Dim, Real>& grid,
                                              mpm::Particles<Dim, Real>& particles) const {
  const Real footprint = Dim == 2 ? grid.cell() : grid.cell() * grid.cell();
  parallel_for(tiles_.size(), [&](std::size_t t) {
    const auto& tile = grid.tiles()[t];
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      const Column& here = column(grid, particles, t, p);
      const Real depth = particles.in_band(p) != 0 ? here.volume / footprint
                                                   : std::max(Real(0), here.top - particles.position(p, Dim - 1));
      particles.flow_depth(p) = depth * here.cosine;
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                        \
  template void average_on_grid<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const mpm::Particles<Dim, Real>&, \
                                           const BandModel<Dim, Real>&, mpm::Nodes<Dim, Real>&);                \
  template class FlowDepth<Dim, Real>;
THAWSLIDE_INSTANTIATE(2, double)
THAWSLIDE_INSTANTIATE(3, double)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
