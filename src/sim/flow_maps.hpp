// Maps of a slide in space: its thickness, speed and more over the cells of a regular grid, gathered every step.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/key_index.hpp"
#include "base/raster.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/map_sums.hpp"
#include "mpm/sparse_grid.hpp"
#include "sim/covered_area.hpp"
#include "sim/map_cell.hpp"
#include "sim/map_grid.hpp"
#include "sim/map_kinds.hpp"

namespace thawslide::sim {

enum class MapExtent { whole_grid, slide };

// A piece of base with a band column, in the particles' frame.
struct SegmentBelow {
  double x, y, half_x, half_y;           // its middle and half of its width [m]
  double area;                           // [m2]
  double temperature, pressure, liquid;  // means over the band [C], [Pa]; volume of water over the area [m]
};

// A particle's volume, mass and momentum count to the cells below its box, by the share of the box over each. The sum
// of thickness times cell area is the particles' volume: of a box that pokes out of the grid all counts to the cells at
// its edge. Sums go by stack of the background grid's tiles, in an order that follows from the tiles, so that results
// depend neither on threads nor on the particles' places in memory. Memory and work follow the slide.
class FlowMaps {
 public:
  using Grid = mpm::SparseGrid<3, double>;
  using Particles = mpm::Particles<3, double>;

  // origin: of the particles' positions [m]; half_sizes: of particles by body [m]; arrival_thickness: maps' [m].
  // Particle centres lie over the map grid. drawn: the releases; not known: the covered area at the start follows from
  // the thickness there.
  FlowMaps(const MapGrid& map_grid, std::array<double, 2> origin, const std::vector<double>& half_sizes,
           double arrival_thickness, DrawnArea drawn = {});

  // Takes the particles as they are at a time [s], with the tiles and the order of the step that brought them there.
  // pieces: of the base, where the band is of columns, which then tell its heat and pressure in place of the particles.
  void gather(const Grid& grid, const Particles& particles, double time,
              const std::vector<SegmentBelow>* segments = nullptr);
  // The same from sums over cells by key (mpm::map_cell_key): what a device made of the particles.
  void gather(const std::vector<std::uint64_t>& keys, const std::vector<mpm::MapSums>& sums, double time,
              const std::vector<SegmentBelow>* segments = nullptr);
  // At t = 0: what changes of elevation count from.
  void start(const Grid& grid, const Particles& particles);

  // Nothing of the slide is there any more; what was largest stays.
  void slide_left();

  // What cells take in memory that the slide ever was near; and one of them.
  [[nodiscard]] std::size_t bytes() const { return tiles_.size() * sizeof(MapTile); }
  [[nodiscard]] static constexpr std::size_t bytes_of_cell() { return sizeof(MapTile) / tile_cells; }

  [[nodiscard]] const MapGrid& map_grid() const { return map_grid_; }
  [[nodiscard]] const mpm::MapCells& cells() const { return cells_; }
  [[nodiscard]] double arrival_thickness() const { return arrival_thickness_; }
  // The cell at a column and row of the map grid; a cell like new where the slide never was near.
  [[nodiscard]] const MapCell& cell(int column, int row) const;
  // Calls visit(column, row, cell) for every cell that the slide ever was in, south to north by tiles of the map.
  template <class Visit>
  void for_cells(const Visit& visit) const;

  // One map. Over the slide: the smallest raster with every cell it ever was in, empty if there is none.
  [[nodiscard]] Raster raster(const MapKind& kind, MapExtent extent) const;
  // Volume of all that is thicker than the arrival thickness now [m3].
  [[nodiscard]] double covered_volume() const;
  // The ground that the slide covers now, and that it ever covered, by the arrival thickness (sim/covered_area.hpp).
  [[nodiscard]] CoveredCells covered_cells() const;
  [[nodiscard]] CoveredCells affected_cells() const;

  // All that gathering goes on from, as numbers; and its way back.
  [[nodiscard]] std::vector<double> state() const;
  void restore(const std::vector<double>& numbers);

 private:
  static constexpr int edge_bits = 4;
  static constexpr int edge = 1 << edge_bits;  // cells of a map tile along each axis
  static constexpr auto tile_cells = static_cast<std::size_t>(edge) * edge;

  struct MapTile {
    int column = 0, row = 0;  // of its first cell
    bool active = false;
    std::array<mpm::ColumnSums, tile_cells> sums;
    std::array<mpm::BandSums, tile_cells> band;
    std::array<MapCell, tile_cells> cells;
  };
  // Tiles of the background grid above one another, and the map tiles that their particles may reach.
  struct Stack {
    std::uint32_t first, last;   // places_[first .. last-1]
    int tile_x, tile_y, across;  // the window of map tiles: its first one, its width
    int deep;                    // and its height
    std::size_t window;          // its first one in window_tiles_
  };
  // Where a tile of the background grid stands among the stacks.
  struct TilePlace {
    std::uint64_t colour, stack;
    std::uint32_t tile;
  };

  static std::uint64_t tile_key(int tile_x, int tile_y);
  static std::size_t place_in_tile(int column, int row);
  MapTile& touch(int tile_x, int tile_y);
  void find_stacks(const Grid& grid);
  void place_tiles(const Grid& grid);
  void set_window(const Grid& grid, Stack& stack);
  void note_active();
  void take_sums(double time);
  void add_stack(const Grid& grid, const Particles& particles, const Stack& stack);
  void add_segment(const SegmentBelow& segment);
  void add_box(const Particles& particles, std::size_t particle, const mpm::CellRange& x, const mpm::CellRange& y,
               const Stack& stack);
  [[nodiscard]] std::vector<const MapTile*> tiles_in_order() const;
  [[nodiscard]] CoveredCells cells_under(const MapKind& thickness) const;

  MapGrid map_grid_;
  mpm::MapCells cells_;
  mpm::BodySizes<double> sizes_;  // of particles [m]
  double arrival_thickness_;      // [m]
  DrawnArea drawn_;
  bool band_is_of_particles_ = true;
  KeyIndex tile_index_;
  std::vector<std::unique_ptr<MapTile>> tiles_;     // in the order in which the slide came
  std::vector<MapTile*> active_, formerly_active_;  // those that particles may reach
  std::vector<std::uint64_t> seen_;                 // keys of the background grid's tiles that all below is of
  std::vector<TilePlace> places_;                   // by colour, then by stack, then upwards
  std::vector<Stack> stacks_;
  std::vector<std::size_t> colours_;  // first stack of each, and the end; stacks of a colour share no map cell
  std::vector<MapTile*> window_tiles_;
};

template <class Visit>
void FlowMaps::for_cells(const Visit& visit) const {
  for (const MapTile* tile : tiles_in_order()) {
    for (std::size_t k = 0; k < tile_cells; ++k) {
      if (tile->cells[k].max_thickness > 0.0) {
        const int place = static_cast<int>(k);
        visit(tile->column + place % edge, tile->row + place / edge, tile->cells[k]);
      }
    }
  }
}

}  // namespace thawslide::sim
