#include "mpm/sparse_grid.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"

namespace thawslide::mpm {

namespace {

constexpr std::size_t keys_per_task = 1024;
// Sorting takes about as long as the slowdown of this number of steps with all particles out of order.
constexpr double most_scattered = 4;
constexpr std::size_t none = ~std::size_t{0};

// Places of nodes in the patch of a tile, from their indices along the axes.
template <int Dim>
BatchNodes nodes_from(std::uint64_t tile_key, const Vector<Simd<double>, Dim>& lowest) {
  using T = Tile<Dim>;
  const typename T::Index tile = T::index(tile_key);
  Simd<double> index = 0.0;
  for (int a = Dim - 1; a >= 0; --a) {
    const auto before = static_cast<double>(tile[static_cast<std::size_t>(a)] * T::edge - 1);
    index = index * double(T::patch_edge) + (lowest[a] - before);
  }
  BatchNodes nodes;
  index.store_whole(nodes.first.data());
  nodes.runs = 1;
  nodes.second_run_begin = 0;
  for (std::uint8_t lane = 1; lane < simd_width<double>; ++lane) {
    if (nodes.first[lane] != nodes.first[lane - 1u]) {
      nodes.second_run_begin = nodes.runs == 1 ? lane : nodes.second_run_begin;
      nodes.runs = nodes.runs == 1 ? 2 : BatchNodes::irregular;
    }
  }
  return nodes;
}

}  // namespace

template <int Dim>
void SparseGrid<Dim>::update(Particles<Dim>& particles, int interval) {
  const bool first_call = keys_.empty();
  THAWSLIDE_ASSERT(particles.size() >= keys_.size(), "{} particles are left of {}, and which is not known",
                   particles.size(), keys_.size());
  if (particles.size() > keys_.size()) {
    add_appended(particles);
  }
  blocks_changed_ = false;
  stale_.assign(tiles_.size(), 0);
  if (compute_keys(particles)) {
    merge_moved(particles);
  }
  if (first_call) {  // later steps move only few particles
    task_movers_ = std::vector<std::vector<CellChange>>();
    movers_ = std::vector<CellChange>();
  }
  const bool sorts = first_call || (interval > 0 && (++calls_ >= interval || disorder_ >= most_scattered));
  if (sorts) {
    reorder(particles);
  }
  batches_.resize(tiles_.size());
  made_.resize(tiles_.size());
  make_stale_batches(particles);
  update_sort_heuristic(sorts);
}

// Cost of the order in memory: batches that are not contiguous, minus those right after sorting, summed over the steps
// since the last sorting.
template <int Dim>
void SparseGrid<Dim>::update_sort_heuristic(bool sorted) {
  const std::size_t broken =
      std::accumulate(made_.begin(), made_.end(), std::size_t{0},
                      [](std::size_t sum, const MadeBatches& of_tile) { return sum + of_tile.broken; });
  if (sorted) {
    calls_ = 0;
    disorder_ = 0;
    fewest_broken_ = broken;
  } else if (broken > fewest_broken_) {
    const std::size_t contiguous = order_.size() / SimdBatch::most + 1;
    disorder_ += static_cast<double>(broken - fewest_broken_) / static_cast<double>(contiguous);
  }
}

// Sorts particles in memory into canonical order.
template <int Dim>
void SparseGrid<Dim>::reorder(Particles<Dim>& particles) {
  particles.reorder(order_);
  for (std::size_t a = 0; a < Dim; ++a) {
    thawslide::reorder<std::int32_t>(
        order_, reorder_buffer_, [&](std::size_t k) { return nearest_[in_nearest(k, a)]; },
        [&](std::size_t k, std::int32_t nearest) { nearest_[in_nearest(k, a)] = nearest; });
  }
  parallel_for(order_.size(), keys_per_task, [&](std::size_t k) { keys_[k] = key_of(particles, k); });
  std::iota(order_.begin(), order_.end(), 0u);
  std::fill(stale_.begin(), stale_.end(), std::uint8_t{1});
}

// Most particles keep their nearest node and need no update.
template <int Dim>
bool SparseGrid<Dim>::compute_keys(const Particles<Dim>& particles) {
  const std::size_t count = particles.size();
  const std::size_t tasks = (count + keys_per_task - 1) / keys_per_task;
  task_movers_.resize(tasks);
  parallel_for(tasks, [&](std::size_t task) {
    constexpr std::size_t most = SimdBatch::most;
    const std::size_t last = std::min(count, (task + 1) * keys_per_task);
    task_movers_[task].clear();
    for (std::size_t first = task * keys_per_task; first < last; first += most) {
      const auto batch = batch_in_memory(first, last);
      std::int32_t nearest[Dim * most];
      for (int a = 0; a < Dim; ++a) {
        floor(mapping_.template coordinate<Dim>(particles, batch, a) * inverse_cell_ + 0.5)
            .store_whole(nearest + static_cast<std::size_t>(a) * most);
      }
      std::fill_n(&moved_[first], most, std::uint8_t{0});
      if (std::memcmp(nearest, &nearest_[first * Dim], sizeof nearest) != 0) {
        std::copy_n(nearest, Dim * most, &nearest_[first * Dim]);
        add_cell_changes(particles, first, batch.count, task_movers_[task]);
      }
    }
  });
  movers_.clear();
  for (const std::vector<CellChange>& movers : task_movers_) {
    movers_.insert(movers_.end(), movers.begin(), movers.end());
  }
  return !movers_.empty();
}

// Key of a particle, from its nearest node and the layer of its body.
template <int Dim>
std::uint64_t SparseGrid<Dim>::key_of(const Particles<Dim>& particles, std::size_t particle) const {
  Index node{}, tile{};
  int local = 0;
  for (std::size_t a = 0; a < Dim; ++a) {
    node[a] = nearest_[in_nearest(particle, a)];
  }
  T::split(node, tile, local);
  const std::uint64_t layer =
      layer_of_body_.empty() ? 0 : layer_of_body_[static_cast<std::size_t>(particles.body(particle))];
  return (T::in_layer(T::key(tile), layer) << T::node_bits) | static_cast<std::uint64_t>(local);
}

// Updates the keys of `count` particles from `first` on, from their nearest nodes.
template <int Dim>
void SparseGrid<Dim>::add_cell_changes(const Particles<Dim>& particles, std::size_t first, std::size_t count,
                                       std::vector<CellChange>& movers) {
  for (std::size_t p = first; p < first + count; ++p) {
    const std::uint64_t key = key_of(particles, p);
    if (key != keys_[p]) {
      movers.push_back({static_cast<std::uint32_t>(p), keys_[p] == no_key ? no_key : keys_[p] >> T::node_bits});
      moved_[p] = 1;
      keys_[p] = key;
    }
  }
}

// Sorts the particles that changed cell and merges them with the others, which are still in order.
template <int Dim>
void SparseGrid<Dim>::merge_moved(const Particles<Dim>& particles) {
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return keys_[a] != keys_[b] ? keys_[a] < keys_[b] : particles.id(a) < particles.id(b);
  };
  std::sort(movers_.begin(), movers_.end(),
            [&](const CellChange& a, const CellChange& b) { return before(a.particle, b.particle); });
  count_leaving();
  list_tiles();
  former_order_.swap(order_);
  order_.resize(particles.size());
  parallel_for(tiles_.size(), [&](std::size_t t) { merge_tile(t, before); });
}

// Order of one tile's particles, from those that stayed in their cell and those that changed cell or tile.
template <int Dim>
template <class Before>
void SparseGrid<Dim>::merge_tile(std::size_t t, const Before& before) {
  const TileChange& change = changes_[t];
  auto to = order_.begin() + tiles_[t].first;
  auto mover = movers_.begin() + static_cast<std::ptrdiff_t>(change.first_mover);
  const auto last_mover = movers_.begin() + static_cast<std::ptrdiff_t>(change.last_mover);
  const OccupiedTile former = change.former != none ? former_tiles_[change.former] : OccupiedTile{};
  const auto from = former_order_.begin() + former.first, end = former_order_.begin() + former.last;
  if (!change.changed) {
    std::copy(from, end, to);
    return;
  }
  for (auto stayed = from; stayed != end; ++stayed) {
    if (moved_[*stayed] != 0) {
      continue;
    }
    for (; mover != last_mover && before(mover->particle, *stayed); ++mover) {
      *to++ = mover->particle;
    }
    *to++ = *stayed;
  }
  for (; mover != last_mover; ++mover) {
    *to++ = mover->particle;
  }
}

template <int Dim>
void SparseGrid<Dim>::count_leaving() {
  leaving_.assign(tiles_.size(), 0);
  for (const CellChange& mover : movers_) {
    if (mover.former_tile != no_key) {
      const auto tile = std::lower_bound(tiles_.begin(), tiles_.end(), mover.former_tile,
                                         [](const OccupiedTile& a, std::uint64_t key) { return a.key < key; });
      ++leaving_[static_cast<std::size_t>(tile - tiles_.begin())];
    }
  }
}

// Lists the occupied tiles, from the former ones and the particles that left or entered.
template <int Dim>
void SparseGrid<Dim>::list_tiles() {
  former_tiles_.swap(tiles_);
  tiles_.clear();
  changes_.clear();
  bool same = true;
  std::uint32_t placed = 0;
  std::size_t former = 0, mover = 0;
  const auto tile_of = [&](const CellChange& one) { return keys_[one.particle] >> T::node_bits; };
  while (former < former_tiles_.size() || mover < movers_.size()) {
    const std::uint64_t key = std::min(former < former_tiles_.size() ? former_tiles_[former].key : no_key,
                                       mover < movers_.size() ? tile_of(movers_[mover]) : no_key);
    TileChange change{none, mover, mover, false};
    std::uint32_t count_here = 0;
    if (former < former_tiles_.size() && former_tiles_[former].key == key) {
      count_here = former_tiles_[former].last - former_tiles_[former].first - leaving_[former];
      change.changed = leaving_[former] > 0;
      change.former = former++;
    }
    for (; mover < movers_.size() && tile_of(movers_[mover]) == key; ++mover) {
      ++count_here;
    }
    change.last_mover = mover;
    change.changed = change.changed || change.first_mover < change.last_mover;
    same = same && change.former != none && count_here > 0;
    if (count_here > 0) {
      tiles_.push_back({key, placed, placed + count_here});
      changes_.push_back(change);
      placed += count_here;
    }
  }
  stale_.resize(tiles_.size());
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    stale_[t] = !same || changes_[t].changed ? 1 : 0;
  }
  if (!same) {
    list_blocks();
    connect_blocks();
    blocks_changed_ = true;
  }
}

template <int Dim>
void SparseGrid<Dim>::mark_blocks_about(const std::vector<std::uint8_t>& tiles,
                                        std::vector<std::uint8_t>& blocks) const {
  blocks.assign(blocks_.size(), 0);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    for (std::size_t d = 0; d < stencil && tiles[t] != 0; ++d) {
      blocks[static_cast<std::size_t>(blocks_about_tile(t)[d])] = 1;
    }
  }
}

template <int Dim>
void SparseGrid<Dim>::make_stale_batches(const Particles<Dim>& particles) {
  parallel_for(tiles_.size(), [&](std::size_t t) {
    if (stale_[t] != 0) {
      make_batches(particles, t);
    }
  });
}

// Forms batches of particles that are consecutive in memory, as many as lanes; the remaining particles fill other
// batches.
template <int Dim>
void SparseGrid<Dim>::make_batches(const Particles<Dim>& particles, std::size_t t) {
  constexpr std::size_t most = SimdBatch::most;
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
  const std::size_t contiguous = (tile.last - tile.first + most - 1) / most;
  batches.reserve(contiguous + contiguous / 8 + 2);  // some batches are not contiguous
  made_[t] = {};
  for (std::uint32_t k = tile.first; k < tile.last;) {
    TileBatch<Dim> batch;
    batch.contiguous = side_by_side(k);
    batch.count = 0;
    const std::int32_t of_one = material(k);
    while (batch.count < most && k < tile.last && material(k) == of_one &&
           (batch.contiguous || batch.count == 0 || !side_by_side(k))) {
      batch.particle[batch.count++] = order_[k++];
    }
    for (std::size_t lane = batch.count; lane < most; ++lane) {
      batch.particle[lane] = batch.particle[batch.count - 1];
    }
    Vector<Simd<double>, Dim> before_nearest;
    for (int a = 0; a < Dim; ++a) {
      auto& nearest = batch.nearest[static_cast<std::size_t>(a)];
      if (batch.contiguous) {
        std::copy_n(&nearest_[in_nearest(batch.particle[0], static_cast<std::size_t>(a))], most, nearest.begin());
      }
      for (std::size_t lane = 0; !batch.contiguous && lane < most; ++lane) {
        nearest[lane] = nearest_[in_nearest(batch.particle[lane], static_cast<std::size_t>(a))];
      }
      before_nearest[a] = Simd<double>::load_whole(nearest.data()) - 1.0;
    }
    batch.nodes = nodes_from<Dim>(tile.key, before_nearest);
    batch.nodes.continues = false;
    if (!batches.empty()) {
      const TileBatch<Dim>& before = batches.back();
      batches.back().nodes.continues = before.nodes.first[before.count - 1] == batch.nodes.first[0];
    }
    batches.push_back(batch);
    made_[t].broken += batch.contiguous ? 0 : 1;
    for (const std::int32_t lowest : batch.nodes.first) {
      made_[t].rows_seen |= T::rows_from(lowest);
    }
  }
}

#define THAWSLIDE_INSTANTIATE(Dim) template class SparseGrid<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::mpm
