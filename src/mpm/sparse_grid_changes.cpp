// Particles added, removed or moved to another layer between two steps.
#include <algorithm>
#include <utility>

#include "base/instances.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::mpm {

template <int Dim>
void SparseGrid<Dim>::set_layers(std::vector<std::uint8_t> layer_of_body) {
  if (layer_of_body != layer_of_body_) {
    layer_of_body_ = std::move(layer_of_body);
    std::fill(nearest_.begin(), nearest_.end(), never);  // all keys are computed again
  }
}

// New particles have no nearest node yet.
template <int Dim>
void SparseGrid<Dim>::add_appended(const Particles<Dim>& particles) {
  const std::size_t before = keys_.size(), count = particles.size();
  keys_.resize(count, no_key);
  moved_.resize(count + SimdBatch::most, 0);
  nearest_.resize((count + SimdBatch::most) * Dim, never);
  for (std::size_t p = before; p < count; ++p) {
    for (std::size_t a = 0; a < Dim; ++a) {
      nearest_[in_nearest(p, a)] = never;
    }
    one_material_ = one_material_ && particles.material(p) == particles.material(0);
  }
}

template <int Dim>
void SparseGrid<Dim>::remove(const Particles<Dim>& particles, const std::vector<std::uint32_t>& now_at) {
  const std::size_t count = particles.size();
  for (std::size_t p = count; p < now_at.size(); ++p) {
    if (now_at[p] != Particles<Dim>::nowhere) {
      keys_[now_at[p]] = keys_[p];
      for (std::size_t a = 0; a < Dim; ++a) {
        nearest_[in_nearest(now_at[p], a)] = nearest_[in_nearest(p, a)];
      }
    }
  }
  keys_.resize(count);
  moved_.resize(count + SimdBatch::most);
  nearest_.resize((count + SimdBatch::most) * Dim);
  drop_from_tiles(now_at);
  order_.resize(count);
  make_stale_batches(particles);
}

// Drops removed particles from order and tiles. Tiles are stale if their particles changed or moved in memory.
template <int Dim>
void SparseGrid<Dim>::drop_from_tiles(const std::vector<std::uint32_t>& now_at) {
  std::uint32_t placed = 0;
  std::size_t tiles = 0;
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    OccupiedTile tile = tiles_[t];
    std::uint8_t stale = 0;
    const std::uint32_t first = placed;
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = order_[k], now = now_at[p];
      stale = now != p ? 1 : stale;
      if (now != Particles<Dim>::nowhere) {
        order_[placed++] = now;
      }
    }
    if (placed > first) {
      tiles_[tiles] = {tile.key, first, placed};
      batches_[tiles].swap(batches_[t]);
      made_[tiles] = made_[t];
      stale_[tiles] = stale;
      ++tiles;
    }
  }
  blocks_changed_ = tiles < tiles_.size();
  tiles_.resize(tiles);
  batches_.resize(tiles);
  made_.resize(tiles);
  stale_.resize(tiles);
  if (blocks_changed_) {
    list_blocks();
    connect_blocks();
  }
}

#define THAWSLIDE_INSTANTIATE(Dim)                                      \
  template void SparseGrid<Dim>::set_layers(std::vector<std::uint8_t>); \
  template void SparseGrid<Dim>::add_appended(const Particles<Dim>&);   \
  template void SparseGrid<Dim>::remove(const Particles<Dim>&, const std::vector<std::uint32_t>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
