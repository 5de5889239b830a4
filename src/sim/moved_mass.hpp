// Mass that counts for front, runout and travel distance, and its bodies at t = 0. A body at rest is no part of it.
#pragma once

#include <cmath>
#include <vector>

#include "mpm/front.hpp"

namespace thawslide::sim {

// Bodies of which a part has moved by more than time.moved_distance; all bodies while no more than 0.5 % of their mass
// has moved that far.
struct MovedMass {
  bool all = true;
  double mass = 0.0;  // of the bodies [kg]
  mpm::BodySet bodies{};

  [[nodiscard]] bool has(std::size_t body) const { return all || bodies.contains(body); }
};

// Body at t = 0 along the x axis [m].
struct BodyAtStart {
  double mass = 0.0;       // [kg]; 0 without particles
  double direction = 1.0;  // in which it leaves, 1 or -1
  double lower = HUGE_VAL, upper = -HUGE_VAL;

  // Calls visit(number) for each number in a checkpoint, in order.
  template <class Visit>
  void for_each(const Visit& visit) {
    for (double* number : {&mass, &direction, &lower, &upper}) {
      visit(*number);
    }
  }
};

}  // namespace thawslide::sim
