#include "band/flow_depth.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace thawslide::band {

// Column numbers count from here, so that a step to a neighbour never carries from one axis into the next.
constexpr std::int64_t column_origin = std::int64_t{1} << 31;

template <int Dim, class Real>
int FlowDepth<Dim, Real>::local_cell(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t, std::size_t axis,
                                     Real place) {
  const int first = mpm::Tile<Dim>::index(grid.tiles()[t].key)[axis] * mpm::Tile<Dim>::edge - 1;
  const int local = static_cast<int>(std::floor(place * grid.inverse_cell())) - first;
  THAWSLIDE_ASSERT(local >= 0 && local < columns_per_axis, "place {} m lies in cell {} of its tile", place, local);
  return local;
}

template <int Dim, class Real>
template <class Visit>
void FlowDepth<Dim, Real>::for_columns(const mpm::SparseGrid<Dim, Real>& grid,
                                       const mpm::Particles<Dim, Real>& particles, std::size_t t, std::uint32_t p,
                                       const Visit& visit) const {
  constexpr Real sliver = static_cast<Real>(1e-9);  // of the box: less of a column is round-off
  constexpr std::size_t axes = Dim - 1;
  const auto tile = mpm::Tile<Dim>::index(grid.tiles()[t].key);
  const Real half = half_size_[static_cast<std::size_t>(particles.body(p))];
  std::array<int, axes> lowest{}, highest{};
  std::array<Real, axes> lower{}, upper{};
  for (std::size_t a = 0; a < axes; ++a) {
    const Real middle = particles.position(p, static_cast<int>(a));
    lower[a] = middle - half;
    upper[a] = middle + half;
    lowest[a] = local_cell(grid, t, a, lower[a] + sliver * half);
    highest[a] = local_cell(grid, t, a, upper[a] - sliver * half);
  }
  std::array<int, axes> cell = lowest;
  while (true) {
    Real share = 1;
    std::array<Real, axes> from{}, to{};
    std::size_t place = 0;
    for (std::size_t a = axes; a-- > 0;) {
      const auto begin = static_cast<Real>(tile[a] * mpm::Tile<Dim>::edge - 1 + cell[a]) * grid.cell();
      from[a] = std::max(lower[a], begin);
      to[a] = std::min(upper[a], begin + grid.cell());
      share *= (to[a] - from[a]) / (Real(2) * half);
      place = place * static_cast<std::size_t>(columns_per_axis) + static_cast<std::size_t>(cell[a]);
    }
    visit(place, share, from, to);
    std::size_t a = 0;
    while (a < axes && cell[a] == highest[a]) {
      cell[a] = lowest[a];
      ++a;
    }
    if (a == axes) {
      return;
    }
    ++cell[a];
  }
}

template <int Dim, class Real>
std::uint64_t FlowDepth<Dim, Real>::column_key(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t,
                                               std::size_t place) {
  const auto tile = mpm::Tile<Dim>::index(grid.tiles()[t].key);
  std::uint64_t key = 0;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    const int local = static_cast<int>(place % static_cast<std::size_t>(columns_per_axis));
    place /= static_cast<std::size_t>(columns_per_axis);
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
void FlowDepth<Dim, Real>::Column::add(const Column& part) {
  if (!(volume > Real(0))) {
    *this = part;
    return;
  }
  volume += part.volume;
  top = std::max(top, part.top);
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    from[a] = std::min(from[a], part.from[a]);
    to[a] = std::max(to[a], part.to[a]);
  }
}

template <int Dim, class Real>
void FlowDepth<Dim, Real>::set_footprints(Real cell) {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    Column& column = columns_[c];
    column.footprint = Real(1);
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      const bool inside = index_.find(neighbour(keys_[c], a, -1)) != KeyIndex::absent &&
                          index_.find(neighbour(keys_[c], a, 1)) != KeyIndex::absent;
      column.footprint *= inside ? cell : std::min(cell, column.to[a] - column.from[a]);
    }
  }
}

// The tiles' parts add up in the order of tiles, so that sums do not depend on threads.
template <int Dim, class Real>
void FlowDepth<Dim, Real>::number_columns(const mpm::SparseGrid<Dim, Real>& grid) {
  index_.clear();
  keys_.clear();
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
        columns_.emplace_back();
        keys_.push_back(key);
      }
      columns_[number].add(part);
    }
  }
}

template <int Dim, class Real>
void FlowDepth<Dim, Real>::update(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                                  const std::function<Real(Real)>& slope_cosine,
                                  const mpm::Particles<Dim, Real>& particles) {
  half_size_ = model.half_size;
  for (Real& half : half_size_) {
    half *= grid.cell();
  }
  tiles_.resize(grid.tiles().size());
  parallel_for(tiles_.size(), [&](std::size_t t) {
    tiles_[t].part.fill({});
    const auto& tile = grid.tiles()[t];
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      Column own;
      own.top = particles.position(p, Dim - 1) + half_size_[static_cast<std::size_t>(particles.body(p))];
      for_columns(grid, particles, t, p, [&](std::size_t place, Real share, const auto& from, const auto& to) {
        own.volume = share * particles.volume(p);
        own.from = from;
        own.to = to;
        tiles_[t].part[place].add(own);
      });
    }
  });
  number_columns(grid);
  set_footprints(grid.cell());
  if (model.normal_thickness && slope_cosine) {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const auto cell = static_cast<Real>(static_cast<std::int64_t>(keys_[c] & 0xffffffffu) - column_origin);
      columns_[c].cosine = slope_cosine((cell + Real(0.5)) * grid.cell());
    }
  }
}

template <int Dim, class Real>
Real FlowDepth<Dim, Real>::depth_below_top(const mpm::SparseGrid<Dim, Real>& grid,
                                           const mpm::Particles<Dim, Real>& particles, std::size_t t,
                                           std::uint32_t p) const {
  std::size_t place = 0;
  for (std::size_t a = Dim - 1; a-- > 0;) {
    place = place * static_cast<std::size_t>(columns_per_axis) +
            static_cast<std::size_t>(local_cell(grid, t, a, particles.position(p, static_cast<int>(a))));
  }
  return column(t, place).top - particles.position(p, Dim - 1);
}

template <int Dim, class Real>
void FlowDepth<Dim, Real>::depth_to_particles(const mpm::SparseGrid<Dim, Real>& grid,
                                              mpm::Particles<Dim, Real>& particles) const {
  parallel_for(tiles_.size(), [&](std::size_t t) {
    const auto& tile = grid.tiles()[t];
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      Real depth = 0;
      for_columns(grid, particles, t, p, [&](std::size_t place, Real share, const auto& /*from*/, const auto& /*to*/) {
        const Column& here = column(t, place);
        const Real thickness = particles.in_band(p) != 0 ? here.volume / here.footprint
                                                         : std::max(Real(0), here.top - particles.position(p, Dim - 1));
        depth += share * thickness * here.cosine;
      });
      particles.flow_depth(p) = depth;
    }
  });
}

template class FlowDepth<2, double>;
template class FlowDepth<3, double>;

}  // namespace thawslide::band
