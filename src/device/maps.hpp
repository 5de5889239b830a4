// Sums for maps (sim/maps/flow_maps.hpp), in device memory. After a change of tiles, the map cells below them are
// renumbered by sorting their keys.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "device/body_sizes.hpp"
#include "device/map_kernels.hpp"
#include "device/step_model.hpp"
#include "exec/keyed_parts.hpp"

namespace thawslide::device {

template <class Backend>
class Maps {
 public:
  // cell: mesh size [m]. half_sizes: of particles, by body, in cells.
  Maps(Backend& backend, double cell, const std::vector<double>& half_sizes)
      : backend_(backend), cell_(cell), sizes_(backend, half_sizes, cell) {}

  // Call after tiles have changed.
  void forget_tiles() { knows_tiles_ = false; }

  // Sums over particles at their positions after a step, with the tiles from its beginning.
  void sum(const mpm::MapCells& cells, const TileTables<3>& tables, const mpm::ParticleView<3>& particles,
           MapSample& sample) {
    if (!knows_tiles_ || !(cells == layout_.cells)) {
      number_cells(cells, tables);
      known_keys_ = parts_.keys().get();
      if (!known_keys_.empty() && known_keys_.back() == TileMapLayout::no_cell) {
        known_keys_.pop_back();
      }
      knows_tiles_ = true;
    }
    sample.keys = known_keys_;
    using InTile = SumMapInTile;
    backend_.for_groups(tables.tiles, InTile::at_a_time, InTile::bytes,
                        InTile{layout_, tables, particles, sizes_.view(), parts_.parts()});
    parts_.sum();
    sample.sums.resize(sample.keys.size());
    backend_.copy_out(sample.sums.data(), parts_.sums(), sample.sums.size());
  }

 private:
  void number_cells(const mpm::MapCells& cells, const TileTables<3>& tables) {
    const auto places_along = [&](double inverse_cell) {
      const double width = static_cast<double>(cell_) * (mpm::Tile<3>::edge + 2.0) + 2.0 * cells.largest_half;
      return static_cast<std::size_t>(std::ceil(width * inverse_cell)) + 1;
    };
    layout_ = {cells, static_cast<double>(cell_), places_along(cells.inverse_cell_x),
               places_along(cells.inverse_cell_y)};
    parts_.list(tables.tiles * layout_.of_tile(), KeyOfMapCell{layout_, tables.tile_keys});
  }

  Backend& backend_;
  double cell_;
  BodySizes<Backend> sizes_;  // half sizes of particles [m]
  TileMapLayout layout_;
  bool knows_tiles_ = false;
  std::vector<std::uint64_t> known_keys_;  // of cells below at least one tile
  exec::KeyedParts<mpm::MapSums, Backend> parts_{backend_};
};

}  // namespace thawslide::device
