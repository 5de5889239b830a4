// Nodes around a basal segment: those on the ground, of layer 0 of the grid, with the weights of cubic B-splines, which
// reach two cells along each horizontal axis. The segments above one block use the nodes of its patch. For host and
// device.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/linear.hpp"
#include "exec/key_lists.hpp"
#include "mpm/tile_tables.hpp"

namespace thawslide::band {

// Patch of a block on the ground: its nodes of layer 0, one more along each axis below and two above.
template <int Dim>
struct BasePatch {
  using T = mpm::Tile<Dim>;
  static constexpr int horizontal = Dim - 1, before = 1, edge = T::edge + before + 2;
  static constexpr auto rows = static_cast<std::size_t>(mpm::power(edge, horizontal - 1));
  static constexpr auto nodes = rows * edge;
  static constexpr auto nodes_of_layer = static_cast<std::size_t>(T::rows);  // of a block: its first nodes
  static constexpr int directions = mpm::power(3, horizontal);               // of blocks on the ground around a block

  // Number of the block in a direction from block b, or exec::absent.
  THAWSLIDE_HD static std::int32_t block_about(const mpm::BlockTables<Dim>& tables, std::size_t b, int direction) {
    return tables.blocks_about_block[b * static_cast<std::size_t>(T::stencil) +
                                     static_cast<std::size_t>(direction + directions)];
  }
  // Node at a place of the patch of block b; without an active block, block is exec::absent.
  struct Node {
    std::int32_t block;
    std::size_t node;

    // Its number among the nodes of layer 0 of all blocks.
    [[nodiscard]] THAWSLIDE_HD std::size_t number() const {
      return static_cast<std::size_t>(block) * nodes_of_layer + node;
    }
  };
  THAWSLIDE_HD static Node node_at(const mpm::BlockTables<Dim>& tables, std::size_t b, int place) {
    int direction = 0, node = 0;
    for (int a = 0, neighbours = 1, size = 1; a < horizontal; ++a, neighbours *= 3, size *= T::edge) {
      const int along = place % edge - before;
      const int tile = along >> T::edge_bits;  // rounds down
      place /= edge;
      direction += (tile + 1) * neighbours;
      node += (along - tile * T::edge) * size;
    }
    return {block_about(tables, b, direction), static_cast<std::size_t>(node)};
  }
  // Place of a node of layer 0 in the patch of the block in a direction, or exec::absent if it is outside.
  THAWSLIDE_HD static std::int32_t place_in(int direction, std::size_t node) {
    int place = 0, from = static_cast<int>(node);
    for (int a = 0, size = 1; a < horizontal; ++a, size *= edge, direction /= 3, from /= T::edge) {
      const int along = from % T::edge - (direction % 3 - 1) * T::edge + before;
      if (along < 0 || along >= edge) {
        return exec::absent;
      }
      place += along * size;
    }
    return place;
  }
};

template <int Dim>
class BaseStencil {
  using T = mpm::Tile<Dim>;
  static constexpr int width = 4;
  static constexpr std::size_t horizontal = Dim - 1;

 public:
  BaseStencil() = default;
  THAWSLIDE_HD BaseStencil(const mpm::BlockTables<Dim>& tables, double cell, const Vector<double, Dim>& position)
      : cell_(cell) {
    typename T::Index tile{};
    for (std::size_t a = 0; a < horizontal; ++a) {
      const double in_cells = position[static_cast<int>(a)] * (1.0 / cell), whole = std::floor(in_cells);
      const int node = static_cast<int>(whole);
      tile[a] = node >> T::edge_bits;  // rounds down
      lowest_[a] = node - tile[a] * T::edge;
      set_cubic_weights(in_cells - whole, weight_[a]);
      first_[a] = (whole - 1.0 - in_cells) * cell;
    }
    block_ = exec::index_of_key(tables.block_keys, tables.blocks, T::key(tile));
  }

  // Block below the segment, or exec::absent if no part of the sliding mass is near.
  [[nodiscard]] THAWSLIDE_HD std::int32_t block() const { return block_; }

  // Calls visit(place, weight, from_segment) for the nodes in reach, by their place in the patch of the block.
  // from_segment: horizontal vector from the segment to the node [m].
  template <class Visit>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void for_each_with_offset(const Visit& visit) const {
    Vector<double, Dim - 1> from_segment;
    for (int y = 0; y < (Dim == 3 ? width : 1); ++y) {
      if constexpr (Dim == 3) {
        from_segment[1] = first_[1] + static_cast<double>(y) * cell_;
      }
      const int row = Dim == 3 ? lowest_[horizontal - 1] + y : 0;
      const double of_row = weight_of_row(row);
      for (int x = 0; x < width; ++x) {
        from_segment[0] = first_[0] + static_cast<double>(x) * cell_;
        visit(row * BasePatch<Dim>::edge + lowest_[0] + x, of_row * weight_[0][x], from_segment);
      }
    }
  }
  // Calls visit(node, weight) for the nodes in reach that are in an active block (BasePatch::Node).
  template <class Visit>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void for_each_node(const mpm::BlockTables<Dim>& tables,
                                                          const Visit& visit) const {
    if (block_ == exec::absent) {
      return;
    }
    for_each_with_offset(
        [&](int place, double weight, const Vector<double, Dim - 1>& /*from_segment*/) THAWSLIDE_INLINE_LAMBDA {
          const auto node = BasePatch<Dim>::node_at(tables, static_cast<std::size_t>(block_), place);
          if (node.block != exec::absent) {
            visit(node, weight);
          }
        });
  }
  // Calls visit(x, weight) for the nodes in reach in one row of the patch.
  template <class Visit>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void for_each_in_row(int row, const Visit& visit) const {
    const double of_row = weight_of_row(row);
    for (int x = 0; of_row != 0.0 && x < width; ++x) {
      visit(lowest_[0] + x, of_row * weight_[0][x]);
    }
  }

 private:
  [[nodiscard]] THAWSLIDE_HD double weight_of_row(int row) const {
    const int y = Dim == 3 ? row - lowest_[horizontal - 1] : 0;
    return Dim == 2 ? 1.0 : y < 0 || y >= width ? 0.0 : weight_[horizontal - 1][y];
  }
  // Weights of the four nodes around a position at fraction t between the inner two.
  THAWSLIDE_HD static void set_cubic_weights(double t, double* weight) {
    const double s = 1.0 - t, sixth = 1.0 / 6.0;
    weight[0] = sixth * s * s * s;
    weight[1] = sixth * (4.0 - 3.0 * t * t * (2.0 - t));
    weight[2] = sixth * (4.0 - 3.0 * s * s * (2.0 - s));
    weight[3] = sixth * t * t * t;
  }

  std::int32_t block_ = exec::absent;
  int lowest_[horizontal] = {};    // along each axis of the patch: the first node in reach
  double cell_ = 0;                // [m]
  double first_[horizontal] = {};  // from the segment to the first node along each axis [m]
  double weight_[horizontal][width] = {};
};

}  // namespace thawslide::band
