// Friction proportional to the total load: sliding on a glacier, where frictional melting keeps friction low without
// an explicit pore pressure. Replaces Eqs. 17 and 25.
//   tau = mu N
#pragma once

#include "physics/basal/contact_node.hpp"
#include "physics/basal/shared_parameters.hpp"

namespace thawslide::physics::basal {

struct CoefficientFriction {
  static constexpr const char* keyword = "coefficient";
  static constexpr const char* text = "friction_coefficient times N, independent of pore pressure";
  static constexpr bool depends_on_pore_pressure = false;
  static constexpr bool depends_on_mass = false;
  static constexpr auto parameters = parameter_list(friction_coefficient);

  double given;  // mu

  template <class Numbers>
  static CoefficientFriction from(const Numbers& numbers) {
    return {numbers(friction_coefficient)};
  }
  THAWSLIDE_HD double coefficient(const ContactNode& /*node*/) const { return given; }
};

}  // namespace thawslide::physics::basal
