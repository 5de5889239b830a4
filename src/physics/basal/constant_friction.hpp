// mu_e = tan(phi_f): Coulomb friction (Eq. 17 without Eq. 25).
#pragma once

#include <cmath>

#include "physics/basal/contact_node.hpp"
#include "physics/basal/shared_parameters.hpp"

namespace thawslide::physics::basal {

struct ConstantFriction {
  static constexpr const char* keyword = "constant";
  static constexpr const char* text = "mu_e = tan(friction_angle)";
  static constexpr bool depends_on_pore_pressure = true;
  static constexpr bool depends_on_mass = false;
  static constexpr auto parameters = parameter_list(friction_angle);

  double full_coefficient;  // tan(phi_f)

  template <class Numbers>
  static ConstantFriction from(const Numbers& numbers) {
    return {std::tan(numbers(friction_angle) * pi / 180.0)};
  }
  THAWSLIDE_HD double coefficient(const ContactNode& /*node*/) const { return full_coefficient; }
};

}  // namespace thawslide::physics::basal
