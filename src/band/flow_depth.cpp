#include "band/flow_depth.hpp"

#include <algorithm>
#include <array>

#include "base/instances.hpp"
#include "base/parallel.hpp"

namespace thawslide::band {

namespace {

// Contributions of a tile's particles to the columns in reach, by place. Sums in the order of particles, to be
// independent of the batches.
template <int Dim>
void add_tile(const mpm::SparseGrid<Dim>& grid, const mpm::SizesOfBodies& sizes, const mpm::Particles<Dim>& particles,
              std::size_t t, ColumnPart<Dim>* parts) {
  constexpr std::size_t corners = static_cast<std::size_t>(1) << (Dim - 1);
  std::fill_n(parts, columns_per_tile<Dim>, ColumnPart<Dim>{});
  const auto first_cell = first_cell_of<Dim>(grid.tiles()[t].key);
  for (const mpm::TileBatch<Dim>& batch : grid.batches(t)) {
    const Simd<double> top =
        grid.mapping().template coordinate<Dim>(particles, batch, Dim - 1) + sizes.of(particles, batch).half;
    const Simd<double> volume = particles.volume.load(batch), mass = particles.mass.load(batch);
    const auto along = overlaps<Dim>(first_cell, grid.cell(), grid.inverse_cell(), sizes, particles, batch);
    struct Corner {
      std::array<std::int32_t, mpm::SimdBatch::most> place;
      std::array<std::size_t, Dim - 1> side;
      Simd<double> fraction, volume, mass;
    };
    std::array<Corner, corners> reached;
    std::size_t count = 0;
    for_columns<Dim>(along, [&](const auto& side, Simd<double> index, Simd<double> fraction) THAWSLIDE_INLINE_LAMBDA {
      if (any(fraction > 0.0)) {
        Corner& corner = reached[count++];
        index.store_whole(corner.place.data());
        corner.side = side;
        corner.fraction = fraction;
        corner.volume = fraction * volume;
        corner.mass = fraction * mass;
      }
    });
    for (std::size_t lane = 0; lane < batch.count; ++lane) {
      for (std::size_t k = 0; k < count; ++k) {
        const Corner& corner = reached[k];
        if (corner.fraction[lane] > 0.0) {
          ColumnPart<Dim>& part = parts[corner.place[lane]];
          if (corner.volume[lane] > 0.0) {
            part.column_mass += {corner.volume[lane], top[lane]};
          }
          part.extent += extent_in_column<Dim>(along, corner.side, lane);
          part.mass += corner.mass[lane];
        }
      }
    }
  }
}

// Calls visit(columns of the tile, batch) for all batches.
template <int Dim, class Columns, class Visit>
void for_batches(const mpm::SparseGrid<Dim>& grid, const Columns& columns, const Visit& visit) {
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    const auto of_tile = columns.of_tile(t);
    for (const mpm::TileBatch<Dim>& batch : grid.batches(t)) {
      visit(of_tile, batch);
    }
  });
}

}  // namespace

template <int Dim>
void FlowDepth<Dim>::update(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model,
                            const OfPosition<Dim>& slope_cosine, const OfPosition<Dim>& normal_gravity,
                            const mpm::Particles<Dim>& particles) {
  if (!sums_) {
    sizes_ = model.sizes.times(grid.cell());
    OfPosition<Dim> width;
    if (model.width.varies()) {
      width = [&model](const auto& position) { return model.width.at(position[0]); };
    }
    sums_.emplace(cpu_, grid.cell(), grid.mapping().has_ground, sizes_.view(),
                  typename SlideColumns<exec::Cpu, Dim>::AtColumns{
                      model.normal_thickness ? slope_cosine : OfPosition<Dim>(), normal_gravity, std::move(width)});
  }
  const auto& tiles = grid.tiles();
  const bool same_tiles = std::equal(tile_keys_.begin(), tile_keys_.end(), tiles.begin(), tiles.end(),
                                     [](std::uint64_t key, const auto& tile) { return key == tile.key; });
  if (!same_tiles) {
    tile_keys_.resize(tiles.size());
    std::transform(tiles.begin(), tiles.end(), tile_keys_.begin(), [](const auto& tile) { return tile.key; });
    sums_->update(tile_keys_.data(), tile_keys_.size());
  }
  sums_->sum([&](ColumnPart<Dim>* parts) {
    parallel_for(tiles.size(), [&](std::size_t t) {
      add_tile(grid, sizes_.view(), particles, t, parts + t * columns_per_tile<Dim>);
    });
  });
}

template <int Dim>
void FlowDepth<Dim>::depth_to_particles(const mpm::SparseGrid<Dim>& grid, mpm::Particles<Dim>& particles) const {
  for_batches(grid, by_tile(), [&](const auto& columns, const mpm::TileBatch<Dim>& batch) {
    particles.flow_depth.store(batch, columns.flow_depth(particles, batch));
  });
}

template <int Dim>
void FlowDepth<Dim>::load_to_particles(const mpm::SparseGrid<Dim>& grid, mpm::Particles<Dim>& particles,
                                       std::size_t first) const {
  const Columns loading = sums_->template loading_by_tile<NumbersOfTile<Dim>>(tile_keys_.data());
  for_batches(grid, loading, [&](const auto& columns, const mpm::TileBatch<Dim>& batch) {
    const Simd<double> load = columns.flow_depth(particles, batch);
    for (std::size_t lane = 0; lane < batch.count; ++lane) {
      if (batch.particle[lane] >= first) {
        update_load(particles, batch.particle[lane], load[lane]);
      }
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim) template class FlowDepth<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
