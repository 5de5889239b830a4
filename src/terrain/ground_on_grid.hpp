// The ground at the nodes of the active blocks: computed when a block is first seen, remembered afterwards.
#pragma once

#include <array>
#include <vector>

#include "base/key_index.hpp"
#include "mpm/nodes.hpp"
#include "terrain/ground.hpp"

namespace thawslide::terrain {

template <int Dim, class Real>
class GroundOnGrid {
 public:
  using Block = std::array<GroundAtNode<Dim, Real>, static_cast<std::size_t>(mpm::Tile<Dim>::nodes)>;

  // Brings block numbers up to date; to be called after the grid's blocks changed.
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
  }

  // What the nodes of active block b know.
  [[nodiscard]] const Block& block(std::size_t b) const { return blocks_[static_cast<std::size_t>(number_[b])]; }
  [[nodiscard]] bool any_candidate(std::size_t b) const {
    return any_candidate_[static_cast<std::size_t>(number_[b])] != 0;
  }

 private:
  KeyIndex index_;  // block key -> place in blocks_
  std::vector<Block> blocks_;
  std::vector<std::uint8_t> any_candidate_;
  std::vector<std::int32_t> number_;  // active block -> place in blocks_
};

}  // namespace thawslide::terrain
