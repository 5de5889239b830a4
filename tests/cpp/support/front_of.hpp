// Front of particles (mpm/front.hpp) along any measure of distance.
#pragma once

#include <algorithm>
#include <vector>

#include "mpm/front.hpp"

namespace thawslide::testing_support {

struct MassOnPath {
  double along, mass;  // [m, kg]
};

// Distance behind which 99.5 % of the mass is.
inline double front_of(std::vector<MassOnPath> masses) {
  std::sort(masses.begin(), masses.end(), [](const MassOnPath& a, const MassOnPath& b) { return a.along > b.along; });
  double mass = 0.0;
  for (const MassOnPath& one : masses) {
    mass += one.mass;
  }
  mpm::FrontSearch search(mass);
  return std::find_if(masses.begin(), masses.end(), [&](const MassOnPath& one) { return search.is_at(one.mass); })
      ->along;
}

}  // namespace thawslide::testing_support
