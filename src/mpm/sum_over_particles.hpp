// Sums over all particles in an order independent of the number of threads.
#pragma once

#include <cstdint>

#include "base/parallel.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::mpm {

// of_particle(p): contribution of particle p. The order is canonical within tiles, and that of base/sum_order.hpp over
// tiles, as on a device.
template <class Sum, int Dim, class OfParticle>
[[nodiscard]] Sum sum_over_particles(const SparseGrid<Dim>& grid, const OfParticle& of_particle) {
  return parallel_sum<Sum>(grid.tiles().size(), [&](std::size_t t, Sum& sum) {
    for (std::uint32_t k = grid.tiles()[t].first; k < grid.tiles()[t].last; ++k) {
      sum += of_particle(grid.order()[k]);
    }
  });
}

}  // namespace thawslide::mpm
