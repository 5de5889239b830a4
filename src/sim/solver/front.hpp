// Front of a slide (mpm/front.hpp) from particles in host memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/error.hpp"
#include "mpm/front.hpp"

namespace thawslide::sim {

// Particle on the path along which the front is measured.
struct MassOnPath {
  double along, mass;  // [m, kg]
  std::size_t rank;    // in canonical order; ties in distance are broken by the higher rank

  [[nodiscard]] bool operator<(const MassOnPath& other) const {
    return along < other.along || (along == other.along && rank < other.rank);
  }
};

// Particle that has 99.5 % of a mass [kg] behind it. Reorders `masses`, which must not be
// empty.
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
