// Sums of the sliding mass over the cells of a map on an executor (mpm/map_sums.hpp). Tiles that lie above each other
// form a stack. Stacks of a colour are so far apart that no two share a map cell, so their boxes can be added in
// parallel; the colours follow one another. Sums therefore depend neither on threads nor on the particles' places in
// memory. After a change of tiles, the map cells below the stacks are renumbered by sorting their keys.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include "band/segment_step.hpp"
#include "base/error.hpp"
#include "exec/keyed_parts.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/map_sums.hpp"
#include "mpm/tile.hpp"

namespace thawslide::band {

// Sums for maps after a step (3D only), and basal segments.
struct MapSample {
  std::vector<std::uint64_t> keys;     // of cells that particles may reach, ascending (mpm::map_cell_key)
  std::vector<mpm::MapSums> sums;      // by key; without sums over the band if it consists of columns
  std::vector<SegmentBelow> segments;  // of band columns
};

// Map cells below a stack. All stacks have the same number of places; those outside a stack's window are empty.
struct MapLayout {
  static constexpr std::uint64_t no_cell = ~std::uint64_t{0};

  mpm::MapCells cells;
  double grid_cell = 0.0;    // [m]
  int across = 0, deep = 0;  // places along each axis

  [[nodiscard]] THAWSLIDE_HD std::size_t places() const {
    return static_cast<std::size_t>(across) * static_cast<std::size_t>(deep);
  }

  // First and last map cell of a stack along each axis.
  struct Window {
    mpm::MapWindow columns, rows;
  };
  [[nodiscard]] THAWSLIDE_HD Window window(std::uint64_t stack_key) const {
    using T = mpm::Tile<3>;
    const T::Index tile = T::index(stack_key);
    return {mpm::map_window(T::edge * tile[0], T::edge, grid_cell, cells.largest_half, cells.corner_x,
                            cells.inverse_cell_x, cells.columns),
            mpm::map_window(T::edge * tile[1], T::edge, grid_cell, cells.largest_half, cells.corner_y,
                            cells.inverse_cell_y, cells.rows)};
  }
};

// Key of the cell at each place of each stack, or no_cell.
struct KeyOfMapCell {
  MapLayout layout;
  const std::uint64_t* stack_keys;

  [[nodiscard]] THAWSLIDE_HD std::uint64_t operator()(std::size_t place) const {
    const auto index = static_cast<int>(place % layout.places());
    const MapLayout::Window window = layout.window(stack_keys[place / layout.places()]);
    const int column = window.columns.first + index % layout.across, row = window.rows.first + index / layout.across;
    const bool is_present = column <= window.columns.last && row <= window.rows.last;
    return is_present ? mpm::map_cell_key(column, row) : MapLayout::no_cell;
  }
};

// Tiles by stack, upwards, and stacks by colour.
struct TileStacks {
  std::vector<std::uint32_t> tiles, first_tile;  // first_tile: of each stack in `tiles`, and the end
  std::vector<std::uint64_t> keys;               // by stack: of its tile at height 0
  std::vector<std::size_t> colours;              // first stack of each colour, and the end

  TileStacks(const std::vector<std::uint64_t>& tile_keys, const MapLayout& layout) {
    using T = mpm::Tile<3>;
    const mpm::MapCells& cells = layout.cells;
    const double reach = cells.largest_half + layout.grid_cell;  // as in mpm::map_window
    const double widest_cell = std::max(cells.cell_x, cells.cell_y), tile_width = layout.grid_cell * T::edge;
    const int along_axis = 1 + static_cast<int>(std::ceil((widest_cell + 2.0 * reach) / tile_width));
    struct Place {
      int colour;
      std::uint64_t stack;
      std::uint32_t tile;
    };
    std::vector<Place> places;
    for (std::size_t t = 0; t < tile_keys.size(); ++t) {
      T::Index index = T::index(tile_keys[t]);
      const auto remainder = [&](int number) { return (number % along_axis + along_axis) % along_axis; };
      const int colour = remainder(index[0]) + along_axis * remainder(index[1]);
      index[2] = 0;
      places.push_back({colour, T::key(index), static_cast<std::uint32_t>(t)});
    }
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
      return std::tie(a.colour, a.stack, a.tile) < std::tie(b.colour, b.stack, b.tile);
    });
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (k == 0 || places[k].colour != places[k - 1].colour) {
        colours.push_back(keys.size());
      }
      if (k == 0 || places[k].stack != places[k - 1].stack) {
        keys.push_back(places[k].stack);
        first_tile.push_back(static_cast<std::uint32_t>(k));
      }
      tiles.push_back(places[k].tile);
    }
    colours.push_back(keys.size());
    first_tile.push_back(static_cast<std::uint32_t>(places.size()));
  }
};

// Boxes over map cells (mpm/box_sums.hpp): one group per stack of a colour.
struct MapBoxes {
  using Part = mpm::MapSums;

  struct Stack {
    MapLayout::Window window;
    int across;
    std::size_t count_of_places;
    const std::int32_t* cell;  // by place
    const std::uint32_t *first, *last;

    [[nodiscard]] THAWSLIDE_HD std::size_t tiles() const { return static_cast<std::size_t>(last - first); }
    [[nodiscard]] THAWSLIDE_HD std::size_t tile(std::size_t k) const { return first[k]; }
    [[nodiscard]] THAWSLIDE_HD std::size_t places() const { return count_of_places; }
  };
  template <class Value>
  struct Spans {
    mpm::CellSpans<Value> columns, rows;
  };
  struct Box {
    mpm::CellRange columns, rows;
    bool in_band;
    mpm::MapSums sums;
  };
  struct Share {
    double fraction;
    bool is_below;

    THAWSLIDE_HD explicit operator bool() const { return is_below; }
  };

  MapLayout layout;
  mpm::SizesOfBodies sizes;  // half sizes of particles [m]
  bool has_band;             // of particles
  const std::uint64_t* stack_keys;
  const std::uint32_t *tiles, *first_tile;
  const std::int32_t* cell;  // by stack and place
  mpm::MapSums* sums;        // by cell
  std::int32_t count_of_cells;
  std::size_t first_stack, stacks;

  [[nodiscard]] THAWSLIDE_HD std::size_t groups() const { return stacks; }
  [[nodiscard]] THAWSLIDE_HD Stack group(std::size_t number) const {
    const std::size_t stack = first_stack + number;
    return {layout.window(stack_keys[stack]),
            layout.across,
            layout.places(),
            cell + stack * layout.places(),
            tiles + first_tile[stack],
            tiles + first_tile[stack + 1]};
  }
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Spans<typename At::Value> spans(const Stack& /*here*/,
                                                                                     const Particles& particles,
                                                                                     const At& at) const {
    const auto size = sizes.of(particles, at);
    const mpm::MapCells& map = layout.cells;
    return {mpm::cell_spans((particles.position.load(at, 0) - map.corner_x) * map.inverse_cell_x,
                            size.half * map.inverse_cell_x, size.inverse * (0.5 * map.cell_x), map.columns),
            mpm::cell_spans((particles.position.load(at, 1) - map.corner_y) * map.inverse_cell_y,
                            size.half * map.inverse_cell_y, size.inverse * (0.5 * map.cell_y), map.rows)};
  }
  template <class Particles, class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Box box(const Particles& particles, std::uint32_t p,
                                                             const Spans<Value>& spans, std::size_t lane) const {
    return {spans.columns.of_lane(lane),
            spans.rows.of_lane(lane),
            has_band && particles.in_band(p) != 0,
            {mpm::column_sums_of(particles, p), mpm::band_sums_of(particles, p)}};
  }
  template <class Visit>
  THAWSLIDE_ALWAYS_INLINE void for_places(const Stack& here, const Box& box, const Visit& visit) const {
    THAWSLIDE_ASSERT(box.columns.first >= here.window.columns.first && box.columns.last <= here.window.columns.last &&
                         box.rows.first >= here.window.rows.first && box.rows.last <= here.window.rows.last,
                     "a particle has left its tile: over map cells {} ..., {} ...", box.columns.first, box.rows.first);
    for (int row = box.rows.first; row <= box.rows.last; ++row) {
      const int first_of_row = (row - here.window.rows.first) * here.across - here.window.columns.first;
      const double row_fraction = box.rows.fraction(row);
      for (int column = box.columns.first; column <= box.columns.last; ++column) {
        visit(static_cast<std::size_t>(first_of_row + column),
              Share{row_fraction * box.columns.fraction(column), true});
      }
    }
  }
  [[nodiscard]] THAWSLIDE_HD Share share(const Stack& here, const Box& box, std::size_t place) const {
    const int column = here.window.columns.first + static_cast<int>(place) % here.across;
    const int row = here.window.rows.first + static_cast<int>(place) / here.across;
    if (column < box.columns.first || column > box.columns.last || row < box.rows.first || row > box.rows.last) {
      return {0.0, false};
    }
    return {box.rows.fraction(row) * box.columns.fraction(column), true};
  }
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Part* part(const Stack& here, std::size_t place) const {
    const std::int32_t number = here.cell[place];
    return number < count_of_cells ? sums + number : nullptr;
  }
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void add(const Box& box, const Share& share, Part& part) const {
    part.column.add(share.fraction, box.sums.column);
    if (box.in_band) {
      part.band.add(share.fraction, box.sums.band);
    }
  }
};

template <class Executor>
class MapStage {
 public:
  // cell: mesh size [m].
  MapStage(Executor& executor, double cell) : executor_(executor), cell_(cell) {}

  // Sums over particles at their positions after a step, with the tiles from its beginning. tile_keys(): ascending;
  // only called after forget_tiles() or with other cells. sizes: half sizes of particles [m]. columns: band columns;
  // null if the band consists of particles. add_boxes(boxes): adds the boxes of particles (mpm/box_sums.hpp).
  template <class TileKeys, class Columns, class AddBoxes>
  const MapSample& sample(const mpm::MapCells& cells, const TileKeys& tile_keys, const mpm::SizesOfBodies& sizes,
                          Columns* columns, const AddBoxes& add_boxes) {
    if (!knows_tiles_ || !(cells == layout_.cells)) {
      number_cells(cells, tile_keys());
      knows_tiles_ = true;
    }
    executor_.for_each(sums_.size(), exec::Fill<mpm::MapSums>{sums_.data(), {}});
    for (std::size_t c = 0; c + 1 < colours_.size(); ++c) {
      add_boxes(MapBoxes{layout_, sizes, columns == nullptr, stack_keys_.data(), tiles_.data(), first_tile_.data(),
                         cell_of_.data(), sums_.data(), static_cast<std::int32_t>(sums_.size()), colours_[c],
                         colours_[c + 1] - colours_[c]});
    }
    sample_.sums.resize(sums_.size());
    executor_.copy_out(sample_.sums.data(), sums_.data(), sums_.size());
    sample_.segments = columns != nullptr ? columns->summaries() : std::vector<SegmentBelow>();
    return sample_;
  }
  void forget_tiles() { knows_tiles_ = false; }

 private:
  void number_cells(const mpm::MapCells& cells, const std::vector<std::uint64_t>& tile_keys) {
    const auto places_along = [&](double inverse_cell) {
      const double width = cell_ * (mpm::Tile<3>::edge + 2.0) + 2.0 * cells.largest_half;
      return static_cast<int>(std::ceil(width * inverse_cell)) + 1;
    };
    layout_ = {cells, cell_, places_along(cells.inverse_cell_x), places_along(cells.inverse_cell_y)};
    const TileStacks stacks(tile_keys, layout_);
    colours_ = stacks.colours;
    stack_keys_.set(stacks.keys);
    tiles_.set(stacks.tiles);
    first_tile_.set(stacks.first_tile);
    places_.list(stacks.keys.size() * layout_.places(), KeyOfMapCell{layout_, stack_keys_.data()});
    places_.index(cell_of_);
    sample_.keys = places_.keys().get();
    if (!sample_.keys.empty() && sample_.keys.back() == MapLayout::no_cell) {
      sample_.keys.pop_back();
    }
    sums_.resize(sample_.keys.size());
  }

  Executor& executor_;
  double cell_;
  MapLayout layout_;
  bool knows_tiles_ = false;
  std::vector<std::size_t> colours_;
  exec::Array<std::uint64_t, Executor> stack_keys_{executor_};
  exec::Array<std::uint32_t, Executor> tiles_{executor_}, first_tile_{executor_};
  exec::KeyedPlaces<Executor> places_{executor_};  // map cells below the stacks
  exec::Array<std::int32_t, Executor> cell_of_{executor_};
  exec::Array<mpm::MapSums, Executor> sums_{executor_};
  MapSample sample_;
};

}  // namespace thawslide::band
