// Input of the basal laws at a contact node (Eqs. 17, 25).
#pragma once

#include "base/portability.hpp"

namespace thawslide::physics::basal {

struct ContactNode {
  Real normal_pressure = 0;  // N [Pa]
  Real pore_pressure = 0;    // P [Pa]
  Real temperature = 0;      // T [C]
  Real saturation = 0;       // liquid saturation of the pores, S
  Real solid_fraction = 0;   // n_e, effective (Eq. 2)
  Real slip = 0;             // accumulated along the ground [m]
  Real speed = 0;            // of the slip, v [m/s]
  Real time = 0;             // [s]
  Real unit_weight = 0;      // of the sliding mass, rho g [N/m3]
};

}  // namespace thawslide::physics::basal
