#include "band/flow_depth.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"

namespace thawslide::band {

// Column numbers count from here, so that a step to a neighbour never carries from one axis into the next.
constexpr std::int64_t column_origin = std::int64_t{1} << 31;

namespace {

template <int Dim, class Real>
std::array<int, Dim - 1> first_cells(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t) {
  std::array<int, Dim - 1> first{};
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    first[a] = mpm::Tile<Dim>::index(grid.tiles()[t].key)[a] * mpm::Tile<Dim>::edge - 1;
  }
  return first;
}

}  // namespace

template <int Dim, class Real>
std::uint64_t FlowDepth<Dim, Real>::column_key(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t,
                                               std::size_t place) {
  const auto tile = mpm::Tile<Dim>::index(grid.tiles()[t].key);
  std::uint64_t key = 0;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    const int local = static_cast<int>(place % static_cast<std::size_t>(OfTile::per_axis));
    place /= static_cast<std::size_t>(OfTile::per_axis);
    key |= static_cast<std::uint64_t>(column_origin + tile[a] * mpm::Tile<Dim>::edge + local - 1) << (32 * a);
  }
  return key;
}

template <int Dim, class Real>
std::uint64_t FlowDepth<Dim, Real>::neighbour(std::uint64_t key, std::size_t axis, int cells) {
  const std::uint64_t step = std::uint64_t{1} << (32 * axis);
  return cells > 0 ? key + step : key - step;
}

template <int Dim, class Real>
FlowDepth<Dim, Real>::Extent::Extent() {
  from.fill(std::numeric_limits<Real>::max());
  to.fill(std::numeric_limits<Real>::lowest());
}

template <int Dim, class Real>
void FlowDepth<Dim, Real>::Extent::add(const Extent& part) {
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    from[a] = std::min(from[a], part.from[a]);
    to[a] = std::max(to[a], part.to[a]);
  }
}

template <int Dim, class Real>
Real FlowDepth<Dim, Real>::AtColumns::at(std::uint64_t key, Real cell,
                                         const std::function<Real(const Vector<Real, Dim - 1>&)>& of) {
  const auto k = static_cast<std::size_t>(index.insert(key));
  if (k == values.size()) {
    Vector<Real, Dim - 1> middle;
    for (int a = 0; a + 1 < Dim; ++a) {
      const auto number = static_cast<std::int64_t>(key >> (32 * a) & 0xffffffffu) - column_origin;
      middle[a] = (static_cast<Real>(number) + Real(0.5)) * cell;
    }
    values.push_back(of(middle));
  }
  return values[k];
}

// Begun anew when the slide has left most of the columns.
template <int Dim, class Real>
void FlowDepth<Dim, Real>::AtColumns::forget_if_many(std::size_t columns) {
  constexpr std::size_t held_per_column = 4;
  if (values.size() > held_per_column * columns) {
    index.clear();
    values.clear();
  }
}

// Numbers every column that particles of the tiles might overlap; holds until there are other tiles.
template <int Dim, class Real>
void FlowDepth<Dim, Real>::number_columns(const mpm::SparseGrid<Dim, Real>& grid, const SlopeCosine& slope_cosine) {
  column_index_.clear();
  column_keys_.clear();
  numbered_.clear();
  tiles_.resize(grid.tiles().size());
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    numbered_.push_back(grid.tiles()[t].key);
    for (std::size_t place = 0; place < OfTile::count; ++place) {
      const std::uint64_t key = column_key(grid, t, place);
      tiles_[t].number[place] = column_index_.insert(key);
      if (column_index_.size() > column_keys_.size()) {
        column_keys_.push_back(key);
      }
    }
  }
  columns_.assign(column_keys_.size(), {});
  cosines_.forget_if_many(columns_.size());
  normal_gravities_.forget_if_many(columns_.size());
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      columns_[c].beside[2 * a] = column_index_.find(neighbour(column_keys_[c], a, -1));
      columns_[c].beside[2 * a + 1] = column_index_.find(neighbour(column_keys_[c], a, 1));
    }
    if (slope_cosine) {
      columns_[c].cosine = cosines_.at(column_keys_[c], grid.cell(), slope_cosine);
    }
  }
}

// Particle after particle, whatever the batches, so that sums do not depend on them.
template <int Dim, class Real>
void FlowDepth<Dim, Real>::add_tile(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                                    std::size_t t) {
  constexpr std::size_t corners = static_cast<std::size_t>(1) << (Dim - 1);
  TilePart& part = tiles_[t];
  part.volume.fill(Real(0));
  part.top.fill(std::numeric_limits<Real>::lowest());
  const auto first_cell = first_cells(grid, t);
  for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
    const Lanes<Real> top = particles.position.load(batch, Dim - 1) + sizes_.of(particles, batch).half;
    const Lanes<Real> volume = particles.volume.load(batch);
    const auto along = overlaps<Dim>(first_cell, grid.cell(), grid.inverse_cell(), sizes_.view(), particles, batch);
    std::array<std::array<std::int32_t, mpm::Batch<Real>::most>, corners> places;
    std::array<Lanes<Real>, corners> volumes;
    std::size_t seen = 0;
    for_columns<Dim>(along, [&](const auto& /*side*/, Lanes<Real> place, Lanes<Real> share) THAWSLIDE_INLINE_LAMBDA {
      if (any(share > Real(0))) {
        place.store_whole(places[seen].data());
        volumes[seen++] = share * volume;
      }
    });
    for (std::size_t lane = 0; lane < batch.count; ++lane) {
      for (std::size_t k = 0; k < seen; ++k) {
        if (volumes[k][lane] > Real(0)) {
          const auto here = static_cast<std::size_t>(places[k][lane]);
          part.volume[here] += volumes[k][lane];
          part.top[here] = std::max(part.top[here], top[lane]);
        }
      }
    }
  }
}

template <int Dim, class Real>
void FlowDepth<Dim, Real>::add_extents(const mpm::SparseGrid<Dim, Real>& grid,
                                       const mpm::Particles<Dim, Real>& particles, std::size_t t) {
  TilePart& part = tiles_[t];
  part.extent.fill({});
  const auto first_cell = first_cells(grid, t);
  for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
    const auto along = overlaps<Dim>(first_cell, grid.cell(), grid.inverse_cell(), sizes_.view(), particles, batch);
    for_columns<Dim>(along, [&](const auto& side, Lanes<Real> place, Lanes<Real> share) {
      for (std::size_t lane = 0; lane < batch.count; ++lane) {
        if (share[lane] > Real(0)) {
          Extent own;
          for (std::size_t a = 0; a + 1 < Dim; ++a) {
            own.from[a] = along[a].from[side[a]][lane];
            own.to[a] = along[a].to[side[a]][lane];
          }
          part.extent[static_cast<std::size_t>(place[lane])].add(own);
        }
      }
    });
  }
}

// The tiles' parts add up in the order of tiles, so that sums do not depend on threads.
template <int Dim, class Real>
void FlowDepth<Dim, Real>::sum_columns() {
  for (Column& column : columns_) {
    column.volume = Real(0);
    column.top = std::numeric_limits<Real>::lowest();
  }
  for (const TilePart& tile : tiles_) {
    for (std::size_t place = 0; place < OfTile::count; ++place) {
      Column& column = columns_[static_cast<std::size_t>(tile.number[place])];
      column.volume += tile.volume[place];
      column.top = std::max(column.top, tile.top[place]);
    }
  }
}

// The columns that lack a neighbour, and the tiles that see one of them.
template <int Dim, class Real>
void FlowDepth<Dim, Real>::find_edge() {
  const auto is_empty = [&](std::int32_t c) {
    return c == KeyIndex::absent || !(columns_[static_cast<std::size_t>(c)].volume > Real(0));
  };
  for (Column& column : columns_) {
    column.extent = {};
    column.at_edge = column.volume > Real(0) && std::any_of(column.beside.begin(), column.beside.end(), is_empty);
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

template <int Dim, class Real>
void FlowDepth<Dim, Real>::set_footprints(Real cell) {
  for (const std::size_t t : edge_tiles_) {
    for (std::size_t place = 0; place < OfTile::count; ++place) {
      columns_[static_cast<std::size_t>(tiles_[t].number[place])].extent.add(tiles_[t].extent[place]);
    }
  }
  const auto filled = [&](std::int32_t c) {
    return c != KeyIndex::absent && columns_[static_cast<std::size_t>(c)].volume > Real(0);
  };
  for (Column& column : columns_) {
    column.footprint = Real(1);
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      const bool inside = !column.at_edge || (filled(column.beside[2 * a]) && filled(column.beside[2 * a + 1]));
      column.footprint *= inside ? cell : std::min(cell, column.extent.to[a] - column.extent.from[a]);
    }
  }
}

template <int Dim, class Real>
void FlowDepth<Dim, Real>::update(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                                  const SlopeCosine& slope_cosine, const mpm::Particles<Dim, Real>& particles) {
  const bool same_tiles = std::equal(numbered_.begin(), numbered_.end(), grid.tiles().begin(), grid.tiles().end(),
                                     [](std::uint64_t key, const auto& tile) { return key == tile.key; });
  if (!same_tiles) {
    sizes_ = model.sizes.times(grid.cell());
    number_columns(grid, model.normal_thickness ? slope_cosine : SlopeCosine());
  }
  parallel_for(tiles_.size(), [&](std::size_t t) { add_tile(grid, particles, t); });
  sum_columns();
  find_edge();
  parallel_for(edge_tiles_.size(), [&](std::size_t k) { add_extents(grid, particles, edge_tiles_[k]); });
  set_footprints(grid.cell());
}

template <int Dim, class Real>
ColumnsOfTile<Dim, Real> FlowDepth<Dim, Real>::of_tile(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t) const {
  OfTile columns;
  columns.first_cell_ = first_cells(grid, t);
  columns.cell_ = grid.cell();
  columns.inverse_cell_ = grid.inverse_cell();
  columns.sizes_ = sizes_.view();
  for (std::size_t place = 0; place < OfTile::count; ++place) {
    const Column& here = columns_[static_cast<std::size_t>(tiles_[t].number[place])];
    columns.thickness_[place] = here.volume > Real(0) ? here.volume / here.footprint : Real(0);
    columns.top_[place] = here.top;
    columns.cosine_[place] = here.cosine;
  }
  return columns;
}

template <int Dim, class Real>
void FlowDepth<Dim, Real>::depth_to_particles(const mpm::SparseGrid<Dim, Real>& grid,
                                              mpm::Particles<Dim, Real>& particles) const {
  parallel_for(tiles_.size(), [&](std::size_t t) {
    const OfTile columns = of_tile(grid, t);
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      particles.flow_depth.store(batch, columns.flow_depth(particles, batch));
    }
  });
}

// Particle after particle and tile after tile, as volumes are summed.
template <int Dim, class Real>
void FlowDepth<Dim, Real>::sum_masses(const mpm::SparseGrid<Dim, Real>& grid,
                                      const mpm::Particles<Dim, Real>& particles) {
  constexpr std::size_t corners = static_cast<std::size_t>(1) << (Dim - 1);
  tile_masses_.resize(tiles_.size());
  parallel_for(tiles_.size(), [&](std::size_t t) {
    auto& masses = tile_masses_[t];
    masses.fill(Real(0));
    const auto first_cell = first_cells(grid, t);
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      const auto along = overlaps<Dim>(first_cell, grid.cell(), grid.inverse_cell(), sizes_.view(), particles, batch);
      std::array<Lanes<Real>, corners> places, shares;
      std::size_t corner = 0;
      for_columns<Dim>(along, [&](const auto& /*side*/, Lanes<Real> place, Lanes<Real> share) {
        places[corner] = place;
        shares[corner++] = share;
      });
      for (std::size_t lane = 0; lane < batch.count; ++lane) {
        for (std::size_t k = 0; k < corners; ++k) {
          if (shares[k][lane] > Real(0)) {
            masses[static_cast<std::size_t>(places[k][lane])] += shares[k][lane] * particles.mass(batch.particle[lane]);
          }
        }
      }
    }
  });
  masses_.assign(columns_.size(), Real(0));
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    for (std::size_t place = 0; place < OfTile::count; ++place) {
      masses_[static_cast<std::size_t>(tiles_[t].number[place])] += tile_masses_[t][place];
    }
  }
}

template <int Dim, class Real>
void FlowDepth<Dim, Real>::load_to_particles(const mpm::SparseGrid<Dim, Real>& grid,
                                             const NormalGravity& normal_gravity, mpm::Particles<Dim, Real>& particles,
                                             std::size_t first) {
  sum_masses(grid, particles);
  load_per_depth_.assign(columns_.size(), Real(0));
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (columns_[c].volume > Real(0)) {
      load_per_depth_[c] =
          masses_[c] / columns_[c].volume * normal_gravities_.at(column_keys_[c], grid.cell(), normal_gravity);
    }
  }
  parallel_for(tiles_.size(), [&](std::size_t t) {
    OfTile columns = of_tile(grid, t);
    for (std::size_t place = 0; place < OfTile::count; ++place) {
      columns.cosine_[place] = load_per_depth_[static_cast<std::size_t>(tiles_[t].number[place])];
    }
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      const Lanes<Real> load = columns.flow_depth(particles, batch);
      for (std::size_t lane = 0; lane < batch.count; ++lane) {
        const std::uint32_t p = batch.particle[lane];
        if (p >= first) {
          particles.load_change(p) = load[lane] - particles.normal_load(p);
          particles.normal_load(p) = load[lane];
        }
      }
    }
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real) template class FlowDepth<Dim, Real>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
