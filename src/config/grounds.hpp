// Ground of a case: its basal laws (physics/basal/laws.hpp), and substrates along x in sequence.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {

// Friction or cohesion law (FrictionLaw, CohesionLaw) of one kind of ground; zero cohesion has no loss.
template <class Laws>
[[nodiscard]] Laws law_of(const GroundStrength& ground);

// Last time at which ground loses its cohesion or the band changes its thickness [s], so a slide may start again; or 0.
[[nodiscard]] double last_scheduled_event(const Case& parameters);

struct Strip {
  std::string name;
  double from, to;  // [m], either may be infinite
};

// Substrates along x, sorted by their beginning.
[[nodiscard]] std::vector<Strip> strips_of(const Case& parameters);

}  // namespace thawslide::config
