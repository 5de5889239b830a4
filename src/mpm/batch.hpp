// Particles worked on at once, a lane each. Batches follow the canonical order; where they begin depends on how
// particles stand in memory, so nothing that a particle gets may depend on its neighbours in the batch, and sums over
// particles go lane after lane.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/lanes.hpp"

namespace thawslide::mpm {

template <class Real>
struct Batch {
  static constexpr std::size_t most = lane_count<Real>;

  std::array<std::uint32_t, most> particle;  // by lane; lanes from `count` on repeat the last one
  std::size_t count;
  bool whole;  // the particles fill `most` places in memory from a multiple of `most` on

  // Adds up a quantity lane after lane.
  THAWSLIDE_ALWAYS_INLINE void add_to(Real& sum, const Lanes<Real>& quantity) const {
    alignas(sizeof(Lanes<Real>)) Real numbers[most];
    quantity.store(numbers);
    for (std::size_t lane = 0; lane < count; ++lane) {
      sum += numbers[lane];
    }
  }
};

// The batch of particles first, first + 1, ... of `size` particles as they stand in memory; first is a multiple of the
// lanes.
template <class Real>
Batch<Real> batch_in_memory(std::size_t first, std::size_t size) {
  Batch<Real> batch;
  batch.count = std::min(Batch<Real>::most, size - first);
  batch.whole = batch.count == Batch<Real>::most;
  for (std::size_t lane = 0; lane < Batch<Real>::most; ++lane) {
    batch.particle[lane] = static_cast<std::uint32_t>(first + std::min(lane, batch.count - 1));
  }
  return batch;
}

// Calls work(batch) for batches that together are order[first .. last-1].
template <class Real, class Work>
THAWSLIDE_ALWAYS_INLINE void for_each_batch(const std::vector<std::uint32_t>& order, std::uint32_t first,
                                            std::uint32_t last, const Work& work) {
  constexpr std::size_t most = Batch<Real>::most;
  const auto side_by_side = [&](std::uint32_t k) {
    bool same = order[k] % most == 0 && k + most <= last;
    for (std::size_t lane = 1; same && lane < most; ++lane) {
      same = order[k + lane] == order[k] + lane;
    }
    return same;
  };
  for (std::uint32_t k = first; k < last;) {
    Batch<Real> batch;
    batch.whole = side_by_side(k);
    batch.count = 0;
    while (batch.count < most && k < last && (batch.whole || batch.count == 0 || !side_by_side(k))) {
      batch.particle[batch.count++] = order[k++];
    }
    for (std::size_t lane = batch.count; lane < most; ++lane) {
      batch.particle[lane] = batch.particle[batch.count - 1];
    }
    work(batch);
  }
}

}  // namespace thawslide::mpm
