// Batch of particles processed at once, one per SIMD lane. Batches follow the canonical order, but their boundaries
// depend on the order in memory. Results of a particle must therefore be independent of its neighbours in the batch,
// and sums over particles run in the order of lanes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/simd.hpp"
#include "mpm/scalar_index.hpp"

namespace thawslide::mpm {

struct SimdBatch {
  using Value = Simd<double>;
  static constexpr std::size_t most = simd_width<double>;

  std::array<std::uint32_t, most> particle;  // by lane; lanes from `count` on repeat the last one
  std::size_t count;
  bool contiguous;  // the particles are `most` consecutive ones in memory, starting at a multiple of `most`

  // Adds a quantity in the order of lanes.
  THAWSLIDE_ALWAYS_INLINE void add_to(double& sum, const Simd<double>& quantity) const {
    alignas(sizeof(Simd<double>)) double numbers[most];
    quantity.store(numbers);
    for (std::size_t lane = 0; lane < count; ++lane) {
      sum += numbers[lane];
    }
  }
  // of(particle), by lane.
  template <class Of>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE Value each(const Of& of) const {
    return Value::of([&](std::size_t lane) { return of(particle[lane]); });
  }
  template <class Body>
  void for_each(const Body& body) const {
    for (std::size_t lane = 0; lane < count; ++lane) {
      body(particle[lane]);
    }
  }
};

// Batch of particles first, first + 1, ... of `size` particles in memory order; first is a multiple of the lane count.
THAWSLIDE_ALWAYS_INLINE SimdBatch batch_in_memory(std::size_t first, std::size_t size) {
  SimdBatch batch;
  batch.count = std::min(SimdBatch::most, size - first);
  batch.contiguous = batch.count == SimdBatch::most;
  const auto from = static_cast<std::uint32_t>(first), last = static_cast<std::uint32_t>(first + batch.count - 1);
  for (std::uint32_t lane = 0; lane < SimdBatch::most; ++lane) {
    batch.particle[lane] = std::min(from + lane, last);
  }
  return batch;
}

// Nodes in reach of the particles of a batch: places of the lowest ones in the tile's patch.
struct BatchNodes {
  static constexpr std::uint8_t irregular = 3;

  std::array<std::int32_t, simd_width<double>> first;  // by lane
  std::uint8_t runs;                                   // runs of lanes with the same nodes: 1, 2 or `irregular`
  std::uint8_t second_run_begin;                       // first lane of the second of two runs
  bool continues;  // the next batch begins with a particle of the same nodes as the last one of this batch
};

// Batch of one tile and one material. It remains valid until the nearest node of a particle of the tile changes.
template <int Dim>
struct TileBatch : SimdBatch {
  std::array<std::array<std::int32_t, simd_width<double>>, Dim> nearest;  // index of the nearest node, by axis
  BatchNodes nodes;                                                       // 3 per axis, from the one before the nearest
};

}  // namespace thawslide::mpm
