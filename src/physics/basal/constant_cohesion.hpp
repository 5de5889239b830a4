// c_S = c_0 (Eq. 17), constant.
#pragma once

#include "physics/basal/contact_node.hpp"
#include "physics/basal/shared_parameters.hpp"

namespace thawslide::physics::basal {

struct ConstantCohesion {
  static constexpr const char* keyword = "constant";
  static constexpr const char* text = "c_S = cohesion, constant";
  static constexpr bool depends_on_mass = false;
  static constexpr auto parameters = parameter_list(initial_cohesion);

  double initial;  // c_0 [Pa]

  template <class Numbers>
  static ConstantCohesion from(const Numbers& numbers) {
    return {numbers(initial_cohesion)};
  }
  THAWSLIDE_HD double cohesion(const ContactNode& /*node*/) const { return initial; }
};

}  // namespace thawslide::physics::basal
