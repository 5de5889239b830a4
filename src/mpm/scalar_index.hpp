// Index of a single particle, for kernels that otherwise process a batch.
#pragma once

#include <array>
#include <cstdint>

#include "base/portability.hpp"

namespace thawslide::mpm {

struct ScalarIndex {
  using Value = double;

  std::array<std::uint32_t, 1> particle;

  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void add_to(double& sum, double quantity) const { sum += quantity; }
  template <class Of>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value each(const Of& of) const {
    return of(particle[0]);
  }
  template <class Body>
  THAWSLIDE_HD void for_each(const Body& body) const {
    body(particle[0]);
  }
};

}  // namespace thawslide::mpm
