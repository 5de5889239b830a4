// Nodes around a basal segment: those on the ground, of layer 0 of the grid, with the weights of cubic B-splines, which
// reach two cells along each horizontal axis. The segments above one block use the nodes of its patch.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/linear.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::band {

// Patch of a block on the ground: its nodes of layer 0, one more along each axis below and two above.
template <int Dim>
struct BasePatch {
  using T = mpm::Tile<Dim>;
  static constexpr int horizontal = Dim - 1, before = 1, edge = T::edge + before + 2;
  static constexpr auto nodes = static_cast<std::size_t>(mpm::power(edge, horizontal));
  static constexpr auto nodes_of_layer = static_cast<std::size_t>(T::rows);  // of a block: its first nodes

  // Calls visit(block, node, place) for each node of the patch of block b that is in an active block.
  template <class Visit>
  THAWSLIDE_ALWAYS_INLINE static void for_each_node(const mpm::SparseGrid<Dim>& grid, std::size_t b,
                                                    const Visit& visit) {
    const std::int32_t* about = grid.blocks_about_block(b);
    for (int direction = 0; direction < mpm::power(3, horizontal); ++direction) {
      if (const std::int32_t block = about[in_layer(direction)]; block != KeyIndex::absent) {
        for_each_shared(direction, [&](std::size_t node, std::size_t place) {
          visit(static_cast<std::size_t>(block), node, place);
        });
      }
    }
  }
  // Calls visit(block, node, place) for each node of block b that is in the patch of an active block.
  template <class Visit>
  THAWSLIDE_ALWAYS_INLINE static void for_each_patch(const mpm::SparseGrid<Dim>& grid, std::size_t b,
                                                     const Visit& visit) {
    const std::int32_t* about = grid.blocks_about_block(b);
    for (int direction = 0; direction < mpm::power(3, horizontal); ++direction) {
      if (const std::int32_t block = about[in_layer(direction)]; block != KeyIndex::absent) {
        for_each_shared(mpm::power(3, horizontal) - 1 - direction, [&](std::size_t node, std::size_t place) {
          visit(static_cast<std::size_t>(block), node, place);
        });
      }
    }
  }
  // Nodes of the patch of a block by place; without an active block, block is KeyIndex::absent.
  struct Node {
    std::int32_t block = KeyIndex::absent;
    std::size_t node = 0;
  };
  static std::array<Node, nodes> nodes_at(const mpm::SparseGrid<Dim>& grid, std::int32_t b) {
    std::array<Node, nodes> at;
    if (b != KeyIndex::absent) {
      for_each_node(grid, static_cast<std::size_t>(b), [&](std::size_t block, std::size_t node, std::size_t place) {
        at[place] = {static_cast<std::int32_t>(block), node};
      });
    }
    return at;
  }

 private:
  // Direction in the neighbourhood of a block, from one among the blocks on the ground.
  static std::size_t in_layer(int direction) { return static_cast<std::size_t>(direction + mpm::power(3, horizontal)); }
  // Calls visit(node, place) for the nodes that the patch shares with the block in a direction.
  template <class Visit>
  THAWSLIDE_ALWAYS_INLINE static void for_each_shared(int direction, const Visit& visit) {
    std::array<int, 2> first{}, last{1, 1}, shift{};
    for (std::size_t a = 0; a < horizontal; ++a, direction /= 3) {
      const int to = direction % 3 - 1;
      first[a] = to < 0 ? T::edge - before : 0;
      last[a] = to > 0 ? edge - before - T::edge : T::edge;
      shift[a] = to * T::edge + before;
    }
    for (int y = first[1]; y < last[1]; ++y) {
      for (int x = first[0]; x < last[0]; ++x) {
        visit(static_cast<std::size_t>(y * T::edge + x),
              static_cast<std::size_t>((y + shift[1]) * edge + x + shift[0]));
      }
    }
  }
};

template <int Dim>
class BaseStencil {
  using T = mpm::Tile<Dim>;
  static constexpr int width = 4;
  static constexpr std::size_t horizontal = Dim - 1;

 public:
  BaseStencil() = default;
  BaseStencil(const mpm::SparseGrid<Dim>& grid, const Vector<double, Dim>& position) : cell_(grid.cell()) {
    typename T::Index tile{};
    int step = 1;
    for (std::size_t a = 0; a < horizontal; ++a) {
      const double in_cells = position[static_cast<int>(a)] * grid.inverse_cell(), whole = std::floor(in_cells);
      const int node = static_cast<int>(whole);
      tile[a] = node >> T::edge_bits;  // rounds down
      lowest_ += step * (node - tile[a] * T::edge);
      step *= BasePatch<Dim>::edge;
      weight_[a] = cubic_weights(in_cells - whole);
      first_[a] = (whole - 1.0 - in_cells) * grid.cell();
    }
    block_ = grid.block_at(T::key(tile));
  }

  // Block below the segment, or KeyIndex::absent if no part of the sliding mass is near.
  [[nodiscard]] std::int32_t block() const { return block_; }

  // Calls visit(place, weight, from_segment) for the nodes in reach, by their place in the patch of the block.
  // from_segment: horizontal vector from the segment to the node [m].
  template <class Visit>
  THAWSLIDE_ALWAYS_INLINE void for_each_with_offset(const Visit& visit) const {
    Vector<double, Dim - 1> from_segment;
    for (int y = 0; y < (Dim == 3 ? width : 1); ++y) {
      double of_row = 1.0;
      if constexpr (Dim == 3) {
        of_row = weight_[1][static_cast<std::size_t>(y)];
        from_segment[1] = first_[1] + static_cast<double>(y) * cell_;
      }
      for (int x = 0; x < width; ++x) {
        from_segment[0] = first_[0] + static_cast<double>(x) * cell_;
        visit(static_cast<std::size_t>(lowest_ + y * BasePatch<Dim>::edge + x),
              of_row * weight_[0][static_cast<std::size_t>(x)], from_segment);
      }
    }
  }
  template <class Visit>
  THAWSLIDE_ALWAYS_INLINE void for_each(const Visit& visit) const {
    for_each_with_offset([&](std::size_t place, double weight, const Vector<double, Dim - 1>& /*from_segment*/)
                             THAWSLIDE_INLINE_LAMBDA { visit(place, weight); });
  }

 private:
  // Weights of the four nodes around a position at fraction t between the inner two.
  static std::array<double, width> cubic_weights(double t) {
    const double s = 1.0 - t, sixth = 1.0 / 6.0;
    return {sixth * s * s * s, sixth * (4.0 - 3.0 * t * t * (2.0 - t)), sixth * (4.0 - 3.0 * s * s * (2.0 - s)),
            sixth * t * t * t};
  }

  std::int32_t block_ = KeyIndex::absent;
  int lowest_ = 0;                          // place of the first node in the patch
  double cell_ = 0;                         // [m]
  std::array<double, horizontal> first_{};  // from the segment to the first node along each axis [m]
  std::array<std::array<double, width>, horizontal> weight_{};
};

}  // namespace thawslide::band
