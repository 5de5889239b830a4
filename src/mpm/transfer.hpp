// Moving numbers between particles and nodes: what a tile's particles add to, its patch; what nodes hold; what a tile's
// particles read. A record is the `Components` numbers a node holds for one purpose, side by side.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <tuple>

#include "base/aligned.hpp"
#include "base/parallel.hpp"
#include "mpm/shape.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::mpm {

// The records about one tile, with a margin of one node.
template <int Dim, class Real, int Components>
struct Patch {
  using Record = std::array<Real, static_cast<std::size_t>(Components)>;
  alignas(cache_line) std::array<Record, static_cast<std::size_t>(Tile<Dim>::patch_nodes)> records;

  void clear() { records.fill(Record{}); }
};

// One record a node of every active block, and the patches that are summed into it.
template <int Dim, class Real, int Components>
class NodeRecords {
 public:
  using Record = std::array<Real, static_cast<std::size_t>(Components)>;
  static constexpr std::size_t nodes = static_cast<std::size_t>(Tile<Dim>::nodes);

  [[nodiscard]] Record& operator()(std::size_t block, std::size_t node) { return records_[block * nodes + node]; }
  [[nodiscard]] const Record& operator()(std::size_t block, std::size_t node) const {
    return records_[block * nodes + node];
  }
  void resize(std::size_t blocks) { records_.resize(blocks * nodes); }

  // Patches for the tiles, to be cleared and filled by whoever works on a tile.
  AlignedVector<Patch<Dim, Real, Components>>& patches(std::size_t tiles) {
    patches_.resize(tiles);
    return patches_;
  }

 private:
  AlignedVector<Record> records_;
  AlignedVector<Patch<Dim, Real, Components>> patches_;
};

// Calls visit(block_place, patch_place) for each node that block and patch share, the block lying in `direction` (0 ..
// 3^Dim-1) from the patch's tile.
template <int Dim, class Visit>
void for_shared_nodes(int direction, const Visit& visit) {
  using T = Tile<Dim>;
  std::array<int, Dim> first{}, last{}, shift{};
  for (std::size_t a = 0; a < Dim; ++a) {
    const int d = direction % 3 - 1;
    direction /= 3;
    first[a] = d < 0 ? T::edge - 1 : 0;
    last[a] = d > 0 ? 1 : T::edge;
    shift[a] = d * T::edge + 1;  // patch coordinate of the block's node 0
  }
  if constexpr (Dim == 2) {
    for (int j = first[1]; j < last[1]; ++j) {
      for (int i = first[0]; i < last[0]; ++i) {
        visit(static_cast<std::size_t>(j * T::edge + i),
              static_cast<std::size_t>((j + shift[1]) * T::patch_edge + i + shift[0]));
      }
    }
  } else {
    for (int k = first[2]; k < last[2]; ++k) {
      for (int j = first[1]; j < last[1]; ++j) {
        for (int i = first[0]; i < last[0]; ++i) {
          visit(
              static_cast<std::size_t>((k * T::edge + j) * T::edge + i),
              static_cast<std::size_t>(((k + shift[2]) * T::patch_edge + j + shift[1]) * T::patch_edge + i + shift[0]));
        }
      }
    }
  }
}

// Node sums of what the patches of the tiles hold, always in the same order of tiles.
template <int Dim, class Real, int Components>
void sum_patches(const SparseGrid<Dim, Real>& grid, NodeRecords<Dim, Real, Components>& nodes) {
  nodes.resize(grid.blocks().size());
  const auto& patches = nodes.patches(grid.tiles().size());
  parallel_for(grid.blocks().size(), [&](std::size_t block) {
    for (std::size_t node = 0; node < NodeRecords<Dim, Real, Components>::nodes; ++node) {
      nodes(block, node).fill(Real(0));
    }
    const std::int32_t* tiles = grid.tiles_about_block(block);
    for (int d = 0; d < Tile<Dim>::stencil; ++d) {
      if (tiles[d] == KeyIndex::absent) {
        continue;
      }
      const auto& patch = patches[static_cast<std::size_t>(tiles[d])];
      // The tile lies in direction d from the block, so the block lies opposite from the tile.
      for_shared_nodes<Dim>(Tile<Dim>::stencil - 1 - d, [&](std::size_t in_block, std::size_t in_patch) {
        auto& sum = nodes(block, in_block);
        const auto& part = patch.records[in_patch];
        for (std::size_t c = 0; c < static_cast<std::size_t>(Components); ++c) {
          sum[c] += part[c];
        }
      });
    }
  });
}

// Copies what the nodes about tile t hold into a patch.
template <int Dim, class Real, int Components>
void load_patch(const SparseGrid<Dim, Real>& grid, std::size_t t, const NodeRecords<Dim, Real, Components>& nodes,
                Patch<Dim, Real, Components>& patch) {
  const std::int32_t* blocks = grid.blocks_about_tile(t);
  for (int d = 0; d < Tile<Dim>::stencil; ++d) {
    const auto block = static_cast<std::size_t>(blocks[d]);
    for_shared_nodes<Dim>(
        d, [&](std::size_t in_block, std::size_t in_patch) { patch.records[in_patch] = nodes(block, in_block); });
  }
}

// The nodes a particle sees, as places in its tile's patch, and their weights.
template <int Dim, class Real, std::size_t Width = 3>
struct Stencil {
  std::size_t first;  // place in the patch of the lowest node
  std::array<AxisWeights<Real, Width>, Dim> axis;

  // Calls visit(place, weight, gradient) for each of the Width^Dim nodes.
  template <class Visit>
  THAWSLIDE_ALWAYS_INLINE void for_each_node(const Visit& visit) const {
    constexpr auto row = static_cast<std::size_t>(Tile<Dim>::patch_edge);
    if constexpr (Dim == 2) {
      for (std::size_t j = 0; j < Width; ++j) {
        for (std::size_t i = 0; i < Width; ++i) {
          visit(first + j * row + i, axis[0].weight[i] * axis[1].weight[j],
                Vector<Real, 2>(axis[0].slope[i] * axis[1].weight[j], axis[0].weight[i] * axis[1].slope[j]));
        }
      }
    } else {
      for (std::size_t k = 0; k < Width; ++k) {
        for (std::size_t j = 0; j < Width; ++j) {
          for (std::size_t i = 0; i < Width; ++i) {
            const Real wij = axis[0].weight[i] * axis[1].weight[j];
            visit(first + (k * row + j) * row + i, wij * axis[2].weight[k],
                  Vector<Real, 3>(axis[0].slope[i] * axis[1].weight[j] * axis[2].weight[k],
                                  axis[0].weight[i] * axis[1].slope[j] * axis[2].weight[k], wij * axis[2].slope[k]));
          }
        }
      }
    }
  }
};

// Adds weight * carried to a record.
template <class Record, class Real>
THAWSLIDE_ALWAYS_INLINE void add_weighted(Record& record, Real weight, const Record& carried) {
  for (std::size_t c = 0; c < std::tuple_size_v<Record>; ++c) {
    record[c] += weight * carried[c];
  }
}

// What a particle reads of `Count` numbers of the records about it: their values at its place and their gradients
// [per m]. Axis by axis, rows first: fewer products than node by node.
template <int Dim, class Real, std::size_t Count>
struct Reading {
  std::array<Real, Count> value{};
  std::array<std::array<Real, Count>, Dim> gradient{};
};

template <std::size_t Count, int Dim, class Real, std::size_t Width, int Components>
THAWSLIDE_ALWAYS_INLINE Reading<Dim, Real, Count> read_nodes(const Stencil<Dim, Real, Width>& stencil,
                                                             const Patch<Dim, Real, Components>& patch,
                                                             std::size_t first_component = 0) {
  constexpr auto edge = static_cast<std::size_t>(Tile<Dim>::patch_edge);
  constexpr std::size_t layers = Dim == 3 ? Width : 1;
  Reading<Dim, Real, Count> reading;
  for (std::size_t k = 0; k < layers; ++k) {
    Reading<Dim, Real, Count> layer;
    for (std::size_t j = 0; j < Width; ++j) {
      std::array<Real, Count> along{};
      std::array<Real, Count> slope{};
      for (std::size_t i = 0; i < Width; ++i) {
        const Real* record = &patch.records[stencil.first + (k * edge + j) * edge + i][first_component];
        for (std::size_t c = 0; c < Count; ++c) {
          along[c] += stencil.axis[0].weight[i] * record[c];
          slope[c] += stencil.axis[0].slope[i] * record[c];
        }
      }
      for (std::size_t c = 0; c < Count; ++c) {
        layer.value[c] += stencil.axis[1].weight[j] * along[c];
        layer.gradient[0][c] += stencil.axis[1].weight[j] * slope[c];
        layer.gradient[1][c] += stencil.axis[1].slope[j] * along[c];
      }
    }
    if constexpr (Dim == 2) {
      return layer;
    } else {
      for (std::size_t c = 0; c < Count; ++c) {
        reading.value[c] += stencil.axis[2].weight[k] * layer.value[c];
        reading.gradient[0][c] += stencil.axis[2].weight[k] * layer.gradient[0][c];
        reading.gradient[1][c] += stencil.axis[2].weight[k] * layer.gradient[1][c];
        reading.gradient[2][c] += stencil.axis[2].slope[k] * layer.value[c];
      }
    }
  }
  return reading;
}

// The gradient of component c, and that of the vector of the first Dim components: d v_a / d x_b.
template <int Dim, class Real, std::size_t Count>
THAWSLIDE_ALWAYS_INLINE Vector<Real, Dim> gradient_of(const Reading<Dim, Real, Count>& reading, std::size_t c) {
  Vector<Real, Dim> gradient;
  for (int b = 0; b < Dim; ++b) {
    gradient[b] = reading.gradient[static_cast<std::size_t>(b)][c];
  }
  return gradient;
}
template <int Dim, class Real, std::size_t Count>
THAWSLIDE_ALWAYS_INLINE Matrix<Real, Dim> gradient_of(const Reading<Dim, Real, Count>& reading) {
  Matrix<Real, Dim> gradient;
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b < Dim; ++b) {
      gradient(a, b) = reading.gradient[static_cast<std::size_t>(b)][static_cast<std::size_t>(a)];
    }
  }
  return gradient;
}

// Node numbers along each axis of the sides of the domain that prescribe velocity.
template <int Dim>
struct HeldSides {
  static constexpr int none = std::numeric_limits<int>::min();
  std::array<int, Dim> lower, upper;

  HeldSides() {
    lower.fill(none);
    upper.fill(none);
  }
  [[nodiscard]] bool at(std::size_t axis, int node) const { return node == lower[axis] || node == upper[axis]; }
};

// Where a particle stands: its nearest node and its offset from it, in cells.
template <int Dim, class Real>
struct Place {
  typename Tile<Dim>::Index node{};
  Vector<Real, Dim> offset;
};

template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE Place<Dim, Real> place_of(const SparseGrid<Dim, Real>& grid,
                                                  const Vector<Real, Dim>& position) {
  Place<Dim, Real> place;
  grid.nearest_node(position, place.node, place.offset);
  return place;
}

// Stencil of a particle in its tile, for shape functions Shape (Ugimp, Linear, Quadratic). half: its half size in
// cells.
template <class Shape, int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE Stencil<Dim, Real> make_stencil(const SparseGrid<Dim, Real>& grid, std::uint64_t tile_key,
                                                        const Place<Dim, Real>& place, Real half,
                                                        const HeldSides<Dim>& sides) {
  using T = Tile<Dim>;
  const typename T::Index tile = T::index(tile_key);
  Stencil<Dim, Real> stencil;
  typename T::Index lowest{};
  for (std::size_t a = 0; a < Dim; ++a) {
    lowest[a] = place.node[a] - tile[a] * T::edge - 1;
    stencil.axis[a] =
        Shape::weights(place.offset[static_cast<int>(a)], half, sides.at(a, place.node[a]), grid.inverse_cell());
  }
  stencil.first = static_cast<std::size_t>(T::in_patch(lowest));
  return stencil;
}

// The same nodes and weights for APIC: in place of the gradient G_i stands S_i (x_i - x_p)/D, with which node
// velocities make the affine velocity C. moment: the second moments D [m2] along each axis.
template <int Dim, class Real>
struct AffineStencil {
  Stencil<Dim, Real> nodes;
  Vector<Real, Dim> moment;
};

template <class Shape, int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE AffineStencil<Dim, Real> make_affine(const SparseGrid<Dim, Real>& grid,
                                                             const Stencil<Dim, Real>& stencil,
                                                             const Place<Dim, Real>& place,
                                                             const HeldSides<Dim>& sides) {
  AffineStencil<Dim, Real> affine;
  affine.nodes.first = stencil.first;
  for (std::size_t a = 0; a < Dim; ++a) {
    const Real offset = place.offset[static_cast<int>(a)];
    affine.nodes.axis[a] = Shape::affine(stencil.axis[a], offset, sides.at(a, place.node[a]), grid.inverse_cell());
    affine.moment[static_cast<int>(a)] = second_moment(stencil.axis[a], offset) * grid.cell() * grid.cell();
  }
  return affine;
}

// The corners of the particle's cell with its linear hats, which heat and pore pressure use whatever momentum uses.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE Stencil<Dim, Real, 2> hat_stencil(const SparseGrid<Dim, Real>& grid, std::uint64_t tile_key,
                                                          const Particles<Dim, Real>& particles, std::uint32_t p) {
  using T = Tile<Dim>;
  typename T::Index node{};
  Vector<Real, Dim> offset;
  grid.nearest_node(particles.position.template get<Vector<Real, Dim>>(p), node, offset);
  const typename T::Index tile = T::index(tile_key);
  const Real slope = grid.inverse_cell();
  Stencil<Dim, Real, 2> stencil;
  typename T::Index lowest{};
  for (std::size_t a = 0; a < Dim; ++a) {
    const Real from_node = offset[static_cast<int>(a)];  // in cells, within [-1/2, 1/2]
    const bool left = from_node < Real(0);
    const Real along = left ? Real(1) + from_node : from_node;
    lowest[a] = node[a] - tile[a] * T::edge - (left ? 1 : 0);
    stencil.axis[a] = {{Real(1) - along, along}, {-slope, slope}};
  }
  stencil.first = static_cast<std::size_t>(T::in_patch(lowest));
  return stencil;
}

}  // namespace thawslide::mpm
