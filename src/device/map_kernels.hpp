// Kernels that sum the sliding mass over map cells (device/maps.hpp), using mpm/map_sums.hpp.
#pragma once

#include "device/tile_tables.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/map_sums.hpp"
#include "mpm/particle_view.hpp"
#include "mpm/scalar_index.hpp"

namespace thawslide::device {

// Map cells below each tile. All tiles have the same number of places; those outside a tile's window are empty.
struct TileMapLayout {
  static constexpr std::uint64_t no_cell = ~std::uint64_t{0};

  mpm::MapCells cells;
  double grid_cell = 0.0;            // [m]
  std::size_t across = 0, deep = 0;  // places along each axis

  [[nodiscard]] THAWSLIDE_HD std::size_t of_tile() const { return across * deep; }

  // First and last map cell of a tile's window.
  struct Window {
    mpm::MapWindow columns, rows;
  };
  [[nodiscard]] THAWSLIDE_HD Window window(std::uint64_t tile_key) const {
    using T = mpm::Tile<3>;
    const T::Index tile = T::index(tile_key);
    return {mpm::map_window(T::edge * tile[0], T::edge, grid_cell, cells.largest_half, cells.corner_x,
                            cells.inverse_cell_x, cells.columns),
            mpm::map_window(T::edge * tile[1], T::edge, grid_cell, cells.largest_half, cells.corner_y,
                            cells.inverse_cell_y, cells.rows)};
  }
};

// Key of the cell at each place of each tile, or no_cell.
struct KeyOfMapCell {
  TileMapLayout layout;
  const std::uint64_t* tile_keys;

  [[nodiscard]] THAWSLIDE_HD std::uint64_t operator()(std::size_t place) const {
    const std::size_t index = place % layout.of_tile();
    const TileMapLayout::Window window = layout.window(tile_keys[place / layout.of_tile()]);
    const int column = window.columns.first + static_cast<int>(index % layout.across);
    const int row = window.rows.first + static_cast<int>(index / layout.across);
    const bool is_present = column <= window.columns.last && row <= window.rows.last;
    return is_present ? mpm::map_cell_key(column, row) : TileMapLayout::no_cell;
  }
};

// Contributions of each tile's particles to its map cells, one thread group per tile. For each chunk of particles, one
// thread per particle finds the cells below its box; then one thread per cell adds the boxes in order.
struct SumMapInTile {
  static constexpr std::size_t at_a_time = 128;

  TileMapLayout layout;
  TileTables<3> tables;
  mpm::ParticleView<3> particles;
  mpm::SizesOfBodies sizes;  // half sizes of particles [m]
  mpm::MapSums* parts;       // by tile and place

  struct Box {
    mpm::CellRange columns, rows;
    bool in_band;
    mpm::MapSums sums;
  };
  static constexpr std::size_t bytes = at_a_time * sizeof(Box);

  template <class Group>
  THAWSLIDE_HD void operator()(Group& group, std::size_t tile) const {
    constexpr auto nodes = static_cast<std::size_t>(mpm::Tile<3>::nodes);
    auto* boxes = reinterpret_cast<Box*>(group.shared());
    const std::size_t end = tables.first_of_cell[(tile + 1) * nodes];
    for (std::size_t first = tables.first_of_cell[tile * nodes], begin = first; first < end; first += at_a_time) {
      const std::size_t here = end - first < at_a_time ? end - first : at_a_time;
      group.each(here, [this, first, boxes](std::size_t k) { boxes[k] = box_of(tables.order[first + k]); });
      group.barrier();
      group.each(layout.of_tile(), [this, tile, boxes, here, is_first = first == begin](std::size_t index) {
        mpm::MapSums& part = parts[tile * layout.of_tile() + index];
        part = sum_boxes(boxes, here, tile, index, is_first ? mpm::MapSums{} : part);
      });
      group.barrier();
    }
  }

 private:
  [[nodiscard]] THAWSLIDE_HD Box box_of(std::uint32_t p) const {
    const auto size = sizes.of(particles, mpm::ScalarIndex{{p}});
    const double half = size.half, inverse = size.inverse;
    const mpm::MapCells& cells = layout.cells;
    const auto spans = [half, inverse](double position, double corner, double cell, double inverse_cell, int count) {
      return mpm::cell_spans((position - corner) * inverse_cell, half * inverse_cell, inverse * (0.5 * cell), count)
          .of_lane(0);
    };
    return {spans(particles.position(p, 0), cells.corner_x, cells.cell_x, cells.inverse_cell_x, cells.columns),
            spans(particles.position(p, 1), cells.corner_y, cells.cell_y, cells.inverse_cell_y, cells.rows),
            particles.in_band(p) != 0,
            {mpm::column_sums_of(particles, p), mpm::band_sums_of(particles, p)}};
  }

  [[nodiscard]] THAWSLIDE_HD mpm::MapSums sum_boxes(const Box* boxes, std::size_t count, std::size_t tile,
                                                    std::size_t index, mpm::MapSums sum) const {
    const TileMapLayout::Window window = layout.window(tables.tile_keys[tile]);
    const int column = window.columns.first + static_cast<int>(index % layout.across);
    const int row = window.rows.first + static_cast<int>(index / layout.across);
    for (std::size_t k = 0; k < count; ++k) {
      const Box& box = boxes[k];
      if (column < box.columns.first || column > box.columns.last || row < box.rows.first || row > box.rows.last) {
        continue;
      }
      const double fraction = box.rows.fraction(row) * box.columns.fraction(column);
      sum.column.add(fraction, box.sums.column);
      if (box.in_band) {
        sum.band.add(fraction, box.sums.band);
      }
    }
    return sum;
  }
};

}  // namespace thawslide::device
