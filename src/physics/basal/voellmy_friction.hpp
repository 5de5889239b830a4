// Voellmy friction (Voellmy 1955; Salm 1993): Coulomb friction and a turbulent drag independent of the load.
//   tau = mu (N - P) + rho g v^2/xi
// rho: bulk density of the sliding mass at the node; v: slip speed. RAMMS and AvaFrame's com1DFA (frictModel "Voellmy")
// use S = mu N + rho g u^2/xi with a given density and the depth-averaged velocity u, without pore pressure P.
#pragma once

#include "physics/basal/contact_node.hpp"
#include "physics/basal/shared_parameters.hpp"

namespace thawslide::physics::basal {

inline constexpr Parameter turbulent_friction{
    .key = "turbulent_friction",
    .unit = "m/s2",
    .is_needed = true,
    .only_with_its_laws = true,
    .low = 0.0,
    .low_open = true,
    .text = "turbulent friction xi of {laws}; a larger value reduces the drag rho g v^2/xi",
    .source = "Voellmy (1955)"};

struct VoellmyFriction {
  static constexpr const char* keyword = "voellmy";
  static constexpr const char* text =
      "friction_coefficient (N - P) + rho g v^2/turbulent_friction, with the slip speed v";
  static constexpr bool depends_on_pore_pressure = true;
  static constexpr bool depends_on_mass = false;
  static constexpr auto parameters = parameter_list(friction_coefficient, turbulent_friction);

  double given;       // mu
  double turbulence;  // xi [m/s2]

  template <class Numbers>
  static VoellmyFriction from(const Numbers& numbers) {
    return {numbers(friction_coefficient), numbers(turbulent_friction)};
  }
  THAWSLIDE_HD double coefficient(const ContactNode& /*node*/) const { return given; }
  THAWSLIDE_HD double drag(const ContactNode& node) const {
    return node.unit_weight * node.speed * node.speed / turbulence;
  }
};

}  // namespace thawslide::physics::basal
