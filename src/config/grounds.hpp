// Ground of a case: its basal laws (physics/basal/laws.hpp), and substrates along x in sequence.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {

// Friction or cohesion law (FrictionLaw, CohesionLaw) of one kind of ground, with its parameters. If the initial
// cohesion is zero, the parameters of its loss are not needed.
template <class Laws>
[[nodiscard]] Laws law_of(const GroundStrength& ground);

// Last time at which a case changes by itself, so that a slide at rest may start again: when ground loses its cohesion,
// or the band changes its thickness [s]; 0 if there is none.
[[nodiscard]] double last_scheduled_event(const Case& parameters);

struct Strip {
  std::string name;
  double from, to;  // [m], either may be infinite
};

// Substrates along x, sorted by their beginning.
[[nodiscard]] std::vector<Strip> strips_of(const Case& parameters);

}  // namespace thawslide::config
