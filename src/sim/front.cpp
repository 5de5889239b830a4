#include "sim/front.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace thawslide::sim {

namespace {

constexpr double front_share = 0.995;

}  // namespace

MassOnWay front_of(std::vector<MassOnWay>& masses) {
  THAWSLIDE_ASSERT(!masses.empty(), "the front of {} particles", masses.size());
  double mass = 0.0;
  for (const MassOnWay& particle : masses) {
    mass += particle.mass;
  }
  // The foremost few, one by one, until what lies behind is less than the share.
  std::make_heap(masses.begin(), masses.end());
  double ahead = 0.0;
  for (auto end = masses.end(); end - masses.begin() > 1; --end) {
    ahead += masses.front().mass;
    if (mass - ahead < front_share * mass) {
      break;
    }
    std::pop_heap(masses.begin(), end);
  }
  return masses.front();
}

}  // namespace thawslide::sim
