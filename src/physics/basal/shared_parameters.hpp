// Parameters used by several basal laws (Eqs. 17, 25).
#pragma once

#include "physics/basal/parameter.hpp"

namespace thawslide::physics::basal {

inline constexpr Parameter friction_angle{.key = "friction_angle",
                                          .unit = "degrees",
                                          .is_needed = true,
                                          .low = 0.0,
                                          .high = 90.0,
                                          .high_open = true,
                                          .text = "basal friction angle phi_f",
                                          .source = "Lei et al., Eq. 25, Tables 2, 3"};

// The typical range is an assumption. It contains the ranges that `thawslide new` proposes.
inline constexpr Parameter friction_coefficient{.key = "friction_coefficient",
                                                .is_needed = true,
                                                .only_with_its_laws = true,
                                                .low = 0.0,
                                                .usual_low = 0.05,
                                                .usual_high = 0.3,
                                                .usual_where = "on glacier, snow or valley floor",
                                                .usual_law = "coefficient",
                                                .text = "friction coefficient mu of {laws}"};

// Used by all cohesion laws. If it is 0, none of their other parameters is required.
inline constexpr Parameter initial_cohesion{
    .key = "cohesion", .unit = "Pa", .low = 0.0, .text = "basal cohesion c_0 at t = 0", .source = "Lei et al., Eq. 17"};

inline constexpr Parameter residual_cohesion{
    .key = "residual_cohesion", .unit = "Pa", .low = 0.0, .text = "residual cohesion c_r of {laws}"};

inline constexpr Parameter slip_distance{.key = "slip_distance",
                                         .unit = "m",
                                         .is_needed = true,
                                         .low = 0.0,
                                         .low_open = true,
                                         .usual_low = 1.0,
                                         .usual_high = 100.0,
                                         .usual_where = "for ice bonds",
                                         .usual_law = "bonds",
                                         .text = "slip d_c over which the cohesion decreases to 1/e with {laws}"};

}  // namespace thawslide::physics::basal
