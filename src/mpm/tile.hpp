// Tiles: squares (2D) or cubes (3D) of 4 nodes per side. Each occupied tile has a patch, one node wider on each side,
// to which only its particles add. Patches are summed in a fixed order; results are therefore independent of the thread
// count.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/portability.hpp"

namespace thawslide::mpm {

THAWSLIDE_HD constexpr int power(int base, int exponent) {
  return exponent == 0 ? 1 : base * power(base, exponent - 1);
}

template <int Dim>
struct Tile {
  static constexpr int edge_bits = 2;
  static constexpr int edge = 1 << edge_bits;
  static constexpr int node_bits = Dim * edge_bits;  // of a node's place in its tile
  static constexpr int nodes = power(edge, Dim);
  static constexpr int rows = power(edge, Dim - 1);  // along the first axis
  static constexpr std::uint32_t all_rows = (std::uint32_t{1} << rows) - 1;
  static constexpr int patch_edge = edge + 2;
  static constexpr int patch_nodes = power(patch_edge, Dim);
  static constexpr int patch_rows = power(patch_edge, Dim - 1);
  static constexpr int stencil = power(3, Dim);  // nodes of a particle; also tiles in the neighbourhood of one

  using Index = std::array<int, Dim>;

  // Tiles have up to 2^18 indices per axis, offset so that indices down to -2^17 are valid.
  static constexpr int axis_bits = 18;
  static constexpr int axis_offset = 1 << (axis_bits - 1);

  // Bodies that do not share nodes have separate tiles at the same place. Their keys differ in the layer, above the
  // bits of the axes. One layer less than the bits allow, so that no key has all bits set.
  static constexpr int layer_shift = Dim * axis_bits;
  static constexpr std::size_t most_layers = 15;
  THAWSLIDE_HD static std::uint64_t layer(std::uint64_t key) { return key >> layer_shift; }
  THAWSLIDE_HD static std::uint64_t in_layer(std::uint64_t tile_key, std::uint64_t layer) {
    return tile_key | layer << layer_shift;
  }
  THAWSLIDE_HD static std::uint64_t without_layer(std::uint64_t key) {
    return key & ((std::uint64_t{1} << layer_shift) - 1);
  }

  THAWSLIDE_HD static std::uint64_t key(const Index& tile) {
    std::uint64_t packed = 0;
    for (int a = Dim - 1; a >= 0; --a) {
      packed = (packed << axis_bits) | static_cast<std::uint64_t>(tile[static_cast<std::size_t>(a)] + axis_offset);
    }
    return packed;
  }
  THAWSLIDE_HD static Index index(std::uint64_t key) {
    Index tile{};
    for (int a = 0; a < Dim; ++a) {
      tile[static_cast<std::size_t>(a)] =
          static_cast<int>((key >> (a * axis_bits)) & ((1u << axis_bits) - 1)) - axis_offset;
    }
    return tile;
  }

  // Splits a node index into its tile and its place in the tile.
  THAWSLIDE_HD static void split(const Index& node, Index& tile, int& local) {
    local = 0;
    for (int a = Dim - 1; a >= 0; --a) {
      const int i = node[static_cast<std::size_t>(a)];
      tile[static_cast<std::size_t>(a)] = i >> edge_bits;  // rounds down
      local = local * edge + (i & (edge - 1));
    }
  }
  // Node `shift` nodes further along an axis from a local node of a tile, |shift| < edge: direction of its tile from
  // this one, and place in that tile.
  struct Adjacent {
    int direction, local;
  };
  THAWSLIDE_HD static Adjacent adjacent(int local, int axis, int shift) {
    const int along = ((local >> (axis * edge_bits)) & (edge - 1)) + shift;
    const int tile = along >> edge_bits;  // rounds down
    return {stencil / 2 + tile * power(3, axis), local + (shift - tile * edge) * power(edge, axis)};
  }
  // Index of the local node of a tile.
  THAWSLIDE_HD static Index node(const Index& tile, int local) {
    Index n{};
    for (int a = 0; a < Dim; ++a) {
      n[static_cast<std::size_t>(a)] = tile[static_cast<std::size_t>(a)] * edge + local % edge;
      local /= edge;
    }
    return n;
  }
  // Rows of a patch along the first axis that contain the nodes of a particle, one bit per row. lowest: place of its
  // lowest node in the patch.
  static_assert(patch_rows <= 64);
  static constexpr std::uint64_t rows_from(std::int32_t lowest) {
    constexpr std::uint64_t three = 7;
    constexpr std::uint64_t seen = Dim == 3 ? three | three << patch_edge | three << 2 * patch_edge : three;
    return seen << lowest / patch_edge;
  }
  // Place in the patch of a node given relative to the tile's first node, each component in [-1, edge].
  THAWSLIDE_HD static int in_patch(const Index& relative) {
    int index = 0;
    for (int a = Dim - 1; a >= 0; --a) {
      index = index * patch_edge + relative[static_cast<std::size_t>(a)] + 1;
    }
    return index;
  }
};

// Node indices along each axis of the sides of the domain that prescribe velocity.
template <int Dim>
struct PrescribedSides {
  static constexpr int none = std::numeric_limits<int>::min();
  std::array<int, Dim> lower, upper;

  PrescribedSides() {
    lower.fill(none);
    upper.fill(none);
  }
};

}  // namespace thawslide::mpm
