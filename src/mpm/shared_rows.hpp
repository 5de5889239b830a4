// Nodes that the patch of a tile shares with the surrounding blocks, by rows along the first axis. The particles of a
// tile have nodes in few rows of its patch; only these rows are cleared, summed, read and visited.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/select.hpp"
#include "mpm/tile.hpp"

namespace thawslide::mpm {

// Calls body(d) for the directions d = 0 .. 3^Dim-1 of a neighbourhood, each a constant.
template <int Dim, class Body>
THAWSLIDE_ALWAYS_INLINE void for_each_direction(const Body& body) {
  unrolled<static_cast<std::size_t>(Tile<Dim>::stencil)>(body);
}

// Opposite direction: from a tile in direction d of a block, the block is in this direction.
template <int Dim>
constexpr std::size_t opposite(std::size_t direction) {
  return static_cast<std::size_t>(Tile<Dim>::stencil) - 1 - direction;
}

// Nodes that a patch shares with the block in a direction from its tile: first and last in the block along each axis,
// and place in the patch of the block's node 0.
struct SharedNodeBox {
  std::array<int, 3> first{}, last{1, 1, 1}, shift{};
};

template <int Dim>
constexpr SharedNodeBox shared_node_box(std::size_t direction) {
  constexpr int edge = Tile<Dim>::edge;
  SharedNodeBox box;
  for (std::size_t a = 0; a < Dim; ++a) {
    const int d = static_cast<int>(direction % 3) - 1;
    direction /= 3;
    box.first[a] = d < 0 ? edge - 1 : 0;
    box.last[a] = d > 0 ? 1 : edge;
    box.shift[a] = d * edge + 1;
  }
  return box;
}

// Calls visit(block_place, patch_place, count) for each row of nodes shared by block and patch.
template <int Dim, std::size_t Direction, class Visit>
THAWSLIDE_ALWAYS_INLINE void for_shared_rows(const Visit& visit) {
  using T = Tile<Dim>;
  constexpr SharedNodeBox box = shared_node_box<Dim>(Direction);
  for (int k = box.first[2]; k < box.last[2]; ++k) {
    for (int j = box.first[1]; j < box.last[1]; ++j) {
      visit(static_cast<std::size_t>((k * T::edge + j) * T::edge + box.first[0]),
            static_cast<std::size_t>(((k + box.shift[2]) * T::patch_edge + j + box.shift[1]) * T::patch_edge +
                                     box.first[0] + box.shift[0]),
            static_cast<std::size_t>(box.last[0] - box.first[0]));
    }
  }
}

// True if the row of a node of the patch is among `rows`, one bit per row (Tile::rows_from).
template <int Dim>
constexpr bool contains_row(std::uint64_t rows, std::size_t in_patch) {
  return (rows >> in_patch / static_cast<std::size_t>(Tile<Dim>::patch_edge) & 1) != 0;
}

// Rows of a patch that it shares with the block in a direction.
template <int Dim, std::size_t Direction>
constexpr std::uint64_t shared_rows() {
  std::uint64_t rows = 0;
  for_shared_rows<Dim, Direction>([&](std::size_t /*in_block*/, std::size_t in_patch, std::size_t /*count*/) {
    rows |= std::uint64_t{1} << in_patch / static_cast<std::size_t>(Tile<Dim>::patch_edge);
  });
  return rows;
}

// Same as for_shared_rows, but only for rows among `rows`.
template <int Dim, std::size_t Direction, class Visit>
THAWSLIDE_ALWAYS_INLINE void for_seen_rows(std::uint64_t rows, const Visit& visit) {
  if ((rows & shared_rows<Dim, Direction>()) == 0) {
    return;
  }
  for_shared_rows<Dim, Direction>([&](std::size_t in_block, std::size_t in_patch, std::size_t count)
                                      THAWSLIDE_INLINE_LAMBDA {
                                        if (contains_row<Dim>(rows, in_patch)) {
                                          visit(in_block, in_patch, count);
                                        }
                                      });
}

// Calls visit(block_place, patch_place) for each node shared by block and patch, restricted to `rows` if specified.
template <int Dim, std::size_t Direction, class Visit>
THAWSLIDE_ALWAYS_INLINE void for_shared_nodes(const Visit& visit, std::uint64_t rows = ~std::uint64_t{0}) {
  for_seen_rows<Dim, Direction>(rows, [&](std::size_t in_block, std::size_t in_patch, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      visit(in_block + i, in_patch + i);
    }
  });
}

// Rows of a block that share nodes with these rows of a patch, one bit per row. The patch lies in this direction from
// the block.
template <int Dim, std::size_t Direction>
THAWSLIDE_ALWAYS_INLINE std::uint32_t rows_in_block(std::uint64_t rows_of_patch) {
  std::uint32_t rows = 0;
  for_seen_rows<Dim, opposite<Dim>(Direction)>(
      rows_of_patch, [&](std::size_t in_block, std::size_t /*in_patch*/, std::size_t /*count*/)
                         THAWSLIDE_INLINE_LAMBDA { rows |= std::uint32_t{1} << in_block / Tile<Dim>::edge; });
  return rows;
}

}  // namespace thawslide::mpm
