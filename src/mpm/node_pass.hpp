// One visit to all nodes: a block's sums of what particles added come first, then a function of each node's numbers.
#pragma once

#include "mpm/nodes.hpp"

namespace thawslide::mpm {

// The sums of a block's records, of what the particles of the tiles added that takes(t) names; for a name that is
// lowered the smallest numbers, after the sums of its record.
template <class Name, int Dim, class Real, class Takes>
void sum_block(const SparseGrid<Dim, Real>& grid, std::size_t block, Nodes<Dim, Real>& nodes, const Takes& takes) {
  auto& records = nodes.template of<Name>();
  const auto patches = records.patches(grid.tiles().size());
  if constexpr (IsLowered<Name>) {
    unrolled<part_of<Name, Dim>.count>([&](auto c) {
      take_smallest_in_block<part_of<Name, Dim>.from + c>(grid, block, patches, records.of_block(block), takes);
    });
  } else {
    sum_patches_in_block(grid, block, patches, records.of_block(block), takes);
  }
}
template <class Name, int Dim, class Real>
void sum_block(const SparseGrid<Dim, Real>& grid, std::size_t block, Nodes<Dim, Real>& nodes) {
  sum_block<Name>(grid, block, nodes, every_tile);
}

// Calls begin(block) and then of_node(node, account) for the nodes of each block; returns the sum of the accounts.
template <class Account, int Dim, class Real, class Begin, class OfNode>
Account node_pass(const SparseGrid<Dim, Real>& grid, const Begin& begin, const OfNode& of_node) {
  return parallel_sum<Account>(grid.blocks().size(), [&](std::size_t b, Account& account) {
    begin(b);
    for (std::size_t k = 0; k < static_cast<std::size_t>(Tile<Dim>::nodes); ++k) {
      of_node(NodeAt{b, k}, account);
    }
  });
}

}  // namespace thawslide::mpm
