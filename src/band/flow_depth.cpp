#include "band/flow_depth.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"

namespace thawslide::band {

// Numbers every column that particles of the tiles may overlap. Valid until the tiles change.
template <int Dim>
void FlowDepth<Dim>::number_columns(const mpm::SparseGrid<Dim>& grid, const mpm::SectionWidth& width,
                                    const SlopeCosine& slope_cosine) {
  column_index_.clear();
  column_keys_.clear();
  numbered_.clear();
  tiles_.resize(grid.tiles().size());
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    numbered_.push_back(grid.tiles()[t].key);
    for (std::size_t index = 0; index < indices; ++index) {
      const std::uint64_t key = column_key<Dim>(grid.tiles()[t].key, index);
      tiles_[t].number[index] = column_index_.insert(key);
      if (column_index_.size() > column_keys_.size()) {
        column_keys_.push_back(key);
      }
    }
  }
  columns_.assign(column_keys_.size(), {});
  cosines_.forget_if_many(columns_.size());
  normal_gravities_.forget_if_many(columns_.size());
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    for (std::size_t side = 0; side < column_sides<Dim>; ++side) {
      columns_[c].adjacent[side] = column_index_.find(neighbour_column(column_keys_[c], side));
    }
    columns_[c].width = width.at(middle_of_column<Dim>(column_keys_[c], grid.cell())[0]);
    if (slope_cosine) {
      columns_[c].cosine = cosines_.at(column_keys_[c], grid.cell(), slope_cosine);
    }
  }
}

// Sums in the order of particles, to be independent of the batches.
template <int Dim>
void FlowDepth<Dim>::add_tile(const mpm::SparseGrid<Dim>& grid, const mpm::Particles<Dim>& particles, std::size_t t) {
  constexpr std::size_t corners = static_cast<std::size_t>(1) << (Dim - 1);
  TilePart& part = tiles_[t];
  part.column_mass.fill({});
  const auto first_cell = first_cell_of<Dim>(grid.tiles()[t].key);
  for (const mpm::TileBatch<Dim>& batch : grid.batches(t)) {
    const Simd<double> top =
        grid.mapping().template coordinate<Dim>(particles, batch, Dim - 1) + sizes_.of(particles, batch).half;
    const Simd<double> volume = particles.volume.load(batch);
    const auto along = overlaps<Dim>(first_cell, grid.cell(), grid.inverse_cell(), sizes_.view(), particles, batch);
    std::array<std::array<std::int32_t, mpm::SimdBatch::most>, corners> columns;
    std::array<Simd<double>, corners> volumes;
    std::size_t seen = 0;
    for_columns<Dim>(along,
                     [&](const auto& /*side*/, Simd<double> index, Simd<double> fraction) THAWSLIDE_INLINE_LAMBDA {
                       if (any(fraction > 0.0)) {
                         index.store_whole(columns[seen].data());
                         volumes[seen++] = fraction * volume;
                       }
                     });
    for (std::size_t lane = 0; lane < batch.count; ++lane) {
      for (std::size_t k = 0; k < seen; ++k) {
        if (volumes[k][lane] > 0.0) {
          part.column_mass[static_cast<std::size_t>(columns[k][lane])] += {volumes[k][lane], top[lane]};
        }
      }
    }
  }
}

template <int Dim>
void FlowDepth<Dim>::add_extents(const mpm::SparseGrid<Dim>& grid, const mpm::Particles<Dim>& particles,
                                 std::size_t t) {
  TilePart& part = tiles_[t];
  part.extent.fill({});
  const auto first_cell = first_cell_of<Dim>(grid.tiles()[t].key);
  for (const mpm::TileBatch<Dim>& batch : grid.batches(t)) {
    const auto along = overlaps<Dim>(first_cell, grid.cell(), grid.inverse_cell(), sizes_.view(), particles, batch);
    for_columns<Dim>(along, [&](const auto& side, Simd<double> index, Simd<double> fraction) {
      for (std::size_t lane = 0; lane < batch.count; ++lane) {
        if (fraction[lane] > 0.0) {
          part.extent[static_cast<std::size_t>(index[lane])] += extent_in_column<Dim>(along, side, lane);
        }
      }
    });
  }
}

// Sums in the order of tiles, to be independent of threads.
template <int Dim>
void FlowDepth<Dim>::sum_columns() {
  for (Column& column : columns_) {
    column.column_mass = {};
  }
  for (const TilePart& tile : tiles_) {
    for (std::size_t index = 0; index < indices; ++index) {
      columns_[static_cast<std::size_t>(tile.number[index])].column_mass += tile.column_mass[index];
    }
  }
}

// Finds the columns that lack a neighbour, and the tiles in reach of one of them.
template <int Dim>
void FlowDepth<Dim>::find_edge() {
  for (Column& column : columns_) {
    column.extent = {};
    column.at_edge = column.column_mass.is_present() &&
                     lacks_neighbour<Dim>([&](std::size_t side) { return is_filled(column.adjacent[side]); });
  }
  edge_tiles_.clear();
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    const auto& numbers = tiles_[t].number;
    if (std::any_of(numbers.begin(), numbers.end(),
                    [&](std::int32_t c) { return columns_[static_cast<std::size_t>(c)].at_edge; })) {
      edge_tiles_.push_back(t);
    }
  }
}

template <int Dim>
void FlowDepth<Dim>::set_footprints(double cell) {
  for (const std::size_t t : edge_tiles_) {
    for (std::size_t index = 0; index < indices; ++index) {
      columns_[static_cast<std::size_t>(tiles_[t].number[index])].extent += tiles_[t].extent[index];
    }
  }
  for (Column& column : columns_) {
    column.footprint = column.width * footprint_of<Dim>(cell, column.at_edge, column.extent, [&](std::size_t side) {
                         return is_filled(column.adjacent[side]);
                       });
  }
}

template <int Dim>
void FlowDepth<Dim>::update(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model,
                            const SlopeCosine& slope_cosine, const mpm::Particles<Dim>& particles) {
  const bool same_tiles = std::equal(numbered_.begin(), numbered_.end(), grid.tiles().begin(), grid.tiles().end(),
                                     [](std::uint64_t key, const auto& tile) { return key == tile.key; });
  if (!same_tiles) {
    sizes_ = model.sizes.times(grid.cell());
    number_columns(grid, model.width, model.normal_thickness ? slope_cosine : SlopeCosine());
  }
  parallel_for(tiles_.size(), [&](std::size_t t) { add_tile(grid, particles, t); });
  sum_columns();
  find_edge();
  parallel_for(edge_tiles_.size(), [&](std::size_t k) { add_extents(grid, particles, edge_tiles_[k]); });
  set_footprints(grid.cell());
}

template <int Dim>
ColumnsOfTile<Dim> FlowDepth<Dim>::of_tile(const mpm::SparseGrid<Dim>& grid, std::size_t t) const {
  OfTile columns;
  columns.first_cell = first_cell_of<Dim>(grid.tiles()[t].key);
  columns.cell = grid.cell();
  columns.inverse_cell = grid.inverse_cell();
  columns.sizes = sizes_.view();
  columns.has_ground = grid.mapping().has_ground;
  for (std::size_t index = 0; index < indices; ++index) {
    const Column& here = columns_[static_cast<std::size_t>(tiles_[t].number[index])];
    columns.thickness.numbers[index] = thickness_of(here.column_mass, here.footprint);
    columns.top.numbers[index] = here.column_mass.top;
    columns.cosine.numbers[index] = here.cosine;
  }
  return columns;
}

template <int Dim>
void FlowDepth<Dim>::depth_to_particles(const mpm::SparseGrid<Dim>& grid, mpm::Particles<Dim>& particles) const {
  parallel_for(tiles_.size(), [&](std::size_t t) {
    const OfTile columns = of_tile(grid, t);
    for (const mpm::TileBatch<Dim>& batch : grid.batches(t)) {
      particles.flow_depth.store(batch, columns.flow_depth(particles, batch));
    }
  });
}

// Sums in the order of particles and tiles, like the volumes.
template <int Dim>
void FlowDepth<Dim>::sum_masses(const mpm::SparseGrid<Dim>& grid, const mpm::Particles<Dim>& particles) {
  constexpr std::size_t corners = static_cast<std::size_t>(1) << (Dim - 1);
  tile_masses_.resize(tiles_.size());
  parallel_for(tiles_.size(), [&](std::size_t t) {
    auto& masses = tile_masses_[t];
    masses.fill(0.0);
    const auto first_cell = first_cell_of<Dim>(grid.tiles()[t].key);
    for (const mpm::TileBatch<Dim>& batch : grid.batches(t)) {
      const auto along = overlaps<Dim>(first_cell, grid.cell(), grid.inverse_cell(), sizes_.view(), particles, batch);
      std::array<Simd<double>, corners> columns, fractions;
      std::size_t corner = 0;
      for_columns<Dim>(along, [&](const auto& /*side*/, Simd<double> index, Simd<double> fraction) {
        columns[corner] = index;
        fractions[corner++] = fraction;
      });
      for (std::size_t lane = 0; lane < batch.count; ++lane) {
        for (std::size_t k = 0; k < corners; ++k) {
          if (fractions[k][lane] > 0.0) {
            masses[static_cast<std::size_t>(columns[k][lane])] +=
                fractions[k][lane] * particles.mass(batch.particle[lane]);
          }
        }
      }
    }
  });
  masses_.assign(columns_.size(), 0.0);
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    for (std::size_t index = 0; index < indices; ++index) {
      masses_[static_cast<std::size_t>(tiles_[t].number[index])] += tile_masses_[t][index];
    }
  }
}

template <int Dim>
void FlowDepth<Dim>::load_to_particles(const mpm::SparseGrid<Dim>& grid, const NormalGravity& normal_gravity,
                                       mpm::Particles<Dim>& particles, std::size_t first) {
  sum_masses(grid, particles);
  load_per_depth_.assign(columns_.size(), 0.0);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (columns_[c].column_mass.is_present()) {
      load_per_depth_[c] = load_per_depth(columns_[c].column_mass, masses_[c],
                                          normal_gravities_.at(column_keys_[c], grid.cell(), normal_gravity));
    }
  }
  parallel_for(tiles_.size(), [&](std::size_t t) {
    OfTile columns = of_tile(grid, t);
    for (std::size_t index = 0; index < indices; ++index) {
      columns.cosine.numbers[index] = load_per_depth_[static_cast<std::size_t>(tiles_[t].number[index])];
    }
    for (const mpm::TileBatch<Dim>& batch : grid.batches(t)) {
      const Simd<double> load = columns.flow_depth(particles, batch);
      for (std::size_t lane = 0; lane < batch.count; ++lane) {
        const std::uint32_t p = batch.particle[lane];
        if (p >= first) {
          update_load(particles, p, load[lane]);
        }
      }
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim) template class FlowDepth<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
