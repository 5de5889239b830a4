// The ground at the nodes of the active blocks: computed when a block is first seen, remembered afterwards.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "base/key_index.hpp"
#include "mpm/nodes.hpp"
#include "terrain/ground.hpp"

namespace thawslide::terrain {

template <int Dim, class Real>
class GroundOnGrid {
  using T = mpm::Tile<Dim>;

 public:
  using Block = std::array<GroundAtNode<Dim, Real>, static_cast<std::size_t>(mpm::Tile<Dim>::nodes)>;

  // Brings blocks and tiles up to date; to be called after the grid's blocks changed.
  void update(const Ground<Dim>& ground, const mpm::SparseGrid<Dim, Real>& grid) {
    number_.resize(grid.blocks().size());
    for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
      const std::size_t known = index_.size();
      number_[b] = index_.insert(grid.blocks()[b]);
      if (index_.size() == known) {
        continue;
      }
      Block block;
      bool any = false;
      for (std::size_t k = 0; k < block.size(); ++k) {
        block[k] = ground.at_node(mpm::node_position(grid, b, k), grid.cell());
        any = any || block[k].candidate;
      }
      blocks_.push_back(block);
      any_candidate_.push_back(any ? 1 : 0);
    }
    near_.resize(grid.tiles().size());
    any_near_.resize(grid.tiles().size());
    parallel_for(grid.tiles().size(), [&](std::size_t t) { find_near(grid, t); });
  }

  // Whether a block about tile t has candidate nodes.
  [[nodiscard]] bool any_candidate_about(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t) const {
    const std::int32_t* blocks = grid.blocks_about_tile(t);
    return std::any_of(blocks, blocks + T::stencil,
                       [&](std::int32_t b) { return any_candidate(static_cast<std::size_t>(b)); });
  }

  // Whether particles of tile t see a candidate node, with any shape functions.
  [[nodiscard]] bool any_near(std::size_t t) const { return any_near_[t] != 0; }
  // The same for those of one of its batches.
  [[nodiscard]] bool any_near(std::size_t t, const mpm::TileBatch<Dim, Real>& batch) const {
    const auto& lowest = batch.nodes.first;
    const auto is_near = [&](std::int32_t node) { return near_[t][static_cast<std::size_t>(node)] != 0; };
    return batch.nodes.runs == 1 ? is_near(lowest[0]) : std::any_of(lowest.begin(), lowest.end(), is_near);
  }

  // What the nodes of active block b know.
  [[nodiscard]] const Block& block(std::size_t b) const { return blocks_[static_cast<std::size_t>(number_[b])]; }
  [[nodiscard]] bool any_candidate(std::size_t b) const {
    return any_candidate_[static_cast<std::size_t>(number_[b])] != 0;
  }

 private:
  // By place in a tile's patch: whether a candidate is among the 3^Dim nodes from there on.
  using Near = std::array<std::uint8_t, static_cast<std::size_t>(T::patch_nodes)>;

  void find_near(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t) {
    near_[t].fill(0);
    any_near_[t] = 0;
    if (!any_candidate_about(grid, t)) {
      return;
    }
    const std::int32_t* blocks = grid.blocks_about_tile(t);
    Near candidate{};
    mpm::for_each_direction<Dim>([&](auto d) {
      const auto b = static_cast<std::size_t>(blocks[d]);
      if (any_candidate(b)) {
        mpm::for_shared_nodes<Dim, d>([&](std::size_t in_block, std::size_t in_patch) {
          candidate[in_patch] = block(b)[in_block].candidate ? 1 : 0;
        });
      }
    });
    for (int node = 0; node < T::nodes; ++node) {  // the nearest one
      const typename T::Index nearest = T::node({}, node);
      std::uint8_t& near = near_[t][static_cast<std::size_t>(T::in_patch(below(nearest)))];
      for (int k = 0; k < T::stencil; ++k) {
        typename T::Index seen = nearest;
        for (int a = 0, rest = k; a < Dim; ++a, rest /= 3) {
          seen[static_cast<std::size_t>(a)] += rest % 3 - 1;
        }
        near |= candidate[static_cast<std::size_t>(T::in_patch(seen))];
      }
    }
    any_near_[t] = std::any_of(near_[t].begin(), near_[t].end(), [](std::uint8_t near) { return near != 0; }) ? 1 : 0;
  }
  static typename T::Index below(typename T::Index node) {
    for (int& along : node) {
      --along;
    }
    return node;
  }

  KeyIndex index_;  // block key -> place in blocks_
  std::vector<Block> blocks_;
  std::vector<std::uint8_t> any_candidate_;
  std::vector<std::int32_t> number_;  // active block -> place in blocks_
  std::vector<Near> near_;            // by tile
  std::vector<std::uint8_t> any_near_;
};

}  // namespace thawslide::terrain
