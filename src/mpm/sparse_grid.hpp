// Sparse background grid: occupied tiles, canonical particle order, and active blocks of nodes. Its cost scales with
// the number of occupied cells, not with the bounding box.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/key_index.hpp"
#include "mpm/mapping.hpp"
#include "mpm/particles.hpp"
#include "mpm/tile_tables.hpp"

namespace thawslide::mpm {

// Memory of those tables for kernels that the grid itself does not have.
struct TableMemory {
  std::vector<std::uint64_t> tile_keys;
  std::vector<std::uint32_t> first_of_cell;
};

template <int Dim>
class SparseGrid {
 public:
  using T = Tile<Dim>;
  using Index = typename T::Index;

  struct OccupiedTile {
    std::uint64_t key;
    std::uint32_t first, last;  // its particles: order()[first .. last-1]
  };

  // cell: mesh size [m]. layer_of_body: bodies of different layers share no nodes; empty: all share them.
  explicit SparseGrid(double cell, std::vector<std::uint8_t> layer_of_body = {}, const Mapping& mapping = {})
      : cell_(cell), inverse_cell_(1.0 / cell), mapping_(mapping), layer_of_body_(std::move(layer_of_body)) {}

  [[nodiscard]] double cell() const { return cell_; }
  [[nodiscard]] double inverse_cell() const { return inverse_cell_; }
  [[nodiscard]] const Mapping& mapping() const { return mapping_; }

  // Updates order, tiles, batches and blocks to the particle positions. Appended particles are added; removed ones must
  // have been passed to `remove`. The canonical order is by nearest node, then by id, independent of the order in
  // memory. Particles are sorted in memory if many are out of order and every `interval` calls; with an interval of 0,
  // at the first call only.
  void update(Particles<Dim>& particles, int interval);

  // Moves bodies to other layers, from the next update on.
  void set_layers(std::vector<std::uint8_t> layer_of_body);

  // Follows Particles::remove. now_at: its result.
  void remove(const Particles<Dim>& particles, const std::vector<std::uint32_t>& now_at);

  // Sets the active blocks of a grid without particles, by ascending key.
  void set_blocks(std::vector<std::uint64_t> keys);

  // Particle indices in canonical order.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }
  [[nodiscard]] const std::vector<OccupiedTile>& tiles() const { return tiles_; }
  // Batches of tile t, in canonical order.
  [[nodiscard]] const std::vector<TileBatch<Dim>>& batches(std::size_t t) const { return batches_[t]; }
  // Rows of tile t's patch (Tile::rows_from) in which its particles have nodes.
  [[nodiscard]] std::uint64_t rows_seen(std::size_t t) const { return made_[t].rows_seen; }
  // Keys of the active blocks: occupied tiles and their neighbours, ascending.
  [[nodiscard]] const std::vector<std::uint64_t>& blocks() const { return blocks_; }
  // Number of the active block with a key, or KeyIndex::absent.
  [[nodiscard]] std::int32_t block_at(std::uint64_t key) const { return block_number_.find(key); }
  // True if the last update changed the set of blocks, and hence the block numbers.
  [[nodiscard]] bool blocks_changed() const { return blocks_changed_; }
  // For the 3^Dim neighbours of block b in order: number of the occupied tile there, or KeyIndex::absent.
  [[nodiscard]] const std::int32_t* tiles_about_block(std::size_t b) const { return &tiles_about_block_[b * stencil]; }
  // For the 3^Dim neighbours of tile t in order: number of the block there.
  [[nodiscard]] const std::int32_t* blocks_about_tile(std::size_t t) const { return &blocks_about_tile_[t * stencil]; }

  // For the 3^Dim neighbours of block b in order: number of the active block there, or KeyIndex::absent.
  [[nodiscard]] const std::int32_t* blocks_about_block(std::size_t b) const {
    return &blocks_about_block_[b * stencil];
  }

  [[nodiscard]] BlockTables<Dim> block_tables() const {
    return {blocks_.size(), blocks_.data(), blocks_about_block_.data()};
  }
  // Copies the keys of the tiles; returns true if they differ from those before.
  bool copy_tile_keys(std::vector<std::uint64_t>& keys) const {
    if (std::equal(keys.begin(), keys.end(), tiles_.begin(), tiles_.end(),
                   [](std::uint64_t key, const OccupiedTile& tile) { return key == tile.key; })) {
      return false;
    }
    keys.resize(tiles_.size());
    std::transform(tiles_.begin(), tiles_.end(), keys.begin(), [](const OccupiedTile& tile) { return tile.key; });
    return true;
  }
  // Tables for kernels, without the keys of particles; valid until the next change of the grid or of `memory`.
  [[nodiscard]] TileTables<Dim> tables(TableMemory& memory) const;

  // Marks the blocks around marked tiles, which contain all nodes in reach of their particles.
  void mark_blocks_about(const std::vector<std::uint8_t>& tiles, std::vector<std::uint8_t>& blocks) const;
  // True if a block around tile t is marked.
  [[nodiscard]] bool any_about_tile(std::size_t t, const std::vector<std::uint8_t>& blocks) const {
    const std::int32_t* about = blocks_about_tile(t);
    return std::any_of(about, about + stencil,
                       [&](std::int32_t b) { return blocks[static_cast<std::size_t>(b)] != 0; });
  }

 private:
  static constexpr std::size_t stencil = static_cast<std::size_t>(T::stencil);
  // Nearest node and key of a new particle.
  static constexpr std::int32_t never = std::numeric_limits<std::int32_t>::min();
  static constexpr std::uint64_t no_key = ~std::uint64_t{0};

  // Particle whose nearest node has changed since the last call, and its former tile.
  struct CellChange {
    std::uint32_t particle;
    std::uint64_t former_tile;
  };
  // Change of a tile: its former number, or none, and the particles that moved into or within it.
  struct TileChange {
    std::size_t former, first_mover, last_mover;
    bool changed;  // a particle entered, left or moved within
  };

  // Properties of a tile's batches.
  struct MadeBatches {
    std::uint64_t rows_seen;
    std::uint32_t broken;  // batches that are not contiguous
  };

  void add_appended(const Particles<Dim>& particles);
  void drop_from_tiles(const std::vector<std::uint32_t>& now_at);
  bool compute_keys(const Particles<Dim>& particles);
  [[nodiscard]] std::uint64_t key_of(const Particles<Dim>& particles, std::size_t particle) const;
  void add_cell_changes(const Particles<Dim>& particles, std::size_t first, std::size_t count,
                        std::vector<CellChange>& movers);
  void merge_moved(const Particles<Dim>& particles);
  template <class Before>
  void merge_tile(std::size_t t, const Before& before);
  void count_leaving();
  void list_tiles();
  void reorder(Particles<Dim>& particles);
  void update_sort_heuristic(bool sorted);
  void list_blocks();
  void connect_blocks();
  void make_stale_batches(const Particles<Dim>& particles);
  void make_batches(const Particles<Dim>& particles, std::size_t t);
  // Place in nearest_ of a particle's index along an axis: groups of as many particles as lanes, axis by axis.
  static std::size_t in_nearest(std::size_t particle, std::size_t axis) {
    constexpr std::size_t most = SimdBatch::most;
    return (particle / most * Dim + axis) * most + particle % most;
  }

  double cell_, inverse_cell_;
  Mapping mapping_;
  std::vector<std::uint8_t> layer_of_body_;
  std::vector<std::uint64_t> keys_;    // by particle: tile key, then place in the tile
  std::vector<std::int32_t> nearest_;  // by batch in memory, axis and lane: nearest node
  bool one_material_ = true;
  std::vector<std::uint8_t> moved_;
  ReorderBuffer reorder_buffer_;
  std::vector<std::vector<CellChange>> task_movers_;
  std::vector<CellChange> movers_;
  std::vector<std::uint32_t> order_, former_order_;
  std::vector<OccupiedTile> tiles_, former_tiles_;
  std::vector<std::uint32_t> leaving_;                // particles that left, by former tile
  std::vector<TileChange> changes_;                   // by tile
  std::vector<std::vector<TileBatch<Dim>>> batches_;  // by tile
  std::vector<std::uint8_t> stale_;                   // by tile: its batches must be rebuilt
  std::vector<std::uint64_t> blocks_;
  KeyIndex tile_number_, block_number_;
  std::vector<std::int32_t> tiles_about_block_, blocks_about_tile_, blocks_about_block_;
  bool blocks_changed_ = true;
  int calls_ = 0;                  // since particles were sorted in memory
  std::vector<MadeBatches> made_;  // by tile
  std::size_t fewest_broken_ = 0;  // right after the last sorting
  double disorder_ = 0;            // cost of the order since then: see update_sort_heuristic
};

}  // namespace thawslide::mpm
