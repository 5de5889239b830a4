// Kernels of the columns of the sliding mass (band/slide_columns.hpp), one thread per item.
#pragma once

#include "band/columns_of_tile.hpp"
#include "exec/key_lists.hpp"

namespace thawslide::band {

// Key of the column at each place of each tile. A column occurs once for each tile that overlaps it.
template <int Dim>
struct KeyOfColumn {
  const std::uint64_t* tile_keys;

  [[nodiscard]] THAWSLIDE_HD std::uint64_t operator()(std::size_t place) const {
    return column_key<Dim>(tile_keys[place / columns_per_tile<Dim>], place % columns_per_tile<Dim>);
  }
};

template <int Dim>
struct FindNeighbourColumns {
  const std::uint64_t* keys;
  std::size_t columns;
  std::int32_t* adjacent;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    constexpr std::size_t sides = column_sides<Dim>;
    adjacent[k] = exec::index_of_key(keys, columns, neighbour_column(keys[k / sides], k % sides));
  }
};

// Thickness, top and load of each column.
template <int Dim>
struct FinishColumns {
  const ColumnPart<Dim>* sums;
  const std::int32_t* adjacent;
  const double* width;           // of the section, relative
  const double* normal_gravity;  // null: load is not required
  double cell;
  double *thickness, *top, *load_per_depth;

  THAWSLIDE_HD void operator()(std::size_t column) const {
    const ColumnPart<Dim> sum = sums[column];
    const auto filled = [&](std::size_t side) {
      const std::int32_t other = adjacent[column * column_sides<Dim> + side];
      return other != exec::absent && sums[other].column_mass.is_present();
    };
    const bool at_edge = sum.column_mass.is_present() && lacks_neighbour<Dim>(filled);
    thickness[column] =
        thickness_of(sum.column_mass, width[column] * footprint_of<Dim>(cell, at_edge, sum.extent, filled));
    top[column] = sum.column_mass.top;
    if (normal_gravity != nullptr) {
      load_per_depth[column] =
          sum.column_mass.is_present() ? band::load_per_depth(sum.column_mass, sum.mass, normal_gravity[column]) : 0.0;
    }
  }
};

// Columns as seen from the particles of each tile. Numbers: as in ColumnsOfTile.
template <int Dim, class Numbers>
struct ColumnsByTile {
  using OfTile = ColumnsOfTile<Dim, Numbers>;

  const std::uint64_t* tile_keys;
  const std::int32_t* column;  // by tile and place
  mpm::SizesOfBodies sizes;
  double cell;
  bool has_ground;
  const double *thickness, *top, *cosine;

  [[nodiscard]] THAWSLIDE_HD OfTile of_tile(std::size_t tile) const {
    const std::int32_t* seen = column + tile * columns_per_tile<Dim>;
    return {first_cell_of<Dim>(tile_keys[tile]),
            cell,
            1.0 / cell,
            sizes,
            Numbers::of(thickness, seen),
            Numbers::of(top, seen),
            Numbers::of(cosine, seen),
            has_ground};
  }
};

}  // namespace thawslide::band
