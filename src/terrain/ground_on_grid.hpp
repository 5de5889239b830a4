// Ground at the nodes of active blocks, computed once per block and cached near the sliding mass.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "base/key_index.hpp"
#include "mpm/nodes.hpp"
#include "terrain/following_ground.hpp"
#include "terrain/substrates.hpp"

namespace thawslide::terrain {

// First node of a block, by its key.
template <int Dim>
typename mpm::Tile<Dim>::Index first_node_of(std::uint64_t block) {
  auto first = mpm::Tile<Dim>::index(block);
  for (int& along : first) {
    along *= mpm::Tile<Dim>::edge;
  }
  return first;
}

// True if the ground is known everywhere below a block and within one cell around it.
template <int Dim>
bool is_ground_known(const FollowingGround<Dim>& surface, std::uint64_t block, double cell) {
  const auto first = first_node_of<Dim>(block);
  typename FollowingGround<Dim>::Point from, to;
  for (int a = 0; a + 1 < Dim; ++a) {
    from[a] = static_cast<double>(first[static_cast<std::size_t>(a)] - 1) * cell;
    to[a] = static_cast<double>(first[static_cast<std::size_t>(a)] + mpm::Tile<Dim>::edge) * cell;
  }
  return surface.is_known(from, to);
}

// Ground at the nodes of a block. substrates: null if there is only one.
template <int Dim>
void query_ground(const FollowingGround<Dim>& surface, const Substrates* substrates, std::uint64_t block, double cell,
                  GroundAtNode<Dim>* nodes) {
  using T = mpm::Tile<Dim>;
  const typename T::Index first = first_node_of<Dim>(block);
  surface.at_block(first, T::edge, nodes);
  for (int n = 0; n < T::nodes && substrates != nullptr; ++n) {
    const typename T::Index node = T::node({}, n);
    const auto along = [&](std::size_t a) { return static_cast<double>(first[a] + node[a]) * cell; };
    nodes[n].substrate = substrates->at(along(0), Dim == 3 ? along(1) : 0.0);
  }
}

template <int Dim>
class GroundOnGrid {
  using T = mpm::Tile<Dim>;

 public:
  using Block = std::array<GroundAtNode<Dim>, static_cast<std::size_t>(mpm::Tile<Dim>::nodes)>;

  // Updates blocks and tiles; call after the grid's blocks have changed. Blocks that the sliding mass has left are kept
  // for a while. substrates: null if there is only one.
  void update(const FollowingGround<Dim>& surface, const mpm::SparseGrid<Dim>& grid,
              const Substrates* substrates = nullptr) {
    forget_left_blocks(grid);
    number_.resize(grid.blocks().size());
    const std::size_t known_before = blocks_.size();
    for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
      number_[b] = index_.insert(grid.blocks()[b]);
      if (index_.size() > keys_.size()) {
        keys_.push_back(grid.blocks()[b]);
      }
    }
    blocks_.resize(keys_.size());
    candidates_.resize(keys_.size());
    partly_unknown_.resize(keys_.size());
    parallel_for(keys_.size() - known_before, [&](std::size_t from_known) {
      const std::size_t k = known_before + from_known;
      query_ground<Dim>(surface, substrates, keys_[k], grid.cell(), blocks_[k].data());
      const int lowest = first_node_of<Dim>(keys_[k])[Dim - 1];
      const int layers = std::clamp(1 - lowest, 0, T::edge);
      candidates_[k] = static_cast<std::uint8_t>(layers * T::rows);
      partly_unknown_[k] = is_ground_known<Dim>(surface, keys_[k], grid.cell()) ? 0 : 1;
    });
    first_candidate_.assign(1, 0);
    for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
      first_candidate_.push_back(first_candidate_[b] + candidates(b));
    }
    lowest_layer_.resize(grid.tiles().size());
    for (std::size_t t = 0; t < grid.tiles().size(); ++t) {
      lowest_layer_[t] = T::index(grid.tiles()[t].key)[Dim - 1] * T::edge - 1;
    }
  }

  // True if particles of tile t reach a candidate node with any shape function.
  [[nodiscard]] bool any_near(std::size_t t) const { return lowest_layer_[t] <= 0; }
  // The same for one particle, by the place of its lowest node in the tile's patch, and for a batch.
  [[nodiscard]] bool any_near(std::size_t t, std::size_t lowest) const {
    constexpr auto nodes_of_layer = static_cast<std::size_t>(T::patch_rows);
    return lowest_layer_[t] + static_cast<int>(lowest / nodes_of_layer) <= 0;
  }
  [[nodiscard]] bool any_near(std::size_t t, const mpm::BatchNodes& nodes) const {
    const auto is_near = [&](std::int32_t lowest) { return any_near(t, static_cast<std::size_t>(lowest)); };
    return nodes.runs == 1 ? is_near(nodes.first[0]) : std::any_of(nodes.first.begin(), nodes.first.end(), is_near);
  }

  // Ground at the nodes of active block b.
  [[nodiscard]] const Block& block(std::size_t b) const { return blocks_[static_cast<std::size_t>(number_[b])]; }
  // Number of candidate nodes of active block b; they are its first nodes.
  [[nodiscard]] std::size_t candidates(std::size_t b) const {
    return candidates_[static_cast<std::size_t>(number_[b])];
  }
  // Number of the first one of a block among all candidate nodes, and their number.
  [[nodiscard]] std::size_t first_candidate(std::size_t b) const { return first_candidate_[b]; }
  [[nodiscard]] std::size_t candidate_count() const { return first_candidate_.back(); }
  // True if the ground below active block b, or within one cell around it, has no-data parts.
  [[nodiscard]] bool partly_unknown(std::size_t b) const {
    return partly_unknown_[static_cast<std::size_t>(number_[b])] != 0;
  }
  // Number of cached blocks, including those that the sliding mass has left.
  [[nodiscard]] std::size_t stored() const { return blocks_.size(); }

 private:
  // Removes inactive blocks from the cache when most of its blocks are inactive.
  void forget_left_blocks(const mpm::SparseGrid<Dim>& grid) {
    constexpr std::size_t stored_per_active = 3;
    if (blocks_.size() <= stored_per_active * grid.blocks().size()) {
      return;
    }
    KeyIndex index;
    std::vector<std::uint64_t> keys;
    std::vector<Block> blocks;
    std::vector<std::uint8_t> candidates, partly_unknown;
    for (const std::uint64_t key : grid.blocks()) {
      const std::int32_t former = index_.find(key);
      if (former != KeyIndex::absent) {
        const auto k = static_cast<std::size_t>(former);
        index.insert(key);
        keys.push_back(key);
        blocks.push_back(blocks_[k]);
        candidates.push_back(candidates_[k]);
        partly_unknown.push_back(partly_unknown_[k]);
      }
    }
    index_ = std::move(index);
    keys_ = std::move(keys);
    blocks_ = std::move(blocks);
    candidates_ = std::move(candidates);
    partly_unknown_ = std::move(partly_unknown);
  }

  KeyIndex index_;  // block key -> index in keys_, blocks_ and the marks
  std::vector<std::uint64_t> keys_;
  std::vector<Block> blocks_;
  std::vector<std::uint8_t> candidates_, partly_unknown_;
  std::vector<std::int32_t> number_;             // active block -> index in blocks_
  std::vector<std::size_t> first_candidate_{0};  // by active block, and the number of all candidates
  std::vector<int> lowest_layer_;                // of nodes in reach of the particles, by tile
};

}  // namespace thawslide::terrain
