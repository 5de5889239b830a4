// Laws of the base (physics/basal/laws.hpp) selected by a case.
#pragma once

#include <string>

#include "base/error.hpp"
#include "config/case.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {

// Law of a keyword, with its parameters.
template <class Laws>
Laws law_named(const std::string& keyword, const LawNumbers& numbers) {
  Laws found{};
  bool is_known = false;
  physics::basal::for_each_law<Laws>([&]<class Law>(physics::basal::OfType<Law>) {
    if (keyword == Law::keyword) {
      found = Law::from(numbers);
      is_known = true;
    }
  });
  THAWSLIDE_ASSERT(is_known, "no law of the base is called {}", keyword);
  return found;
}

// Friction and cohesion laws of one kind of ground. If the initial cohesion is zero, the parameters of its loss are not
// needed.
inline physics::basal::FrictionLaw friction_of(const GroundStrength& ground) {
  return law_named<physics::basal::FrictionLaw>(ground.friction, ground.numbers);
}
inline physics::basal::CohesionLaw cohesion_of(const GroundStrength& ground) {
  const bool has_cohesion = ground.numbers(physics::basal::initial_cohesion) > 0.0;
  return law_named<physics::basal::CohesionLaw>(
      has_cohesion ? ground.cohesion_law : physics::basal::ConstantCohesion::keyword, ground.numbers);
}

}  // namespace thawslide::config
