// Reductions over all particles: kernels (mpm/kernel.hpp).
#pragma once

#include "band/body_sums.hpp"
#include "mpm/kernel.hpp"
#include "mpm/map_sums.hpp"

namespace thawslide::device {

// Sum of a function of one particle, of(particles, particle).
template <class Sum, class Of>
struct SumOf {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = Sum;

  Of of;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(const Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                               Totals& sums) const {
    sums = of(particles, at.particle[0]);
  }
};

struct MomentsOf {
  template <class Particles>
  THAWSLIDE_HD mpm::MassMoments operator()(const Particles& particles, std::uint32_t p) const {
    return mpm::mass_moments_of(particles, p);
  }
};

}  // namespace thawslide::device
