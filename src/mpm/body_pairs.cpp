// Pairs of blocks at the same place whose bodies may touch.
#include <algorithm>
#include <tuple>

#include "base/instances.hpp"
#include "mpm/body_contact.hpp"

namespace thawslide::mpm {

template <int Dim>
void BodyContact<Dim>::find_pairs(const SparseGrid<Dim>& grid, const BetweenBodies& between) {
  pairs_.clear();
  for (std::size_t b = 0; b < grid.blocks().size(); ++b) {
    const std::uint64_t key = grid.blocks()[b];
    const auto own_layer = static_cast<std::size_t>(T::layer(key));
    // Held bodies are in the last layers, and do not act on one another.
    for (std::size_t layer = own_layer + 1; !between.is_held(own_layer) && layer < between.all_layers(); ++layer) {
      const std::int32_t other = grid.block_at(T::in_layer(T::without_layer(key), layer));
      if (other != KeyIndex::absent) {
        pairs_.push_back({T::without_layer(key),
                          b,
                          static_cast<std::size_t>(other),
                          between.is_held(layer),
                          between.friction_between(own_layer, layer),
                          {}});
      }
    }
  }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.tile, a.block, a.other) < std::tie(b.tile, b.block, b.other);
  });
  first_of_tile_.clear();
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (k == 0 || pairs_[k].tile != pairs_[k - 1].tile) {
      first_of_tile_.push_back(k);
    }
  }
  first_of_tile_.push_back(pairs_.size());
}

#define THAWSLIDE_INSTANTIATE(Dim) \
  template void BodyContact<Dim>::find_pairs(const SparseGrid<Dim>&, const BetweenBodies&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
