// Friction as a given share of the whole load: sliding on a glacier, where what the load melts keeps friction low
// without a pore pressure of its own. It stands in place of Eqs. 17 and 25.
//   tau = mu N
// mu_ice 0.05 to 0.15: a range of back-calculated rock avalanches on glaciers, not checked.
#pragma once

#include "physics/basal/contact_node.hpp"
#include "physics/basal/shared_parameters.hpp"

namespace thawslide::physics::basal {

inline constexpr Parameter friction_coefficient{.key = "friction_coefficient",
                                                .is_needed = true,
                                                .only_with_its_laws = true,
                                                .low = 0.0,
                                                .usual_low = 0.05,
                                                .usual_high = 0.15,
                                                .usual_where = "on a glacier",
                                                .text = "friction over the normal stress N, mu, of {laws}"};

template <class Real>
struct CoefficientFriction {
  static constexpr const char* word = "coefficient";
  static constexpr const char* text = "friction_coefficient times N, whatever the pore pressure";
  static constexpr bool feels_pore_pressure = false;
  static constexpr auto parameters = parameter_list(friction_coefficient);

  Real given;  // mu

  template <class Numbers>
  static CoefficientFriction from(const Numbers& numbers) {
    return {static_cast<Real>(numbers(friction_coefficient))};
  }
  THAWSLIDE_HD Real coefficient(const ContactNode<Real>& /*node*/) const { return given; }
};

}  // namespace thawslide::physics::basal
