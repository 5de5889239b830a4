// Dry sand of granular columns, in 2D and 3D. Sand with an angle of repose of 31 degrees slides along planes at tau =
// tan(31) sigma; without dilation such planes resist sin(phi) sigma (Davis 1968): phi = asin(tan(31)) = 36.9 degrees.
#pragma once

#include "friction_alone.hpp"

namespace thawslide::testing_support {

// Tables of the material "sand" with its stiffness [Pa], and of its friction on the ground.
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
