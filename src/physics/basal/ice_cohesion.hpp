// Cohesion proportional to the ice in the pores: a law for c_S of Eq. 17, which the paper does not specify.
//   c_S = c_0 (1 - S)
#pragma once

#include "physics/basal/contact_node.hpp"
#include "physics/basal/shared_parameters.hpp"

namespace thawslide::physics::basal {

struct IceCohesion {
  static constexpr const char* keyword = "ice";
  static constexpr const char* text = "c_S = cohesion (1 - S_L), proportional to the ice in the pores";
  static constexpr bool depends_on_mass = true;
  static constexpr auto parameters = parameter_list(initial_cohesion);

  double initial;  // c_0 [Pa]

  template <class Numbers>
  static IceCohesion from(const Numbers& numbers) {
    return {numbers(initial_cohesion)};
  }
  THAWSLIDE_HD double cohesion(const ContactNode& node) const { return initial * (1.0 - node.saturation); }
};

}  // namespace thawslide::physics::basal
