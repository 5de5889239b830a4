// Dry sand, of which granular columns are, in the plane and in space. Sand whose angle of repose is 31 degrees slides
// along planes at tau = tan(31) sigma; without dilation such planes bear sin(phi) sigma (Davis 1968):
// phi = asin(tan(31)) = 36.9 degrees.
#pragma once

#include "friction_alone.hpp"

namespace thawslide::testing_support {

// The tables of the material "sand", of its stiffness [Pa], and of its friction on the ground.
inline std::string dry_sand(double youngs_modulus) {
  return fmt::format(R"(
[material.sand]
law = "mohr_coulomb"
youngs_modulus = {}
poisson_ratio = 0.3
friction_angle = 36.93
cohesion = 0.0
gaps_close_first = true
)",
                     youngs_modulus) +
         friction_alone(31.0);
}

}  // namespace thawslide::testing_support
