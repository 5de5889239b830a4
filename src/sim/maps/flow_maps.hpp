// Maps of a 3D slide on a regular grid: thickness, speed and other fields, updated every step.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "band/segment_step.hpp"
#include "base/key_index.hpp"
#include "base/raster.hpp"
#include "mpm/body_sizes.hpp"
#include "mpm/map_sums.hpp"
#include "mpm/sparse_grid.hpp"
#include "sim/maps/covered_area.hpp"
#include "sim/maps/map_cell.hpp"
#include "sim/maps/map_grid.hpp"
#include "sim/maps/map_kinds.hpp"

namespace thawslide::sim {

enum class MapExtent { whole_grid, slide };

using band::SegmentBelow;

// Accumulates particle volume, mass and momentum in the cells below each box, weighted by the fraction of the box over
// each cell. The sum of thickness times cell area equals the particles' volume: a box that extends beyond the grid
// counts entirely to the cells at its edge. Sums are formed by stacks of the background grid's tiles, in an order
// defined by the tiles. Results therefore depend neither on threads nor on the particles' places in memory. Memory and
// work scale with the slide's extent.
class FlowMaps {
 public:
  using Grid = mpm::SparseGrid<3>;
  using Particles = mpm::Particles<3>;

  // origin: of the particles' positions [m]; half_sizes: of particles by body [m]; arrival_thickness: of the maps [m].
  // Particle centres must lie over the map grid. drawn: the releases; if unknown, the initially covered area follows
  // from the thickness there.
  FlowMaps(const MapGrid& map_grid, std::array<double, 2> origin, const std::vector<double>& half_sizes,
           double arrival_thickness, DrawnArea drawn = {});

  // Samples the particles at a time [s], with the tiles and the order of the step that moved them. segments: of the
  // base if the band consists of columns; they then supply heat and pressure in place of the particles.
  void gather(const Grid& grid, const Particles& particles, double time,
              const std::vector<SegmentBelow>* segments = nullptr);
  // The same from sums over cells by key (mpm::map_cell_key) computed on a device.
  void gather(const std::vector<std::uint64_t>& keys, const std::vector<mpm::MapSums>& sums, double time,
              const std::vector<SegmentBelow>* segments = nullptr);
  // Sets the reference state at t = 0 for changes of elevation.
  void start(const Grid& grid, const Particles& particles);

  // Empties the current maps when no slide is left; maxima remain.
  void slide_left();

  // Memory of all cells that the slide has approached, and of one cell.
  [[nodiscard]] std::size_t bytes() const { return tiles_.size() * sizeof(MapTile); }
  [[nodiscard]] static constexpr std::size_t bytes_of_cell() { return sizeof(MapTile) / tile_cells; }

  [[nodiscard]] const MapGrid& map_grid() const { return map_grid_; }
  [[nodiscard]] const mpm::MapCells& cells() const { return cells_; }
  [[nodiscard]] double arrival_thickness() const { return arrival_thickness_; }
  // Cell at a column and row of the map grid; an initial cell if the slide never approached it.
  [[nodiscard]] const MapCell& cell(int column, int row) const;
  // Calls visit(column, row, cell) for every cell that the slide ever covered, south to north by tiles of the map.
  template <class Visit>
  void for_cells(const Visit& visit) const;

  // One map. Extent over the slide: the smallest raster with every cell it ever covered, empty if there is none.
  [[nodiscard]] Raster raster(const MapKind& kind, MapExtent extent) const;
  // Current volume of all cells thicker than `least` [m]; [m3].
  [[nodiscard]] double covered_volume(double least) const;
  // Ground that the slide covers now, and that it ever covered, with more than `least` [m] (sim/maps/covered_area.hpp).
  [[nodiscard]] CoveredCells covered_cells(double least) const;
  [[nodiscard]] CoveredCells affected_cells(double least) const;

  // State for checkpoints, as numbers; restore() is its inverse.
  [[nodiscard]] std::vector<double> state() const;
  void restore(const std::vector<double>& numbers);

 private:
  static constexpr int edge_bits = 4;
  static constexpr int edge = 1 << edge_bits;  // cells of a map tile along each axis
  static constexpr auto tile_cells = static_cast<std::size_t>(edge) * edge;

  struct MapTile {
    int column = 0, row = 0;  // of the first cell
    bool active = false;
    std::array<mpm::ColumnSums, tile_cells> sums;
    std::array<mpm::BandSums, tile_cells> band;
    std::array<MapCell, tile_cells> cells;
  };
  // Vertical stack of tiles of the background grid, with the map tiles that its particles may reach.
  struct Stack {
    std::uint32_t first, last;   // places_[first .. last-1]
    int tile_x, tile_y, across;  // window of map tiles: first tile, width
    int deep;                    // height of the window
    std::size_t window;          // first tile of the window in window_tiles_
  };
  // Position of a tile of the background grid in the stacks.
  struct TileIndex {
    std::uint64_t colour, stack;
    std::uint32_t tile;
  };

  static std::uint64_t tile_key(int tile_x, int tile_y);
  static std::size_t index_in_tile(int column, int row);
  MapTile& touch(int tile_x, int tile_y);
  void find_stacks(const Grid& grid);
  void create_tiles(const Grid& grid);
  void set_window(const Grid& grid, Stack& stack);
  void mark_active();
  void update_cells(double time, const std::vector<SegmentBelow>* segments);
  void add_stack(const Grid& grid, const Particles& particles, const Stack& stack);
  void add_segment(const SegmentBelow& segment);
  void add_box(const Particles& particles, std::size_t particle, const mpm::CellRange& x, const mpm::CellRange& y,
               const Stack& stack);
  [[nodiscard]] std::vector<const MapTile*> tiles_in_order() const;
  [[nodiscard]] CoveredCells cells_under(const MapKind& thickness, double least) const;

  MapGrid map_grid_;
  mpm::MapCells cells_;
  mpm::BodySizes sizes_;      // of particles [m]
  double arrival_thickness_;  // [m]
  DrawnArea drawn_;
  bool band_is_of_particles_ = true;
  KeyIndex tile_index_;
  std::vector<std::unique_ptr<MapTile>> tiles_;     // in the order in which the slide reached them
  std::vector<MapTile*> active_, formerly_active_;  // within reach of particles
  std::vector<std::uint64_t> seen_;      // keys of the background grid's tiles for which the members below are valid
  std::vector<TileIndex> tile_indices_;  // by colour, then by stack, then upwards
  std::vector<Stack> stacks_;
  std::vector<std::size_t> colours_;  // first stack of each colour, and the end; stacks of a colour share no map cell
  std::vector<MapTile*> window_tiles_;
};

template <class Visit>
void FlowMaps::for_cells(const Visit& visit) const {
  for (const MapTile* tile : tiles_in_order()) {
    for (std::size_t k = 0; k < tile_cells; ++k) {
      if (tile->cells[k].max_thickness > 0.0) {
        const int index = static_cast<int>(k);
        visit(tile->column + index % edge, tile->row + index / edge, tile->cells[k]);
      }
    }
  }
}

}  // namespace thawslide::sim
