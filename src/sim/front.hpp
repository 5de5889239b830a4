// The front of a slide (mpm/front.hpp) among particles in the processor's memory.
#pragma once

#include <cstddef>
#include <vector>

namespace thawslide::sim {

// A particle on the way that the front is measured on.
struct MassOnWay {
  double along, mass;  // [m, kg]
  std::size_t rank;    // in canonical order; of particles equally far the one of the higher rank counts as further

  [[nodiscard]] bool operator<(const MassOnWay& other) const {
    return along < other.along || (along == other.along && rank < other.rank);
  }
};

// The particle up to which 99.5 % of the mass [kg] has come, which is that of all together. Changes the order of
// `masses`, which are not empty.
[[nodiscard]] MassOnWay front_of(std::vector<MassOnWay>& masses, double mass);

}  // namespace thawslide::sim
