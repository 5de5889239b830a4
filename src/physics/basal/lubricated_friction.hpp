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

  Real full_coefficient;  // tan(phi_f)
  Real exponent;          // omega
  Real least, most;       // n_min, n_max

  template <class Numbers>
  static LubricatedFriction from(const Numbers& numbers) {
    return {static_cast<Real>(std::tan(numbers(friction_angle) * pi / 180.0)),
            static_cast<Real>(numbers(lubrication_exponent)), static_cast<Real>(numbers(min_solid_fraction)),
            static_cast<Real>(numbers(max_solid_fraction))};
  }
  THAWSLIDE_HD Real coefficient(const ContactNode& node) const {
    const Real ratio = (node.solid_fraction - least) / (most - least);
    const Real clamped = ratio < Real(0) ? Real(0) : ratio > Real(1) ? Real(1) : ratio;
    return (Real(1) - power(Real(1) - clamped, exponent)) * full_coefficient;
  }
};

}  // namespace thawslide::physics::basal
