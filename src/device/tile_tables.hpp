// Tables of tiles and blocks (mpm/sparse_grid.hpp) in device memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/portability.hpp"
#include "exec/key_lists.hpp"
#include "mpm/tile.hpp"

namespace thawslide::device {

using exec::absent;

template <int Dim>
struct TileTables {
  std::size_t particles, tiles, blocks;
  // By rank in canonical order: the particle, and its key, which combines the tile's key with the place of its nearest
  // node in the tile.
  const std::uint32_t* order;
  const std::uint64_t* keys;
  const std::uint64_t* tile_keys;   // ascending
  const std::uint64_t* block_keys;  // ascending
  // By tile and node of the tile: rank in canonical order of the first particle in that cell or after it. One extra
  // entry at the end.
  const std::uint32_t* first_of_cell;
  // By 3^Dim neighbours, in order; absent if there is none.
  const std::int32_t *blocks_about_tile, *tiles_about_block, *blocks_about_block;
};

// Location of a patch node: direction of its block from the tile, and place within the block.
template <int Dim>
struct NodeInBlock {
  std::size_t direction, node;
};
template <int Dim>
THAWSLIDE_HD NodeInBlock<Dim> node_in_block(std::size_t in_patch) {
  using T = mpm::Tile<Dim>;
  NodeInBlock<Dim> found{0, 0};
  std::size_t neighbours = 1, nodes = 1;
  for (int a = 0; a < Dim; ++a) {
    const int along = static_cast<int>(in_patch % T::patch_edge) - 1;  // -1 .. edge
    in_patch /= T::patch_edge;
    const int tile = along >> T::edge_bits;  // rounds down
    found.direction += static_cast<std::size_t>(tile + 1) * neighbours;
    found.node += static_cast<std::size_t>(along - tile * T::edge) * nodes;
    neighbours *= 3;
    nodes *= T::edge;
  }
  return found;
}

// Index of a block's node in the patch of the tile in a direction. The patch must contain the node.
template <int Dim>
THAWSLIDE_HD std::size_t index_in_patch(std::size_t in_block, std::size_t direction) {
  using T = mpm::Tile<Dim>;
  std::size_t index = 0, nodes = 1;
  for (int a = 0; a < Dim; ++a) {
    const int tile = static_cast<int>(direction % 3) - 1;
    const int along = static_cast<int>(in_block % T::edge) - tile * T::edge + 1;
    direction /= 3;
    in_block /= T::edge;
    index += static_cast<std::size_t>(along) * nodes;
    nodes *= T::patch_edge;
  }
  return index;
}

// Index, in the tile's patch, of the lowest of the nodes around a node of the tile.
template <int Dim>
THAWSLIDE_HD std::size_t lowest_about(std::size_t node) {
  using T = mpm::Tile<Dim>;
  typename T::Index lowest = T::node({}, static_cast<int>(node));
  for (int a = 0; a < Dim; ++a) {
    --lowest[static_cast<std::size_t>(a)];
  }
  return static_cast<std::size_t>(T::in_patch(lowest));
}

}  // namespace thawslide::device
