// Kernels that sum the columns of the sliding mass (device/columns.hpp), using the functions of band/columns.hpp.
#pragma once

#include "band/columns_of_tile.hpp"
#include "device/cell_kernels.hpp"
#include "device/tile_tables.hpp"
#include "mpm/particle_view.hpp"

namespace thawslide::device {

// Lists the columns that each tile overlaps, by tile and place. A column occurs once for each such tile.
template <int Dim>
struct ListColumns {
  const std::uint64_t* tile_keys;
  std::uint64_t* keys;
  std::uint32_t* seen;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    constexpr std::size_t indices = band::columns_per_tile<Dim>;
    keys[k] = band::column_key<Dim>(tile_keys[k / indices], k % indices);
    seen[k] = static_cast<std::uint32_t>(k);
  }
};

// Number of the column of each entry of that list. seen: list entries sorted by key.
struct NumberColumns {
  const std::uint32_t *seen, *is_first, *number;
  std::int32_t* column;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    column[seen[k]] = static_cast<std::int32_t>(number[k] + is_first[k]) - 1;
  }
};

template <int Dim>
struct FindNeighbourColumns {
  const std::uint64_t* keys;
  std::size_t columns;
  std::int32_t* adjacent;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    constexpr std::size_t sides = band::column_sides<Dim>;
    adjacent[k] = index_of_key(keys, columns, band::neighbour_column(keys[k / sides], k % sides));
  }
};

// Contribution of a set of particles to a column.
template <int Dim>
struct ColumnPart {
  band::ColumnMass column_mass;
  band::Extent<Dim> extent;
  double mass = 0;

  THAWSLIDE_HD ColumnPart& operator+=(const ColumnPart& part) {
    column_mass += part.column_mass;
    extent += part.extent;
    mass += part.mass;
    return *this;
  }
};

// Contributions of each tile's particles to the columns that it overlaps, one thread group per tile. For each chunk of
// particles, one thread per particle finds the overlaps of its box; then one thread per column adds the boxes in order.
template <int Dim>
struct SumInTile {
  static constexpr std::size_t at_a_time = 128, indices = band::columns_per_tile<Dim>;

  TileTables<Dim> tables;
  mpm::ParticleView<Dim> particles;
  mpm::SizesOfBodies sizes;  // half sizes of particles [m]
  double cell;
  mpm::Mapping mapping;
  ColumnPart<Dim>* parts;  // by tile and place

  struct Box {
    double volume, mass, top;
    band::Overlaps<Dim, double> along;
  };
  static constexpr std::size_t bytes = at_a_time * sizeof(Box);

  template <class Group>
  THAWSLIDE_HD void operator()(Group& group, std::size_t tile) const {
    constexpr auto nodes = static_cast<std::size_t>(mpm::Tile<Dim>::nodes);
    auto* boxes = reinterpret_cast<Box*>(group.shared());
    const std::size_t end = tables.first_of_cell[(tile + 1) * nodes];
    for (std::size_t first = tables.first_of_cell[tile * nodes], begin = first; first < end; first += at_a_time) {
      const std::size_t here = end - first < at_a_time ? end - first : at_a_time;
      group.each(here, [this, tile, first, boxes](std::size_t k) { boxes[k] = box_of(tile, tables.order[first + k]); });
      group.barrier();
      group.each(indices, [this, tile, boxes, here, is_first = first == begin](std::size_t index) {
        ColumnPart<Dim>& part = parts[tile * indices + index];
        part = sum_boxes(boxes, here, index, is_first ? ColumnPart<Dim>{} : part);
      });
      group.barrier();
    }
  }

 private:
  [[nodiscard]] THAWSLIDE_HD Box box_of(std::size_t tile, std::uint32_t particle) const {
    const mpm::ScalarIndex at{{particle}};
    return {
        particles.volume(particle), particles.mass(particle),
        mapping.template coordinate<Dim>(particles, at, Dim - 1) + sizes.of(particles, at).half,
        band::overlaps<Dim>(band::first_cell_of<Dim>(tables.tile_keys[tile]), cell, 1.0 / cell, sizes, particles, at)};
  }

  [[nodiscard]] THAWSLIDE_HD static ColumnPart<Dim> sum_boxes(const Box* boxes, std::size_t count, std::size_t index,
                                                              ColumnPart<Dim> sum) {
    for (std::size_t k = 0; k < count; ++k) {
      const Box& box = boxes[k];
      band::for_columns<Dim>(box.along, [&](const auto& side, double at, double fraction) {
        if (!(fraction > 0.0) || static_cast<std::size_t>(at) != index) {
          return;
        }
        const double volume = fraction * box.volume;
        if (volume > 0.0) {
          sum.column_mass += {volume, box.top};
        }
        sum.extent += band::extent_in_column<Dim>(box.along, side, 0);
        sum.mass += fraction * box.mass;
      });
    }
    return sum;
  }
};

// Adds the contributions of the tiles to each column, in the order of tiles. One thread per column.
template <class Part>
struct SumParts {
  const std::uint32_t *first_seen, *seen;  // of a column, in `seen`
  std::size_t columns, all_seen;
  const Part* parts;
  Part* sums;

  THAWSLIDE_HD void operator()(std::size_t column) const {
    const std::size_t last = column + 1 < columns ? first_seen[column + 1] : all_seen;
    Part sum;
    for (std::size_t k = first_seen[column]; k < last; ++k) {
      sum += parts[seen[k]];
    }
    sums[column] = sum;
  }
};

// Thickness, top and load of each column. One thread per column.
template <int Dim>
struct FinishColumns {
  const ColumnPart<Dim>* sums;
  const std::int32_t* adjacent;
  const double* normal_gravity;  // null: load is not required
  double cell;
  double *thickness, *top, *load_per_depth;

  THAWSLIDE_HD void operator()(std::size_t column) const {
    const ColumnPart<Dim> sum = sums[column];
    const auto filled = [&](std::size_t side) {
      const std::int32_t other = adjacent[column * band::column_sides<Dim> + side];
      return other != absent && sums[other].column_mass.is_present();
    };
    const bool at_edge = sum.column_mass.is_present() && band::lacks_neighbour<Dim>(filled);
    thickness[column] = band::thickness_of(sum.column_mass, band::footprint_of<Dim>(cell, at_edge, sum.extent, filled));
    top[column] = sum.column_mass.top;
    if (normal_gravity != nullptr) {
      load_per_depth[column] =
          sum.column_mass.is_present() ? band::load_per_depth(sum.column_mass, sum.mass, normal_gravity[column]) : 0.0;
    }
  }
};

// Columns as seen from the particles of each tile.
template <int Dim>
struct ColumnsByTile {
  using OfTile = band::ColumnsOfTile<Dim, band::NumbersOfColumns>;

  const std::uint64_t* tile_keys;
  const std::int32_t* column;  // by tile and place
  mpm::SizesOfBodies sizes;
  double cell;
  mpm::Mapping mapping;
  const double *thickness, *top, *cosine;

  [[nodiscard]] THAWSLIDE_HD OfTile of_tile(std::size_t tile) const {
    const std::int32_t* seen = column + tile * band::columns_per_tile<Dim>;
    return {band::first_cell_of<Dim>(tile_keys[tile]),
            cell,
            1.0 / cell,
            sizes,
            {thickness, seen},
            {top, seen},
            {cosine, seen},
            mapping.has_ground};
  }
};

}  // namespace thawslide::device
