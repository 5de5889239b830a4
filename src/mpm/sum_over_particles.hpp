// Sums over all particles, in an order that does not depend on how many threads there are.
#pragma once

#include <cstdint>

#include "base/parallel.hpp"
#include "mpm/sparse_grid.hpp"

namespace thawslide::mpm {

// of_particle(p): what particle p brings. In canonical order tile by tile, and then tiles as base/sum_order.hpp has it:
// as a device sums.
template <class Sum, int Dim, class Real, class OfParticle>
[[nodiscard]] Sum sum_over_particles(const SparseGrid<Dim, Real>& grid, const OfParticle& of_particle) {
  return parallel_sum<Sum>(grid.tiles().size(), [&](std::size_t t, Sum& sum) {
    for (std::uint32_t k = grid.tiles()[t].first; k < grid.tiles()[t].last; ++k) {
      sum += of_particle(grid.order()[k]);
    }
  });
}

}  // namespace thawslide::mpm
