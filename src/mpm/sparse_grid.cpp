#include "mpm/sparse_grid.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

#include "base/instances.hpp"
#include "base/parallel.hpp"

namespace thawslide::mpm {

namespace {

constexpr std::size_t keys_per_task = 1024;
constexpr std::int32_t never = std::numeric_limits<std::int32_t>::min();  // the number of a nearest node

template <int Dim>
typename Tile<Dim>::Index neighbour(const typename Tile<Dim>::Index& tile, int direction) {
  typename Tile<Dim>::Index other = tile;
  for (int a = 0; a < Dim; ++a) {
    other[static_cast<std::size_t>(a)] += direction % 3 - 1;
    direction /= 3;
  }
  return other;
}

// Place in nearest_ of a particle's number along an axis: as many particles as lanes side by side, axis after axis.
template <int Dim, class Real>
std::size_t in_nearest(std::size_t particle, std::size_t axis) {
  constexpr std::size_t most = Batch<Real>::most;
  return (particle / most * Dim + axis) * most + particle % most;
}

// Places of nodes in the patch of a tile, from their numbers along the axes.
template <int Dim, class Real>
BatchNodes<Real> nodes_from(std::uint64_t tile_key, const Vector<Lanes<Real>, Dim>& lowest) {
  using T = Tile<Dim>;
  const typename T::Index tile = T::index(tile_key);
  Lanes<Real> place = Real(0);
  for (int a = Dim - 1; a >= 0; --a) {
    const auto before = static_cast<Real>(tile[static_cast<std::size_t>(a)] * T::edge - 1);
    place = place * Real(T::patch_edge) + (lowest[a] - before);
  }
  BatchNodes<Real> nodes;
  place.store_whole(nodes.first.data());
  nodes.shared = !any(place != Lanes<Real>(place[0]));
  return nodes;
}

}  // namespace

template <int Dim, class Real>
void SparseGrid<Dim, Real>::update(Particles<Dim, Real>& particles, int interval) {
  const std::size_t count = particles.size();
  const bool first_call = order_.size() != count;
  if (first_call) {
    keys_.assign(count, ~std::uint64_t{0});
    moved_.assign(count + Batch<Real>::most, 0);
    forget_nearest(count);
    one_material_ = true;
    for (std::size_t p = 0; p < count; ++p) {
      one_material_ = one_material_ && particles.material(p) == particles.material(0);
    }
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0u);
  }
  const bool any_moved = compute_keys(particles);
  if (any_moved) {
    merge_moved(particles);
  }
  if (first_call || ++calls_ >= interval) {
    calls_ = 0;
    particles.reorder(order_);
    std::vector<std::uint64_t> keys(count);
    std::vector<std::int32_t> nearest(nearest_.size(), never);
    for (std::size_t k = 0; k < count; ++k) {
      keys[k] = keys_[order_[k]];
      for (std::size_t a = 0; a < Dim; ++a) {
        nearest[in_nearest<Dim, Real>(k, a)] = nearest_[in_nearest<Dim, Real>(order_[k], a)];
      }
    }
    keys_.swap(keys);
    nearest_.swap(nearest);
    std::iota(order_.begin(), order_.end(), 0u);
  }
  blocks_changed_ = false;
  if (any_moved || first_call) {
    find_tiles();
  }
  batches_.resize(tiles_.size());
  parallel_for(tiles_.size(), [&](std::size_t t) { make_batches(particles, t); });
}

// The next keys are computed whether or not particles have moved.
template <int Dim, class Real>
void SparseGrid<Dim, Real>::forget_nearest(std::size_t count) {
  nearest_.assign((count + Batch<Real>::most) * Dim, never);
}

// Most particles have the nearest node that they had before, and nothing to do.
template <int Dim, class Real>
bool SparseGrid<Dim, Real>::compute_keys(const Particles<Dim, Real>& particles) {
  const std::size_t count = particles.size();
  const std::size_t tasks = (count + keys_per_task - 1) / keys_per_task;
  std::vector<std::uint8_t> task_moved(tasks, 0);
  parallel_for(tasks, [&](std::size_t task) {
    const std::size_t last = std::min(count, (task + 1) * keys_per_task);
    for (std::size_t first = task * keys_per_task; first < last; first += Batch<Real>::most) {
      const auto batch = batch_in_memory<Real>(first, last);
      constexpr std::size_t most = Batch<Real>::most;
      std::int32_t nearest[Dim * most];
      for (int a = 0; a < Dim; ++a) {
        floor(particles.position.load(batch, a) * inverse_cell_ + Real(0.5))
            .store_whole(nearest + static_cast<std::size_t>(a) * most);
      }
      std::fill_n(&moved_[first], most, std::uint8_t{0});
      if (std::memcmp(nearest, &nearest_[first * Dim], sizeof nearest) == 0) {
        continue;
      }
      std::copy_n(nearest, Dim * most, &nearest_[first * Dim]);
      for (std::size_t lane = 0; lane < batch.count; ++lane) {
        Index node{}, tile{};
        int local = 0;
        for (std::size_t a = 0; a < Dim; ++a) {
          node[a] = nearest[a * most + lane];
        }
        T::split(node, tile, local);
        const std::uint64_t key = (T::key(tile) << T::node_bits) | static_cast<std::uint64_t>(local);
        const std::size_t p = first + lane;
        moved_[p] = key != keys_[p] ? 1 : 0;
        keys_[p] = key;
        task_moved[task] |= moved_[p];
      }
    }
  });
  return std::any_of(task_moved.begin(), task_moved.end(), [](std::uint8_t moved) { return moved != 0; });
}

// Those that stayed are still in order; those that moved are sorted and merged in.
template <int Dim, class Real>
void SparseGrid<Dim, Real>::merge_moved(const Particles<Dim, Real>& particles) {
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return keys_[a] != keys_[b] ? keys_[a] < keys_[b] : particles.id(a) < particles.id(b);
  };
  std::vector<std::uint32_t> movers;
  spare_order_.clear();
  for (const std::uint32_t p : order_) {
    (moved_[p] != 0 ? movers : spare_order_).push_back(p);
  }
  std::sort(movers.begin(), movers.end(), before);
  std::merge(spare_order_.begin(), spare_order_.end(), movers.begin(), movers.end(), order_.begin(), before);
}

template <int Dim, class Real>
void SparseGrid<Dim, Real>::mark_blocks_about(const std::vector<std::uint8_t>& tiles,
                                              std::vector<std::uint8_t>& blocks) const {
  blocks.assign(blocks_.size(), 0);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    for (std::size_t d = 0; d < stencil && tiles[t] != 0; ++d) {
      blocks[static_cast<std::size_t>(blocks_about_tile(t)[d])] = 1;
    }
  }
}

template <int Dim, class Real>
void SparseGrid<Dim, Real>::find_tiles() {
  tiles_.clear();
  const std::vector<std::uint64_t> old_keys = std::move(tile_keys_);
  tile_keys_.clear();
  for (std::uint32_t k = 0; k < order_.size(); ++k) {
    const std::uint64_t key = keys_[order_[k]] >> T::node_bits;
    if (tiles_.empty() || tiles_.back().key != key) {
      tiles_.push_back({key, k, k});
      tile_keys_.push_back(key);
    }
    tiles_.back().last = k + 1;
  }
  if (tile_keys_ != old_keys) {
    connect_blocks();
    blocks_changed_ = true;
  }
}

// Four particles (as many as lanes) that stand side by side in memory go together, the others fill up batches.
template <int Dim, class Real>
void SparseGrid<Dim, Real>::make_batches(const Particles<Dim, Real>& particles, std::size_t t) {
  constexpr std::size_t most = Batch<Real>::most;
  const OccupiedTile& tile = tiles_[t];
  const auto material = [&](std::uint32_t k) { return one_material_ ? 0 : particles.material(order_[k]); };
  const auto side_by_side = [&](std::uint32_t k) {
    bool same = order_[k] % most == 0 && k + most <= tile.last;
    for (std::uint32_t lane = 1; same && lane < most; ++lane) {
      same = order_[k + lane] == order_[k] + lane && material(k + lane) == material(k);
    }
    return same;
  };
  auto& batches = batches_[t];
  batches.clear();
  for (std::uint32_t k = tile.first; k < tile.last;) {
    TileBatch<Dim, Real> batch;
    batch.whole = side_by_side(k);
    batch.count = 0;
    const std::int32_t of_one = material(k);
    while (batch.count < most && k < tile.last && material(k) == of_one &&
           (batch.whole || batch.count == 0 || !side_by_side(k))) {
      batch.particle[batch.count++] = order_[k++];
    }
    for (std::size_t lane = batch.count; lane < most; ++lane) {
      batch.particle[lane] = batch.particle[batch.count - 1];
    }
    Vector<Lanes<Real>, Dim> before_nearest, corner;
    for (int a = 0; a < Dim; ++a) {
      auto& nearest = batch.nearest[static_cast<std::size_t>(a)];
      if (batch.whole) {
        std::copy_n(&nearest_[in_nearest<Dim, Real>(batch.particle[0], static_cast<std::size_t>(a))], most,
                    nearest.begin());
      }
      for (std::size_t lane = 0; !batch.whole && lane < most; ++lane) {
        nearest[lane] = nearest_[in_nearest<Dim, Real>(batch.particle[lane], static_cast<std::size_t>(a))];
      }
      before_nearest[a] = Lanes<Real>::load_whole(nearest.data()) - Real(1);
      corner[a] = floor(particles.position.load(batch, a) * inverse_cell_);
    }
    batch.nodes = nodes_from<Dim, Real>(tile.key, before_nearest);
    batch.hats = nodes_from<Dim, Real>(tile.key, corner);
    batches.push_back(batch);
  }
}

template <int Dim, class Real>
void SparseGrid<Dim, Real>::connect_blocks() {
  blocks_.clear();
  KeyIndex tile_number;
  for (const OccupiedTile& tile : tiles_) {
    tile_number.insert(tile.key);
    const Index here = T::index(tile.key);
    for (int d = 0; d < T::stencil; ++d) {
      blocks_.push_back(T::key(neighbour<Dim>(here, d)));
    }
  }
  std::sort(blocks_.begin(), blocks_.end());
  blocks_.erase(std::unique(blocks_.begin(), blocks_.end()), blocks_.end());

  KeyIndex block_number;
  tiles_about_block_.resize(blocks_.size() * stencil);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    block_number.insert(blocks_[b]);
    for (int d = 0; d < T::stencil; ++d) {
      tiles_about_block_[b * stencil + static_cast<std::size_t>(d)] =
          tile_number.find(T::key(neighbour<Dim>(T::index(blocks_[b]), d)));
    }
  }
  blocks_about_block_.resize(blocks_.size() * stencil);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    for (int d = 0; d < T::stencil; ++d) {
      blocks_about_block_[b * stencil + static_cast<std::size_t>(d)] =
          block_number.find(T::key(neighbour<Dim>(T::index(blocks_[b]), d)));
    }
  }
  blocks_about_tile_.resize(tiles_.size() * stencil);
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    for (int d = 0; d < T::stencil; ++d) {
      blocks_about_tile_[t * stencil + static_cast<std::size_t>(d)] =
          block_number.find(T::key(neighbour<Dim>(T::index(tiles_[t].key), d)));
    }
  }
}

#define THAWSLIDE_INSTANTIATE(Dim, Real) template class SparseGrid<Dim, Real>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
