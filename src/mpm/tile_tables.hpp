// Tables of tiles and blocks (mpm/sparse_grid.hpp, device/cells.hpp) for kernels. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mpm/tile.hpp"

namespace thawslide::mpm {

template <int Dim>
struct TileTables {
  std::size_t particles, tiles, blocks;
  // By rank in canonical order: the particle, and its key, which combines the tile's key with the place of its nearest
  // node in the tile.
  const std::uint32_t* order;
  const std::uint64_t* keys;        // null on the CPU
  const std::uint64_t* tile_keys;   // ascending
  const std::uint64_t* block_keys;  // ascending
  // By tile and node of the tile: rank in canonical order of the first particle in that cell or after it. One extra
  // entry at the end.
  const std::uint32_t* first_of_cell;
  // By 3^Dim neighbours, in order; absent if there is none.
  const std::int32_t *blocks_about_tile, *tiles_about_block, *blocks_about_block;
};

// The part about blocks alone.
template <int Dim>
struct BlockTables {
  std::size_t blocks;
  const std::uint64_t* block_keys;         // ascending
  const std::int32_t* blocks_about_block;  // as in TileTables
};

}  // namespace thawslide::mpm
