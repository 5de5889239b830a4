// Active blocks of nodes and their neighbours.
#include <utility>

#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::mpm {

namespace {

// Key of the adjacent tile in a direction, in the same layer.
template <int Dim>
std::uint64_t neighbour(std::uint64_t key, int direction) {
  typename Tile<Dim>::Index other = Tile<Dim>::index(key);
  for (int a = 0; a < Dim; ++a) {
    other[static_cast<std::size_t>(a)] += direction % 3 - 1;
    direction /= 3;
  }
  return Tile<Dim>::in_layer(Tile<Dim>::key(other), Tile<Dim>::layer(key));
}

// For each neighbour of each tile or block, in order: its number among `others`, or KeyIndex::absent.
template <int Dim, class KeyOf>
void find_about(std::size_t count, const KeyOf& key_of, const KeyIndex& others, std::vector<std::int32_t>& about) {
  using T = Tile<Dim>;
  constexpr auto stencil = static_cast<std::size_t>(T::stencil);
  about.resize(count * stencil);
  parallel_for(count, [&](std::size_t k) {
    for (int d = 0; d < T::stencil; ++d) {
      about[k * stencil + static_cast<std::size_t>(d)] = others.find(neighbour<Dim>(key_of(k), d));
    }
  });
}

}  // namespace

template <int Dim>
TileTables<Dim> SparseGrid<Dim>::tables(TableMemory& memory) const {
  constexpr auto nodes = static_cast<std::size_t>(T::nodes);
  memory.tile_keys.resize(tiles_.size());
  memory.first_of_cell.resize(tiles_.size() * nodes + 1);
  parallel_for(tiles_.size(), [&](std::size_t t) {
    memory.tile_keys[t] = tiles_[t].key;
    std::uint32_t rank = tiles_[t].first;
    for (std::size_t cell = 0; cell < nodes; ++cell) {
      memory.first_of_cell[t * nodes + cell] = rank;
      const std::uint64_t key = (tiles_[t].key << T::node_bits) | cell;
      while (rank < tiles_[t].last && keys_[order_[rank]] == key) {
        ++rank;
      }
    }
  });
  memory.first_of_cell.back() = static_cast<std::uint32_t>(order_.size());
  return {order_.size(),
          tiles_.size(),
          blocks_.size(),
          order_.data(),
          nullptr,
          memory.tile_keys.data(),
          blocks_.data(),
          memory.first_of_cell.data(),
          blocks_about_tile_.data(),
          tiles_about_block_.data(),
          blocks_about_block_.data()};
}

template <int Dim>
void SparseGrid<Dim>::list_blocks() {
  blocks_.clear();
  for (const OccupiedTile& tile : tiles_) {
    for (int d = 0; d < T::stencil; ++d) {
      blocks_.push_back(neighbour<Dim>(tile.key, d));
    }
  }
  std::sort(blocks_.begin(), blocks_.end());
  blocks_.erase(std::unique(blocks_.begin(), blocks_.end()), blocks_.end());
}

template <int Dim>
void SparseGrid<Dim>::connect_blocks() {
  tile_number_.clear();
  for (const OccupiedTile& tile : tiles_) {
    tile_number_.insert(tile.key);
  }
  block_number_.clear();
  for (const std::uint64_t block : blocks_) {
    block_number_.insert(block);
  }
  const auto key_of_block = [&](std::size_t b) { return blocks_[b]; };
  find_about<Dim>(blocks_.size(), key_of_block, tile_number_, tiles_about_block_);
  find_about<Dim>(blocks_.size(), key_of_block, block_number_, blocks_about_block_);
  find_about<Dim>(
      tiles_.size(), [&](std::size_t t) { return tiles_[t].key; }, block_number_, blocks_about_tile_);
}

template <int Dim>
void SparseGrid<Dim>::set_blocks(std::vector<std::uint64_t> keys) {
  THAWSLIDE_ASSERT(tiles_.empty(), "{} tiles hold particles, whose blocks others cannot set", tiles_.size());
  blocks_ = std::move(keys);
  connect_blocks();
  blocks_changed_ = true;
}

#define THAWSLIDE_INSTANTIATE(Dim)                                             \
  template TileTables<Dim> SparseGrid<Dim>::tables(TableMemory& memory) const; \
  template void SparseGrid<Dim>::list_blocks();                                \
  template void SparseGrid<Dim>::connect_blocks();                             \
  template void SparseGrid<Dim>::set_blocks(std::vector<std::uint64_t>);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
