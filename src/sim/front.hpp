// The front of a slide (mpm/front.hpp) among particles in the processor's memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/error.hpp"
#include "mpm/front.hpp"

namespace thawslide::sim {

// A particle on the way that the front is measured on.
struct MassOnPath {
  double along, mass;  // [m, kg]
  std::size_t rank;    // in canonical order; of particles equally far the one of the higher rank counts as further

  [[nodiscard]] bool operator<(const MassOnPath& other) const {
    return along < other.along || (along == other.along && rank < other.rank);
  }
};

// The particle up to which 99.5 % of the mass [kg] has come, which is that of all together. Changes the order of
// `masses`, which are not empty.
[[nodiscard]] inline MassOnPath front_of(std::vector<MassOnPath>& masses, double mass) {
  THAWSLIDE_ASSERT(!masses.empty(), "the front of {} particles", masses.size());
  mpm::FrontSearch search(mass);
  std::make_heap(masses.begin(), masses.end());
  for (auto end = masses.end(); end - masses.begin() > 1 && !search.is_at(masses.front().mass); --end) {
    std::pop_heap(masses.begin(), end);
  }
  return masses.front();
}

}  // namespace thawslide::sim
