// Pass over all nodes: sums of particle contributions per block, then a function of each node.
#pragma once

#include "mpm/nodes.hpp"

namespace thawslide::mpm {

// Sums particle contributions to a block's records, from the tiles for which accepts(t) is true. Returns the rows of
// the block in which particles have nodes, one bit per row. Records of other rows are undefined.
template <class Name, int Dim, class TileFilter>
std::uint32_t sum_block(const SparseGrid<Dim>& grid, std::size_t block, Nodes<Dim>& nodes, const TileFilter& accepts) {
  auto& records = nodes.template of<Name>();
  return sum_patches_in_block(grid, block, records.patches(grid.tiles().size()), records.of_block(block), accepts);
}
template <class Name, int Dim>
std::uint32_t sum_block(const SparseGrid<Dim>& grid, std::size_t block, Nodes<Dim>& nodes) {
  return sum_block<Name>(grid, block, nodes, every_tile);
}
// The same for min-reduced names. Call after summing the record of their owner.
template <IsMinReduced Name, int Dim, class TileFilter>
void sum_block(const SparseGrid<Dim>& grid, std::size_t block, Nodes<Dim>& nodes, const TileFilter& accepts) {
  auto& records = nodes.template of<Name>();
  unrolled<part_of<Name, Dim>.count>([&](auto c) {
    reduce_min_in_block<part_of<Name, Dim>.from + c>(grid, block, records.patches(grid.tiles().size()),
                                                     records.of_block(block), accepts);
  });
}

// For each block, calls begin(block), which returns the rows of nodes to visit, one bit per row, and then of_node(node,
// totals) for their nodes. Returns the sum of the totals.
template <class Totals, int Dim, class Begin, class OfNode>
Totals node_pass(const SparseGrid<Dim>& grid, const Begin& begin, const OfNode& of_node) {
  constexpr std::size_t edge = static_cast<std::size_t>(Tile<Dim>::edge);
  return parallel_sum<Totals>(grid.blocks().size(), [&](std::size_t b, Totals& totals) {
    for (std::uint32_t rows = begin(b); rows != 0; rows &= rows - 1) {
      const std::size_t first = static_cast<std::size_t>(std::countr_zero(rows)) * edge;
      for (std::size_t k = first; k < first + edge; ++k) {
        of_node(NodeAt{b, k}, totals);
      }
    }
  });
}

}  // namespace thawslide::mpm
