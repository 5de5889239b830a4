// Cohesion that slip reduces to a residual: a law for c_S of Eq. 17, which the paper does not specify.
//   c_S = c_r + (c_0 - c_r) exp(-s/d_c),  s the slip
#pragma once

#include <cmath>

#include "physics/basal/contact_node.hpp"
#include "physics/basal/shared_parameters.hpp"

namespace thawslide::physics::basal {

struct SlipCohesion {
  static constexpr const char* keyword = "slip";
  static constexpr const char* text = "c_S = c_r + (c_0 - c_r) exp(-slip/slip_distance)";
  static constexpr bool depends_on_mass = true;
  static constexpr auto parameters = parameter_list(initial_cohesion, residual_cohesion, slip_distance);

  double initial, residual;  // c_0, c_r [Pa]
  double distance;           // d_c [m]

  template <class Numbers>
  static SlipCohesion from(const Numbers& numbers) {
    return {numbers(initial_cohesion), numbers(residual_cohesion), numbers(slip_distance)};
  }
  THAWSLIDE_HD double cohesion(const ContactNode& node) const {
    return residual + (initial - residual) * std::exp(-node.slip / distance);
  }
};

}  // namespace thawslide::physics::basal
