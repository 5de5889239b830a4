// Stacks of blocks above each other, and their columns of nodes, for quantities that depend on the horizontal position
// only.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "base/portability.hpp"
#include "device/tile_tables.hpp"

namespace thawslide::device {

// Indices of a column's nodes along the horizontal axes.
template <int Dim>
using ColumnIndex = std::array<int, Dim - 1>;

template <int Dim>
inline constexpr std::size_t columns_of_block = static_cast<std::size_t>(mpm::power(mpm::Tile<Dim>::edge, Dim - 1));

// Column of a node of a block.
template <int Dim>
ColumnIndex<Dim> column_of_node(std::uint64_t block, std::size_t node) {
  using T = mpm::Tile<Dim>;
  const typename T::Index index = T::node(T::index(block), static_cast<int>(node));
  ColumnIndex<Dim> column{};
  std::copy_n(index.begin(), column.size(), column.begin());
  return column;
}

template <int Dim>
struct Stacks {
  std::vector<std::uint32_t> of_block;    // stack of each block
  std::vector<ColumnIndex<Dim>> columns;  // stack by stack, x fastest

  explicit Stacks(const std::vector<std::uint64_t>& blocks) {
    std::map<ColumnIndex<Dim>, std::uint32_t> numbers;  // by the first column
    for (const std::uint64_t key : blocks) {
      const auto [found, is_new] =
          numbers.try_emplace(column_of_node<Dim>(key, 0), static_cast<std::uint32_t>(numbers.size()));
      of_block.push_back(found->second);
      for (std::size_t k = 0; is_new && k < columns_of_block<Dim>; ++k) {
        columns.push_back(column_of_node<Dim>(key, k));  // nodes of the lowest layer come first
      }
    }
  }
};

// Place of a column among those of all stacks. column: relative to the first column of a tile, -1 .. edge.
template <int Dim>
THAWSLIDE_HD std::size_t index_of_column(const TileTables<Dim>& tables, const std::uint32_t* stack_of_block,
                                         std::size_t tile, const ColumnIndex<Dim>& column) {
  using T = mpm::Tile<Dim>;
  int direction = T::stencil / 2, in_stack = 0;
  for (std::size_t a = Dim - 1; a-- > 0;) {
    const int adjacent = column[a] >> T::edge_bits;  // rounds down
    direction += adjacent * mpm::power(3, static_cast<int>(a));
    in_stack = in_stack * T::edge + (column[a] - adjacent * T::edge);
  }
  const std::int32_t block =
      tables.blocks_about_tile[tile * static_cast<std::size_t>(T::stencil) + static_cast<std::size_t>(direction)];
  return stack_of_block[static_cast<std::size_t>(block)] * columns_of_block<Dim> + static_cast<std::size_t>(in_stack);
}

}  // namespace thawslide::device
