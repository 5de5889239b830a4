// Input of the basal laws at a contact node (Eqs. 17, 25).
#pragma once

#include "base/portability.hpp"

namespace thawslide::physics::basal {

struct ContactNode {
  double normal_pressure = 0;  // N [Pa]
  double pore_pressure = 0;    // P [Pa]
  double temperature = 0;      // T [C]
  double saturation = 0;       // liquid saturation of the pores, S
  double solid_fraction = 0;   // n_e, effective (Eq. 2)
  double slip = 0;             // accumulated along the ground [m]
  double speed = 0;            // of the slip, v [m/s]
  double time = 0;             // [s]
  double unit_weight = 0;      // of the sliding mass, rho g [N/m3]
};

}  // namespace thawslide::physics::basal
