// Places of nodes in patches and blocks.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/portability.hpp"
#include "exec/key_lists.hpp"
#include "mpm/tile_tables.hpp"

namespace thawslide::device {

using exec::absent;
using mpm::TileTables;

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
