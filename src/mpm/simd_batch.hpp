// Particles worked on at once, a lane each. Batches follow the canonical order; where they begin depends on how
// particles stand in memory, so nothing that a particle gets may depend on its neighbours in the batch, and sums over
// particles go lane after lane.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/simd.hpp"
#include "mpm/scalar_index.hpp"

namespace thawslide::mpm {

template <class Real>
struct SimdBatch {
  using Value = Simd<Real>;
  static constexpr std::size_t most = simd_width<Real>;

  std::array<std::uint32_t, most> particle;  // by lane; lanes from `count` on repeat the last one
  std::size_t count;
  bool contiguous;  // the particles fill `most` places in memory from a multiple of `most` on

  // Adds up a quantity lane after lane.
  THAWSLIDE_ALWAYS_INLINE void add_to(Real& sum, const Simd<Real>& quantity) const {
    alignas(sizeof(Simd<Real>)) Real numbers[most];
    quantity.store(numbers);
    for (std::size_t lane = 0; lane < count; ++lane) {
      sum += numbers[lane];
    }
  }
  // of(particle), lane by lane.
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

// The batch of particles first, first + 1, ... of `size` particles as they stand in memory; first is a multiple of the
// lanes.
template <class Real>
THAWSLIDE_ALWAYS_INLINE SimdBatch<Real> batch_in_memory(std::size_t first, std::size_t size) {
  SimdBatch<Real> batch;
  batch.count = std::min(SimdBatch<Real>::most, size - first);
  batch.contiguous = batch.count == SimdBatch<Real>::most;
  const auto from = static_cast<std::uint32_t>(first), last = static_cast<std::uint32_t>(first + batch.count - 1);
  for (std::uint32_t lane = 0; lane < SimdBatch<Real>::most; ++lane) {
    batch.particle[lane] = std::min(from + lane, last);
  }
  return batch;
}

// The nodes that the particles of a batch see: the places of the lowest ones in their tile's patch.
template <class Real>
struct BatchNodes {
  static constexpr std::uint8_t irregular = 3;

  std::array<std::int32_t, simd_width<Real>> first;  // by lane
  std::uint8_t runs;                                 // of lanes that see the same nodes: 1, 2 or many
  std::uint8_t second_run_begin;                     // first lane of the second of two
  bool goes_on;                                      // the next batch begins with a particle that sees the last's nodes
};

// A batch of one tile and one material. It and its nodes hold until some particle of the tile has another nearest node.
template <int Dim, class Real>
struct TileBatch : SimdBatch<Real> {
  std::array<std::array<std::int32_t, simd_width<Real>>, Dim> nearest;  // numbers of the nearest node, by axis
  BatchNodes<Real> nodes;                                               // 3 an axis, from the one before the nearest
};

}  // namespace thawslide::mpm
