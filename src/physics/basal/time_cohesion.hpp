// Cohesion that decreases to a residual at a given time: a law for c_S of Eq. 17, which the paper does not specify.
#pragma once

#include "physics/basal/contact_node.hpp"
#include "physics/basal/shared_parameters.hpp"

namespace thawslide::physics::basal {

inline constexpr Parameter cohesion_loss_time{.key = "cohesion_loss_time",
                                              .unit = "s",
                                              .is_needed = true,
                                              .low = 0.0,
                                              .text = "time at which the cohesion is lost with {laws}"};

struct TimeCohesion {
  static constexpr const char* keyword = "time";
  static constexpr const char* text = "c_S = cohesion before cohesion_loss_time, residual_cohesion after it";
  static constexpr bool depends_on_mass = false;
  static constexpr auto parameters = parameter_list(initial_cohesion, residual_cohesion, cohesion_loss_time);

  double initial, residual;  // c_0, c_r [Pa]
  double loss_time;          // [s]

  template <class Numbers>
  static TimeCohesion from(const Numbers& numbers) {
    return {numbers(initial_cohesion), numbers(residual_cohesion), numbers(cohesion_loss_time)};
  }
  THAWSLIDE_HD double cohesion(const ContactNode& node) const { return node.time < loss_time ? initial : residual; }
};

}  // namespace thawslide::physics::basal
