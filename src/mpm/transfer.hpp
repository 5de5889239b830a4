// Transfer between particles and nodes: patches, to which the particles of a tile add and from which they read, and
// nodal records. A record is the `Components` consecutive numbers of a node for one purpose.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "base/aligned.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/simd.hpp"
#include "mpm/reading.hpp"
#include "mpm/records.hpp"
#include "mpm/shared_rows.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::mpm {

// Widest register that divides a record.
template <int Components>
using RecordRegister =
    Simd<double, record_size(Components) % simd_width<double> == 0 ? simd_width<double> : record_step>;

// Records around one tile, with a margin of one node.
template <int Dim, int Components>
struct Patch {
  using Record = std::array<double, record_size(Components)>;
  alignas(cache_line) std::array<Record, static_cast<std::size_t>(Tile<Dim>::patch_nodes)> records;

  void clear() { std::fill_n(records.front().data(), records.size() * records.front().size(), 0.0); }
  // Calls visit(record) with the first record of each row. rows: one bit per row (Tile::rows_from).
  template <class Visit>
  THAWSLIDE_ALWAYS_INLINE void for_rows(std::uint64_t rows, const Visit& visit) {
    for (; rows != 0; rows &= rows - 1) {
      visit(&records[static_cast<std::size_t>(std::countr_zero(rows) * Tile<Dim>::patch_edge)]);
    }
  }
  // Clears only these rows.
  void clear(std::uint64_t rows) {
    for_rows(rows, [](Record* row) { std::fill_n(row->data(), Tile<Dim>::patch_edge * row->size(), 0.0); });
  }
  // Returns those of these rows in which is(record) is true for at least one record.
  template <class Is>
  [[nodiscard]] std::uint64_t rows_with(std::uint64_t rows, const Is& is) {
    std::uint64_t found = 0;
    for_rows(rows, [&](const Record* row) {
      const auto number = (row - records.data()) / Tile<Dim>::patch_edge;
      found |= std::uint64_t{std::any_of(row, row + Tile<Dim>::patch_edge, is)} << number;
    });
    return found;
  }
};

// Memory for the patches of one stage at a time; the next stage overwrites them after they have been summed.
class PatchPool {
 public:
  template <class AnyPatch>
  [[nodiscard]] std::span<AnyPatch> acquire(std::size_t tiles) {
    if (tiles * sizeof(AnyPatch) > bytes_.size()) {
      resize_sparingly(bytes_, tiles * sizeof(AnyPatch));
    }
    return {reinterpret_cast<AnyPatch*>(bytes_.data()), tiles};
  }

 private:
  AlignedVector<std::byte> bytes_;
};

// Node of the grid: its block, and its place there.
struct NodeAt {
  std::size_t block, node;
};

// One record per node of every active block, and the patches that are summed into it.
template <int Dim, int Components>
class NodeRecords {
 public:
  using Record = std::array<double, record_size(Components)>;
  static constexpr std::size_t nodes = static_cast<std::size_t>(Tile<Dim>::nodes);

  // Without memory for patches: for records that nodes compute, or sum from the patches of others.
  NodeRecords() = default;
  explicit NodeRecords(std::shared_ptr<PatchPool> pool) : pool_(std::move(pool)) {}

  [[nodiscard]] Record& operator()(std::size_t block, std::size_t node) { return records_[block * nodes + node]; }
  [[nodiscard]] const Record& operator()(std::size_t block, std::size_t node) const {
    return records_[block * nodes + node];
  }
  [[nodiscard]] Record& operator()(const NodeAt& at) { return (*this)(at.block, at.node); }
  [[nodiscard]] const Record& operator()(const NodeAt& at) const { return (*this)(at.block, at.node); }
  [[nodiscard]] Record* of_block(std::size_t block) { return &records_[block * nodes]; }
  void resize(std::size_t blocks) { resize_sparingly(records_, blocks * nodes); }

  // Patches of the tiles. The caller must clear and fill them, and sum them before other records with the same memory
  // request theirs.
  [[nodiscard]] std::span<Patch<Dim, Components>> patches(std::size_t tiles) {
    THAWSLIDE_ASSERT(pool_ != nullptr, "{} components without memory for patches", Components);
    return pool_->acquire<Patch<Dim, Components>>(tiles);
  }

 private:
  AlignedVector<Record> records_;
  std::shared_ptr<PatchPool> pool_;
};

// One record per node of selected active blocks; those of other blocks read as zeros.
template <int Dim, int Components>
class SparseRecords {
 public:
  using Record = std::array<double, record_size(Components)>;
  static constexpr std::size_t nodes = static_cast<std::size_t>(Tile<Dim>::nodes);

  SparseRecords() = default;
  explicit SparseRecords(std::shared_ptr<PatchPool> pool) : records_(std::move(pool)) {}

  // Selects the blocks for which holds(block) is true; their contents are undefined. blocks: number of active blocks.
  template <class Contains>
  void allocate(std::size_t blocks, const Contains& contains) {
    resize_sparingly(index_, blocks);
    std::uint32_t allocated = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      index_[b] = contains(b) ? ++allocated : 0;
    }
    records_.resize(allocated + 1);
    std::fill_n(records_.of_block(0), nodes, Record{});
  }
  [[nodiscard]] bool contains(std::size_t block) const { return index_[block] != 0; }

  [[nodiscard]] const Record& operator()(std::size_t block, std::size_t node) const {
    return records_(index_[block], node);
  }
  [[nodiscard]] const Record& operator()(const NodeAt& at) const { return (*this)(at.block, at.node); }
  [[nodiscard]] Record* of_block(std::size_t block) {
    THAWSLIDE_ASSERT(contains(block), "block {} is not held", block);
    return records_.of_block(index_[block]);
  }

  [[nodiscard]] std::span<Patch<Dim, Components>> patches(std::size_t tiles) { return records_.patches(tiles); }

 private:
  NodeRecords<Dim, Components> records_;  // zeros, then the selected blocks
  std::vector<std::uint32_t> index_;      // by block
};

inline constexpr auto every_tile = [](std::size_t /*tile*/) { return true; };

// Rows of a block in which particles have nodes, one bit per row.
template <int Dim>
std::uint32_t rows_seen_in_block(const SparseGrid<Dim>& grid, std::size_t block) {
  const std::int32_t* tiles = grid.tiles_about_block(block);
  std::uint32_t seen = 0;
  for_each_direction<Dim>([&](auto d) {
    seen |=
        tiles[d] == KeyIndex::absent ? 0 : rows_in_block<Dim, d>(grid.rows_seen(static_cast<std::size_t>(tiles[d])));
  });
  return seen;
}

// Sums patches at the nodes of one block, from the tiles for which accepts(t) is true, in a fixed order: the block's
// own tile, then those around it. Only rows in which a patch's own particles have nodes are added. Returns the rows of
// the block in which particles of any tile have nodes, one bit per row; other records are not computed.
template <int Dim, int Components, class TileFilter>
std::uint32_t sum_patches_in_block(const SparseGrid<Dim>& grid, std::size_t block,
                                   std::span<Patch<Dim, Components>> patches,
                                   typename Patch<Dim, Components>::Record* records, const TileFilter& accepts) {
  using Record = typename Patch<Dim, Components>::Record;
  using Register = RecordRegister<Components>;
  constexpr std::size_t size = std::tuple_size_v<Record>, edge = static_cast<std::size_t>(Tile<Dim>::edge);
  constexpr std::size_t own = static_cast<std::size_t>(Tile<Dim>::stencil) / 2;
  const std::int32_t* tiles = grid.tiles_about_block(block);
  std::uint32_t seen = 0, begun = 0;  // rows of the block
  const auto add_patch = [&](auto d) THAWSLIDE_INLINE_LAMBDA {
    if (tiles[d] == KeyIndex::absent) {
      return;
    }
    const auto tile = static_cast<std::size_t>(tiles[d]);
    const std::uint64_t rows = grid.rows_seen(tile);
    if ((rows & shared_rows<Dim, opposite<Dim>(d)>()) == 0) {
      return;
    }
    if (!accepts(tile)) {
      seen |= rows_in_block<Dim, d>(rows);
      return;
    }
    for_seen_rows<Dim, opposite<Dim>(d)>(
        rows, [&](std::size_t in_block, std::size_t in_patch, std::size_t count) THAWSLIDE_INLINE_LAMBDA {
          const std::uint32_t row = std::uint32_t{1} << in_block / edge;
          double* sums = records[in_block].data();
          const double* parts = patches[tile].records[in_patch].data();
          if ((begun & row) == 0) {
            begun |= row;
            if (count == edge) {
              for (std::size_t c = 0; c < count * size; c += Register::count) {
                Register::load(parts + c).store(sums + c);
              }
              return;
            }
            std::fill_n(records[in_block / edge * edge].data(), edge * size, 0.0);
          }
          for (std::size_t c = 0; c < count * size; c += Register::count) {
            (Register::load(sums + c) + Register::load(parts + c)).store(sums + c);
          }
        });
  };
  add_patch(std::integral_constant<std::size_t, own>());
  for_each_direction<Dim>([&](auto d) {
    if constexpr (d != own) {
      add_patch(d);
    }
  });
  for (std::uint32_t rows = seen & ~begun; rows != 0; rows &= rows - 1) {
    std::fill_n(records[static_cast<std::size_t>(std::countr_zero(rows)) * edge].data(), edge * size, 0.0);
  }
  seen |= begun;
#ifndef NDEBUG
  for (std::uint32_t rows = Tile<Dim>::all_rows & ~seen; rows != 0; rows &= rows - 1) {
    std::fill_n(records[static_cast<std::size_t>(std::countr_zero(rows)) * edge].data(), edge * size,
                std::numeric_limits<double>::quiet_NaN());  // never read
  }
#endif
  return seen;
}

// The same at the nodes of all blocks, with 0 in rows without nodes of particles. Calls then(block) after each sum.
template <int Dim, int Components, class Then>
void sum_patches(const SparseGrid<Dim>& grid, NodeRecords<Dim, Components>& nodes, const Then& then) {
  constexpr std::size_t edge = static_cast<std::size_t>(Tile<Dim>::edge);
  nodes.resize(grid.blocks().size());
  const auto patches = nodes.patches(grid.tiles().size());
  parallel_for(grid.blocks().size(), [&](std::size_t block) {
    auto* records = nodes.of_block(block);
    const std::uint32_t seen = sum_patches_in_block(grid, block, patches, records, every_tile);
    for (std::uint32_t rows = Tile<Dim>::all_rows & ~seen; rows != 0; rows &= rows - 1) {
      const std::size_t row = static_cast<std::size_t>(std::countr_zero(rows)) * edge;
      std::fill_n(records[row].data(), edge * records->size(), 0.0);
    }
    then(block);
  });
}
template <int Dim, int Components>
void sum_patches(const SparseGrid<Dim>& grid, NodeRecords<Dim, Components>& nodes) {
  sum_patches(grid, nodes, [](std::size_t /*block*/) {});
}

// Minimum of one component at the nodes of one block, over the patches of the tiles for which accepts(t) is true; the
// largest number if there are none.
template <std::size_t Component, int Dim, int Components, class TileFilter>
void reduce_min_in_block(const SparseGrid<Dim>& grid, std::size_t block, std::span<Patch<Dim, Components>> patches,
                         typename Patch<Dim, Components>::Record* records, const TileFilter& accepts) {
  for (std::size_t k = 0; k < NodeRecords<Dim, Components>::nodes; ++k) {
    records[k][Component] = std::numeric_limits<double>::max();
  }
  const std::int32_t* tiles = grid.tiles_about_block(block);
  for_each_direction<Dim>([&](auto d) {
    if (tiles[d] != KeyIndex::absent && accepts(static_cast<std::size_t>(tiles[d]))) {
      const auto& patch = patches[static_cast<std::size_t>(tiles[d])];
      for_shared_nodes<Dim, opposite<Dim>(d)>(
          [&](std::size_t in_block, std::size_t in_patch) {
            double& known = records[in_block][Component];
            known = std::min(known, patch.records[in_patch][Component]);
          },
          grid.rows_seen(static_cast<std::size_t>(tiles[d])));
    }
  });
}

// Copies the records of the nodes around tile t into a patch, only in rows in which its particles have nodes.
template <int Dim, template <int, int> class Records, int Components>
void load_patch(const SparseGrid<Dim>& grid, std::size_t t, const Records<Dim, Components>& nodes,
                Patch<Dim, Components>& patch) {
  using Register = RecordRegister<Components>;
  constexpr std::size_t size = record_size(Components);
  const std::int32_t* blocks = grid.blocks_about_tile(t);
  const std::uint64_t rows = grid.rows_seen(t);
  for_each_direction<Dim>([&](auto d) {
    const auto block = static_cast<std::size_t>(blocks[d]);
    for_seen_rows<Dim, d>(rows, [&](std::size_t in_block, std::size_t in_patch, std::size_t count) {
      const double* from = nodes(block, in_block).data();
      double* to = patch.records[in_patch].data();
      for (std::size_t c = 0; c < count * size; c += Register::count) {
        Register::load(from + c).store(to + c);
      }
    });
  });
}

// Calls visit(place, weight, gradient) for each of the Width^Dim nodes. first: place of the lowest node.
template <int Dim, class Value, std::size_t Width, class Visit>
THAWSLIDE_ALWAYS_INLINE void for_each_node(
    const std::array<AxisWeights<Value, Width>, static_cast<std::size_t>(Dim)>& axis, std::size_t first,
    const Visit& visit) {
  constexpr auto row = static_cast<std::size_t>(Tile<Dim>::patch_edge);
  if constexpr (Dim == 2) {
    for (std::size_t j = 0; j < Width; ++j) {
      for (std::size_t i = 0; i < Width; ++i) {
        visit(first + j * row + i, axis[0].weight[i] * axis[1].weight[j],
              Vector<Value, 2>(axis[0].slope[i] * axis[1].weight[j], axis[0].weight[i] * axis[1].slope[j]));
      }
    }
  } else {
    for (std::size_t k = 0; k < Width; ++k) {
      for (std::size_t j = 0; j < Width; ++j) {
        for (std::size_t i = 0; i < Width; ++i) {
          const Value wij = axis[0].weight[i] * axis[1].weight[j];
          visit(first + (k * row + j) * row + i, wij * axis[2].weight[k],
                Vector<Value, 3>(axis[0].slope[i] * axis[1].weight[j] * axis[2].weight[k],
                                 axis[0].weight[i] * axis[1].slope[j] * axis[2].weight[k], wij * axis[2].slope[k]));
        }
      }
    }
  }
}

}  // namespace thawslide::mpm
