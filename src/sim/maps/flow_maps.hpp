// Maps of a 3D slide on a regular grid: thickness, speed and other fields, updated every step.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "band/map_stage.hpp"
#include "base/key_index.hpp"
#include "base/raster.hpp"
#include "mpm/map_sums.hpp"
#include "sim/maps/covered_area.hpp"
#include "sim/maps/map_cell.hpp"
#include "sim/maps/map_grid.hpp"
#include "sim/maps/map_kinds.hpp"

namespace thawslide::sim {

enum class MapExtent { whole_grid, slide };

// Accumulates particle volume, mass and momentum in the cells below each box, weighted by the fraction of the box over
// each cell. The sum of thickness times cell area equals the particles' volume: a box that extends beyond the grid
// counts entirely to the cells at its edge (band/map_stage.hpp). Memory and work scale with the slide's extent.
class FlowMaps {
 public:
  // origin: of the particles' positions [m]; half_sizes: of particles by body [m]; arrival_thickness: of the maps [m].
  // Particle centres must lie over the map grid. drawn: the releases; if unknown, the initially covered area follows
  // from the thickness there.
  FlowMaps(const MapGrid& map_grid, std::array<double, 2> origin, const std::vector<double>& half_sizes,
           double arrival_thickness, DrawnArea drawn = {});

  // Records the sums over cells() after a step that ended at a time [s].
  void gather(const band::MapSample& sample, double time);
  // The same at t = 0, the reference state for changes of elevation.
  void start(const band::MapSample& sample);

  // Empties the current maps when no slide is left; maxima remain.
  void slide_left();

  // Memory of all cells that the slide has approached, and of one cell, with its sums in the solver, in the sample and
  // here.
  [[nodiscard]] std::size_t bytes() const { return tiles_.size() * tile_cells * bytes_of_cell(); }
  [[nodiscard]] static constexpr std::size_t bytes_of_cell() {
    return sizeof(MapTile) / tile_cells + 3 * sizeof(mpm::MapSums);
  }

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
    int column = 0, row = 0;                      // of the first cell
    std::array<std::int32_t, tile_cells> number;  // of the cell in the sample; absent if particles do not reach it
    std::array<MapCell, tile_cells> cells;

    MapTile() { number.fill(KeyIndex::absent); }
  };
  struct CellPlace {
    MapTile* tile;
    std::size_t index;

    [[nodiscard]] MapCell& cell() const { return tile->cells[index]; }
    [[nodiscard]] std::int32_t& number() const { return tile->number[index]; }
  };

  static std::size_t index_in_tile(int column, int row);
  [[nodiscard]] CellPlace place_of(int column, int row);
  [[nodiscard]] MapTile* tile_at(int column, int row) const;  // null if the slide never approached it
  void number_cells(const std::vector<std::uint64_t>& keys);
  void add_segment(const band::SegmentBelow& segment);
  [[nodiscard]] std::vector<const MapTile*> tiles_in_order() const;
  [[nodiscard]] CoveredCells cells_under(const MapKind& thickness, double least) const;

  MapGrid map_grid_;
  mpm::MapCells cells_;
  double arrival_thickness_;  // [m]
  DrawnArea drawn_;
  KeyIndex tile_index_;
  std::vector<std::unique_ptr<MapTile>> tiles_;  // in the order in which the slide reached them
  std::vector<std::uint64_t> keys_;              // of the last sample
  std::vector<CellPlace> reached_;               // by key; after a restart, the cells that were not empty
  std::vector<mpm::MapSums> sums_;               // by key, with those of band columns
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
