#include "sim/maps/flow_maps.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/state_numbers.hpp"

namespace thawslide::sim {

namespace {

const MapKind thickness_at_start{"", "m", "", [](const MapCell& cell) { return cell.thickness_at_start; }};
const MapKind thickness_now{"", "m", "", [](const MapCell& cell) { return cell.thickness; }};
const MapKind largest_thickness{"", "m", "", [](const MapCell& cell) { return cell.max_thickness; }};

// Remainder in [0, divisor), also for negative numbers.
std::uint64_t modulo(int number, int divisor) {
  return static_cast<std::uint64_t>((number % divisor + divisor) % divisor);
}

}  // namespace

FlowMaps::FlowMaps(const MapGrid& map_grid, std::array<double, 2> origin, const std::vector<double>& half_sizes,
                   double arrival_thickness, DrawnArea drawn)
    : map_grid_(map_grid),
      cells_{map_grid.x - 0.5 * map_grid.cell_x - origin[0],
             map_grid.y - 0.5 * map_grid.cell_y - origin[1],
             map_grid.cell_x,
             map_grid.cell_y,
             1.0 / map_grid.cell_x,
             1.0 / map_grid.cell_y,
             map_grid.columns,
             map_grid.rows,
             0.0},
      arrival_thickness_(arrival_thickness),
      drawn_(std::move(drawn)) {
  for (const double half : half_sizes) {
    sizes_.add(half);
    cells_.largest_half = std::max(cells_.largest_half, half);
  }
}

std::uint64_t FlowMaps::tile_key(int tile_x, int tile_y) {
  return static_cast<std::uint64_t>(tile_y) << 32 | static_cast<std::uint64_t>(tile_x);
}

std::size_t FlowMaps::index_in_tile(int column, int row) {
  return static_cast<std::size_t>((row & (edge - 1)) << edge_bits | (column & (edge - 1)));
}

FlowMaps::MapTile& FlowMaps::touch(int tile_x, int tile_y) {
  const auto number = static_cast<std::size_t>(tile_index_.insert(tile_key(tile_x, tile_y)));
  if (number == tiles_.size()) {
    tiles_.push_back(std::make_unique<MapTile>());
    tiles_.back()->column = tile_x << edge_bits;
    tiles_.back()->row = tile_y << edge_bits;
  }
  return *tiles_[number];
}

// Sorts the background grid's tiles into stacks, and the stacks by colour. Stacks of a colour are so far apart that no
// two share a map cell, so their sums can be computed in parallel.
void FlowMaps::create_tiles(const Grid& grid) {
  const double reach = cells_.largest_half + grid.cell();  // as in mpm::map_window
  const double tile_width = grid.cell() * mpm::Tile<3>::edge;
  const double widest_cell = std::max(map_grid_.cell_x, map_grid_.cell_y);
  const int colours = 1 + static_cast<int>(std::ceil((widest_cell + 2.0 * reach) / tile_width));  // along each axis
  seen_.clear();
  tile_indices_.clear();
  for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
    seen_.push_back(grid.tiles()[t].key);
    auto index = mpm::Tile<3>::index(grid.tiles()[t].key);
    const auto colour = modulo(index[0], colours) + static_cast<std::uint64_t>(colours) * modulo(index[1], colours);
    index[2] = 0;
    tile_indices_.push_back({colour, mpm::Tile<3>::key(index), static_cast<std::uint32_t>(t)});
  }
  std::sort(tile_indices_.begin(), tile_indices_.end(), [](const TileIndex& a, const TileIndex& b) {
    return std::tie(a.colour, a.stack, a.tile) < std::tie(b.colour, b.stack, b.tile);
  });
}

void FlowMaps::set_window(const Grid& grid, Stack& stack) {
  using T = mpm::Tile<3>;
  const auto index = T::index(tile_indices_[stack.first].stack);
  // First and last map tile along an axis.
  const auto tiles_along = [&](std::size_t a, double corner, double inverse_cell, int cells) {
    const mpm::MapWindow window =
        mpm::map_window(T::edge * index[a], T::edge, grid.cell(), cells_.largest_half, corner, inverse_cell, cells);
    return std::array<int, 2>{window.first >> edge_bits, window.last >> edge_bits};
  };
  const auto along_x = tiles_along(0, cells_.corner_x, cells_.inverse_cell_x, cells_.columns);
  const auto along_y = tiles_along(1, cells_.corner_y, cells_.inverse_cell_y, cells_.rows);
  stack.tile_x = along_x[0];
  stack.tile_y = along_y[0];
  stack.across = along_x[1] - along_x[0] + 1;
  stack.deep = along_y[1] - along_y[0] + 1;
  stack.window = window_tiles_.size();
  for (int y = along_y[0]; y <= along_y[1]; ++y) {
    for (int x = along_x[0]; x <= along_x[1]; ++x) {
      window_tiles_.push_back(&touch(x, y));
    }
  }
}

// Updates the active tiles, those in the windows. Tiles that no particle reaches any more become empty.
void FlowMaps::mark_active() {
  std::swap(active_, formerly_active_);
  for (MapTile* tile : formerly_active_) {
    tile->active = false;
  }
  active_.clear();
  for (MapTile* tile : window_tiles_) {
    if (!tile->active) {
      tile->active = true;
      active_.push_back(tile);
    }
  }
  for (MapTile* tile : formerly_active_) {
    if (!tile->active) {
      for (MapCell& cell : tile->cells) {
        cell.update({}, {}, map_grid_.cell_area(), arrival_thickness_, 0.0);
      }
    }
  }
}

void FlowMaps::find_stacks(const Grid& grid) {
  create_tiles(grid);
  stacks_.clear();
  colours_.clear();
  window_tiles_.clear();
  for (std::uint32_t k = 0; k < tile_indices_.size(); ++k) {
    if (k == 0 || tile_indices_[k].stack != tile_indices_[k - 1].stack) {
      if (k == 0 || tile_indices_[k].colour != tile_indices_[k - 1].colour) {
        colours_.push_back(stacks_.size());
      }
      stacks_.push_back({k, k, 0, 0, 0, 0, 0});
      set_window(grid, stacks_.back());
    }
    stacks_.back().last = k + 1;
  }
  colours_.push_back(stacks_.size());
  mark_active();
}

THAWSLIDE_ALWAYS_INLINE void FlowMaps::add_box(const Particles& particles, std::size_t p, const mpm::CellRange& x,
                                               const mpm::CellRange& y, const Stack& stack) {
  const mpm::ColumnSums sums = mpm::column_sums_of(particles, p);
  const bool in_band = band_is_of_particles_ && particles.in_band(p) != 0;
  const mpm::BandSums band = mpm::band_sums_of(particles, p);
  for (int row = y.first; row <= y.last; ++row) {
    const double row_fraction = y.fraction(row);
    const auto window_row = static_cast<std::size_t>(((row >> edge_bits) - stack.tile_y) * stack.across);
    MapTile* const* const tiles_of_row = &window_tiles_[stack.window + window_row];
    for (int column = x.first; column <= x.last; ++column) {
      MapTile& below = *tiles_of_row[(column >> edge_bits) - stack.tile_x];
      const std::size_t index = index_in_tile(column, row);
      const double fraction = row_fraction * x.fraction(column);
      below.sums[index].add(fraction, sums);
      if (in_band) {
        below.band[index].add(fraction, band);
      }
    }
  }
}

void FlowMaps::add_stack(const Grid& grid, const Particles& particles, const Stack& stack) {
  const auto first_column = static_cast<double>(stack.tile_x << edge_bits),
             first_row = static_cast<double>(stack.tile_y << edge_bits),
             end_column = first_column + (stack.across << edge_bits), end_row = first_row + (stack.deep << edge_bits);
  for (std::uint32_t k = stack.first; k < stack.last; ++k) {
    for (const auto& batch : grid.batches(tile_indices_[k].tile)) {
      const auto size = sizes_.of(particles, batch);
      const auto x = mpm::cell_spans((particles.position.load(batch, 0) - cells_.corner_x) * cells_.inverse_cell_x,
                                     size.half * cells_.inverse_cell_x, size.inverse * (0.5 * map_grid_.cell_x),
                                     map_grid_.columns);
      const auto y =
          mpm::cell_spans((particles.position.load(batch, 1) - cells_.corner_y) * cells_.inverse_cell_y,
                          size.half * cells_.inverse_cell_y, size.inverse * (0.5 * map_grid_.cell_y), map_grid_.rows);
      const auto inside =
          (x.first >= first_column) & (x.last < end_column) & (y.first >= first_row) & (y.last < end_row);
      THAWSLIDE_ASSERT(!any(!inside), "of particles {} ... one has left its tile: over map cells {} ..., {} ...",
                       particles.id(batch.particle[0]), x.first[0], y.first[0]);
      for (std::size_t lane = 0; lane < batch.count; ++lane) {
        add_box(particles, batch.particle[lane], x.of_lane(lane), y.of_lane(lane), stack);
      }
    }
  }
}

// Adds heat and pressure of the segment to the cells that the slide may reach, weighted by the fraction of its width
// over each.
void FlowMaps::add_segment(const SegmentBelow& segment) {
  using ScalarIndex = Simd<double>;
  const mpm::CellRange x = mpm::cell_spans(ScalarIndex((segment.x - cells_.corner_x) * cells_.inverse_cell_x),
                                           ScalarIndex(segment.half_x * cells_.inverse_cell_x),
                                           ScalarIndex(0.5 * map_grid_.cell_x / segment.half_x), map_grid_.columns)
                               .of_lane(0);
  const mpm::CellRange y = mpm::cell_spans(ScalarIndex((segment.y - cells_.corner_y) * cells_.inverse_cell_y),
                                           ScalarIndex(segment.half_y * cells_.inverse_cell_y),
                                           ScalarIndex(0.5 * map_grid_.cell_y / segment.half_y), map_grid_.rows)
                               .of_lane(0);
  const mpm::BandSums band{segment.area, segment.area * segment.temperature, segment.area * segment.pressure};
  for (int row = y.first; row <= y.last; ++row) {
    for (int column = x.first; column <= x.last; ++column) {
      const std::int32_t number = tile_index_.find(tile_key(column >> edge_bits, row >> edge_bits));
      if (number == KeyIndex::absent || !tiles_[static_cast<std::size_t>(number)]->active) {
        continue;
      }
      MapTile& below = *tiles_[static_cast<std::size_t>(number)];
      const std::size_t index = index_in_tile(column, row);
      const double fraction = y.fraction(row) * x.fraction(column);
      below.band[index].add(fraction, band);
      below.sums[index].water += fraction * segment.area * segment.liquid;
    }
  }
}

void FlowMaps::gather(const Grid& grid, const Particles& particles, double time,
                      const std::vector<SegmentBelow>* segments) {
  band_is_of_particles_ = segments == nullptr;
  const bool same_tiles = std::equal(seen_.begin(), seen_.end(), grid.tiles().begin(), grid.tiles().end(),
                                     [](std::uint64_t key, const auto& tile) { return key == tile.key; });
  if (!same_tiles) {
    find_stacks(grid);
  }
  for (std::size_t c = 0; c + 1 < colours_.size(); ++c) {
    const std::size_t first = colours_[c];
    parallel_for(colours_[c + 1] - first, [&](std::size_t k) { add_stack(grid, particles, stacks_[first + k]); });
  }
  update_cells(time, segments);
}

void FlowMaps::gather(const std::vector<std::uint64_t>& keys, const std::vector<mpm::MapSums>& sums, double time,
                      const std::vector<SegmentBelow>* segments) {
  seen_.clear();
  window_tiles_.clear();
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const int column = mpm::column_of_key(keys[k]), row = mpm::row_of_key(keys[k]);
    MapTile& tile = touch(column >> edge_bits, row >> edge_bits);
    const std::size_t index = index_in_tile(column, row);
    tile.sums[index] = sums[k].column;
    tile.band[index] = segments == nullptr ? sums[k].band : mpm::BandSums{};
    window_tiles_.push_back(&tile);
  }
  mark_active();
  update_cells(time, segments);
}

// Adds the segments, records the sums of the active tiles and resets them.
void FlowMaps::update_cells(double time, const std::vector<SegmentBelow>* segments) {
  for (std::size_t k = 0; segments != nullptr && k < segments->size(); ++k) {
    add_segment((*segments)[k]);
  }
  parallel_for(active_.size(), [&](std::size_t k) {
    MapTile& tile = *active_[k];
    for (std::size_t index = 0; index < tile_cells; ++index) {
      tile.cells[index].update(tile.sums[index], tile.band[index], map_grid_.cell_area(), arrival_thickness_, time);
    }
    tile.sums.fill({});
    tile.band.fill({});
  });
}

void FlowMaps::slide_left() {
  for (const std::unique_ptr<MapTile>& tile : tiles_) {
    for (MapCell& cell : tile->cells) {
      cell.update({}, {}, map_grid_.cell_area(), arrival_thickness_, 0.0);
    }
  }
}

void FlowMaps::start(const Grid& grid, const Particles& particles) {
  gather(grid, particles, 0.0);
  for (MapTile* tile : active_) {
    for (MapCell& cell : tile->cells) {
      cell.thickness_at_start = cell.thickness;
    }
  }
}

const MapCell& FlowMaps::cell(int column, int row) const {
  static const MapCell like_new;
  const std::int32_t number = tile_index_.find(tile_key(column >> edge_bits, row >> edge_bits));
  return number == KeyIndex::absent ? like_new
                                    : tiles_[static_cast<std::size_t>(number)]->cells[index_in_tile(column, row)];
}

std::vector<const FlowMaps::MapTile*> FlowMaps::tiles_in_order() const {
  std::vector<const MapTile*> tiles;
  for (const std::unique_ptr<MapTile>& tile : tiles_) {
    tiles.push_back(tile.get());
  }
  std::sort(tiles.begin(), tiles.end(), [](const MapTile* a, const MapTile* b) {
    return std::tie(a->row, a->column) < std::tie(b->row, b->column);
  });
  return tiles;
}

Raster FlowMaps::raster(const MapKind& kind, MapExtent extent) const {
  int first_column = 0, first_row = 0, last_column = map_grid_.columns - 1, last_row = map_grid_.rows - 1;
  if (extent == MapExtent::slide) {
    first_column = map_grid_.columns;
    first_row = map_grid_.rows;
    last_column = last_row = -1;
    for_cells([&](int column, int row, const MapCell& /*cell*/) {
      first_column = std::min(first_column, column);
      last_column = std::max(last_column, column);
      first_row = std::min(first_row, row);
      last_row = std::max(last_row, row);
    });
  }
  Raster raster;
  raster.cell_x = map_grid_.cell_x;
  raster.cell_y = map_grid_.cell_y;
  raster.x = map_grid_.x + first_column * map_grid_.cell_x;
  raster.y = map_grid_.y + first_row * map_grid_.cell_y;
  raster.columns = std::max(0, last_column - first_column + 1);
  raster.rows = std::max(0, last_row - first_row + 1);
  raster.crs = map_grid_.crs;
  raster.values.assign(static_cast<std::size_t>(raster.columns) * static_cast<std::size_t>(raster.rows), MapCell::none);
  for_cells([&](int column, int row, const MapCell& cell) {
    raster.values[raster.index(column - first_column, row - first_row)] = kind.value(cell);
  });
  return raster;
}

double FlowMaps::covered_volume(double least) const {
  double volume = 0.0;
  for_cells([&](int /*column*/, int /*row*/, const MapCell& cell) {
    volume += cell.thickness > least ? cell.thickness * map_grid_.cell_area() : 0.0;
  });
  return volume;
}

CoveredCells FlowMaps::cells_under(const MapKind& thickness, double least) const {
  const Raster at_start = raster(thickness_at_start, MapExtent::slide);
  const auto column = static_cast<int>(std::lround((at_start.x - map_grid_.x) / map_grid_.cell_x));
  const auto row = static_cast<int>(std::lround((at_start.y - map_grid_.y) / map_grid_.cell_y));
  return sim::covered_cells(raster(thickness, MapExtent::slide), at_start, drawn_, column, row, least);
}

CoveredCells FlowMaps::covered_cells(double least) const { return cells_under(thickness_now, least); }

CoveredCells FlowMaps::affected_cells(double least) const { return cells_under(largest_thickness, least); }

std::vector<double> FlowMaps::state() const {
  std::vector<double> numbers{static_cast<double>(map_grid_.columns), static_cast<double>(map_grid_.rows)};
  for_cells([&](int column, int row, const MapCell& cell) {
    numbers.push_back(static_cast<double>(row) * map_grid_.columns + column);
    const MapCellNumbers values = numbers_of(cell);
    numbers.insert(numbers.end(), values.begin(), values.end());
  });
  return numbers;
}

void FlowMaps::restore(const std::vector<double>& numbers) {
  StateNumbers state(numbers, "maps");
  const double columns = state.next(), rows = state.next();
  if (columns != map_grid_.columns || rows != map_grid_.rows) {
    state.fail(fmt::format("it has {} x {} cells, but the case has {} x {}", columns, rows, map_grid_.columns,
                           map_grid_.rows));
  }
  tile_index_.clear();
  tiles_.clear();
  active_.clear();
  seen_.clear();
  const std::int64_t last_cell = static_cast<std::int64_t>(map_grid_.columns) * map_grid_.rows - 1;
  while (state.left() > 0) {
    const std::int64_t number = state.whole(last_cell);
    const int column = static_cast<int>(number % map_grid_.columns), row = static_cast<int>(number / map_grid_.columns);
    MapCellNumbers values;
    for (double& value : values) {
      value = state.next();
    }
    touch(column >> edge_bits, row >> edge_bits).cells[index_in_tile(column, row)] = map_cell_of(values);
  }
  // Any tile may be occupied.
  for (const std::unique_ptr<MapTile>& tile : tiles_) {
    active_.push_back(tile.get());
  }
}

}  // namespace thawslide::sim
