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
    cells_.largest_half = std::max(cells_.largest_half, half);
  }
}

std::size_t FlowMaps::index_in_tile(int column, int row) {
  return static_cast<std::size_t>((row & (edge - 1)) << edge_bits | (column & (edge - 1)));
}

FlowMaps::CellPlace FlowMaps::place_of(int column, int row) {
  const int tile_x = column >> edge_bits, tile_y = row >> edge_bits;
  const auto number = static_cast<std::size_t>(tile_index_.insert(mpm::map_cell_key(tile_x, tile_y)));
  if (number == tiles_.size()) {
    tiles_.push_back(std::make_unique<MapTile>());
    tiles_.back()->column = tile_x << edge_bits;
    tiles_.back()->row = tile_y << edge_bits;
  }
  return {tiles_[number].get(), index_in_tile(column, row)};
}

FlowMaps::MapTile* FlowMaps::tile_at(int column, int row) const {
  const std::int32_t number = tile_index_.find(mpm::map_cell_key(column >> edge_bits, row >> edge_bits));
  return number == KeyIndex::absent ? nullptr : tiles_[static_cast<std::size_t>(number)].get();
}

// Cells that no particle reaches any more become empty.
void FlowMaps::number_cells(const std::vector<std::uint64_t>& keys) {
  keys_ = keys;
  const std::vector<CellPlace> formerly = std::exchange(reached_, {});
  for (const CellPlace& place : formerly) {
    place.number() = KeyIndex::absent;
  }
  for (std::size_t k = 0; k < keys.size(); ++k) {
    reached_.push_back(place_of(mpm::column_of_key(keys[k]), mpm::row_of_key(keys[k])));
    reached_.back().number() = static_cast<std::int32_t>(k);
  }
  for (const CellPlace& place : formerly) {
    if (place.number() == KeyIndex::absent) {
      place.cell().clear();
    }
  }
}

// Adds heat and pressure of the segment to the cells that the slide may reach, weighted by the fraction of its width
// over each.
void FlowMaps::add_segment(const band::SegmentBelow& segment) {
  const auto spans = [](double middle, double half, double corner, double cell, double inverse_cell, int cells) {
    return mpm::cell_spans((middle - corner) * inverse_cell, half * inverse_cell, 0.5 * cell / half, cells).of_lane(0);
  };
  const mpm::CellRange x = spans(segment.x, segment.half_x, cells_.corner_x, cells_.cell_x, cells_.inverse_cell_x,
                                 cells_.columns),
                       y = spans(segment.y, segment.half_y, cells_.corner_y, cells_.cell_y, cells_.inverse_cell_y,
                                 cells_.rows);
  const mpm::BandSums band{segment.area, segment.area * segment.temperature, segment.area * segment.pressure};
  for (int row = y.first; row <= y.last; ++row) {
    for (int column = x.first; column <= x.last; ++column) {
      const MapTile* tile = tile_at(column, row);
      const std::int32_t number = tile == nullptr ? KeyIndex::absent : tile->number[index_in_tile(column, row)];
      if (number != KeyIndex::absent) {
        mpm::MapSums& sums = sums_[static_cast<std::size_t>(number)];
        const double fraction = y.fraction(row) * x.fraction(column);
        sums.band.add(fraction, band);
        sums.column.water += fraction * segment.area * segment.liquid;
      }
    }
  }
}

void FlowMaps::gather(const band::MapSample& sample, double time) {
  if (sample.keys != keys_) {
    number_cells(sample.keys);
  }
  sums_ = sample.sums;
  for (const band::SegmentBelow& segment : sample.segments) {
    add_segment(segment);
  }
  constexpr std::size_t of_task = 256;
  parallel_for((sums_.size() + of_task - 1) / of_task, [&](std::size_t task) {
    for (std::size_t k = task * of_task; k < std::min(sums_.size(), (task + 1) * of_task); ++k) {
      reached_[k].cell().update(sums_[k].column, sums_[k].band, map_grid_.cell_area(), arrival_thickness_, time);
    }
  });
}

void FlowMaps::slide_left() {
  for (const std::unique_ptr<MapTile>& tile : tiles_) {
    for (MapCell& cell : tile->cells) {
      cell.clear();
    }
  }
}

void FlowMaps::start(const band::MapSample& sample) {
  gather(sample, 0.0);
  for (const CellPlace& place : reached_) {
    place.cell().thickness_at_start = place.cell().thickness;
  }
}

const MapCell& FlowMaps::cell(int column, int row) const {
  static const MapCell like_new;
  const MapTile* tile = tile_at(column, row);
  return tile == nullptr ? like_new : tile->cells[index_in_tile(column, row)];
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
  keys_.clear();
  reached_.clear();
  const std::int64_t last_cell = static_cast<std::int64_t>(map_grid_.columns) * map_grid_.rows - 1;
  while (state.left() > 0) {
    const std::int64_t number = state.whole(last_cell);
    const int column = static_cast<int>(number % map_grid_.columns), row = static_cast<int>(number / map_grid_.columns);
    MapCellNumbers values;
    for (double& value : values) {
      value = state.next();
    }
    reached_.push_back(place_of(column, row));
    reached_.back().cell() = map_cell_of(values);
  }
}

}  // namespace thawslide::sim
