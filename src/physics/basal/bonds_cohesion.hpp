// Cohesion by ice bonds between sliding mass and ground, which slip breaks and melting removes, to zero: a c_S of
// Eq. 17.
//   c_S = c_0 exp(-s/d_c) (1 - S),  s the slip
// In fully frozen material (S = 0), breaking the bonds takes the energy c_0 d_c [J/m2].
#pragma once

#include <cmath>

#include "physics/basal/contact_node.hpp"
#include "physics/basal/shared_parameters.hpp"

namespace thawslide::physics::basal {

struct BondsCohesion {
  static constexpr const char* keyword = "bonds";
  static constexpr const char* text =
      "c_S = cohesion exp(-slip/slip_distance) (1 - S_L): bonds of ice, lost completely";
  static constexpr bool depends_on_mass = true;
  static constexpr auto parameters = parameter_list(initial_cohesion, slip_distance);

  double initial;   // c_0 [Pa]
  double distance;  // d_c [m]

  template <class Numbers>
  static BondsCohesion from(const Numbers& numbers) {
    return {numbers(initial_cohesion), numbers(slip_distance)};
  }
  THAWSLIDE_HD double cohesion(const ContactNode& node) const {
    return initial * std::exp(-node.slip / distance) * (1.0 - node.saturation);
  }
};

}  // namespace thawslide::physics::basal
