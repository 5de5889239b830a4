// Mass that counts for front, runout and travel distance, and its bodies at t = 0. A body at rest is no part of it.
#pragma once

#include <cmath>
#include <vector>

#include "mpm/front.hpp"

namespace thawslide::sim {

// Mass that has moved by more than time.moved_distance; all mass while that is no more than 0.5 %.
struct MovedMass {
  Real distance = -1;   // [m]; negative: all mass
  double mass = 0.0;    // of `bodies`, whether it has moved or not [kg]
  mpm::BodySet bodies;  // with mass that has moved

  [[nodiscard]] bool has(std::size_t body) const { return distance < Real(0) || bodies.contains(body); }
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
