// From the case to contact between bodies as the step has it.
#pragma once

#include "config/case.hpp"
#include "mpm/between_bodies.hpp"

namespace thawslide::sim {

template <class Real>
[[nodiscard]] mpm::BetweenBodies<Real> between_bodies(const config::Case& parameters);

}  // namespace thawslide::sim
