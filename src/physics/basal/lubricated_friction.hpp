// Friction that decreases with the solid fraction: by melting of ice, and by dilation.
//   mu_e = tan(phi_f) [1 - (1 - x)^omega],  x = (n_e - n_min)/(n_max - n_min) within [0, 1]                  (Eq. 25)
// The limits on x are an addition of the present implementation: beyond them, Eq. 25 is not meaningful.
#pragma once

#include <cmath>

#include "physics/basal/contact_node.hpp"
#include "physics/basal/shared_parameters.hpp"
#include "physics/freezing.hpp"

namespace thawslide::physics::basal {

inline constexpr Parameter lubrication_exponent{
    .key = "lubrication_exponent",
    .initial = 2.0,
    .low = 0.0,
    .low_open = true,
    .text = "exponent omega; with a larger value, friction decreases later as solid is lost",
    .source = "Lei et al., Eq. 25"};
inline constexpr Parameter min_solid_fraction{.key = "min_solid_fraction",
                                              .initial = 0.05,
                                              .low = 0.0,
                                              .high = 1.0,
                                              .text = "effective solid fraction n_min at which friction vanishes",
                                              .source = "Lei et al., Eq. 25"};
inline constexpr Parameter max_solid_fraction{.key = "max_solid_fraction",
                                              .initial = 0.85,
                                              .low = 0.0,
                                              .high = 1.0,
                                              .text = "effective solid fraction n_max at which friction is not reduced",
                                              .source = "Lei et al., Eq. 25"};

struct LubricatedFriction {
  static constexpr const char* keyword = "lubricated";
  static constexpr const char* text = "mu_e = tan(friction_angle) times a factor that decreases as ice melts (Eq. 25)";
  static constexpr bool depends_on_pore_pressure = true;
  static constexpr bool depends_on_mass = true;
  static constexpr auto parameters =
      parameter_list(friction_angle, lubrication_exponent, min_solid_fraction, max_solid_fraction);

  double full_coefficient;  // tan(phi_f)
  double exponent;          // omega
  double least, most;       // n_min, n_max

  template <class Numbers>
  static LubricatedFriction from(const Numbers& numbers) {
    return {std::tan(numbers(friction_angle) * pi / 180.0), numbers(lubrication_exponent), numbers(min_solid_fraction),
            numbers(max_solid_fraction)};
  }
  THAWSLIDE_HD double coefficient(const ContactNode& node) const {
    const double ratio = (node.solid_fraction - least) / (most - least);
    const double clamped = ratio < 0.0 ? 0.0 : ratio > 1.0 ? 1.0 : ratio;
    return (1.0 - power(1.0 - clamped, exponent)) * full_coefficient;
  }
};

}  // namespace thawslide::physics::basal
