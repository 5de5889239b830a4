// Mass that counts for front, runout and travel distance, and its bodies at t = 0. A body at rest is no part of it.
#pragma once

#include <cmath>
#include <vector>

#include "mpm/front.hpp"

namespace thawslide::sim {

// Bodies of which a part has moved by more than time.moved_distance; while no more than 0.5 % of their mass has moved
// that far, all bodies that are not held, or all if all are held.
struct MovedMass {
  bool all = true;    // bodies are not restricted to a set
  double mass = 0.0;  // of the bodies [kg]
  mpm::BodySet bodies{};
  bool has_moved = false;

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
