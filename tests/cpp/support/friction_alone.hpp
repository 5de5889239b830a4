// Tables of a case in which only Coulomb friction of the ground acts on the slide.
#pragma once

#include <fmt/format.h>

#include <string>

namespace thawslide::testing_support {

// Friction angle [degrees].
inline std::string friction_alone(double angle) {
  return fmt::format(R"(
[basal]
friction = "constant"
friction_angle = {}
[mechanisms]
pressurization = false
[heat]
enabled = false
[pressure]
enabled = false
)",
                     angle);
}

}  // namespace thawslide::testing_support
