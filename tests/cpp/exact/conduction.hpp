// Heat conduction in bodies at rest: closed-form solutions (Carslaw and Jaeger 1959, ch. 2 and 3).
//   half space        T = T0 + (Ts - T0) erfc(x/sqrt(4 a t))                      a = k/C, x >= 0
//   two half spaces   T = Ti + (Tj - Ti) erf(|x|/sqrt(4 a_j t))                   side j of the interface at x = 0
//                     Ti = (b1 T1 + b2 T2)/(b1 + b2),  b = sqrt(k C)
#pragma once

#include <cmath>

namespace thawslide::physics::exact {

// Temperature [C] at depth x [m] and time t > 0 [s] of a half space initially at `initial`, with its face at `face` [C]
// since t = 0; diffusivity [m2/s].
inline double half_space_temperature(double x, double t, double initial, double face, double diffusivity) {
  return initial + (face - initial) * std::erfc(x / std::sqrt(4.0 * diffusivity * t));
}

struct HalfSpace {
  double conductivity;  // k [W/m/K]
  double capacity;      // C [J/m3/K]
  double temperature;   // before contact [C]
};

// Temperature [C] of the interface of two half spaces in contact, constant in time.
inline double interface_temperature(const HalfSpace& left, const HalfSpace& right) {
  const double b_left = std::sqrt(left.conductivity * left.capacity);
  const double b_right = std::sqrt(right.conductivity * right.capacity);
  return (b_left * left.temperature + b_right * right.temperature) / (b_left + b_right);
}

// Temperature [C] at x [m] and time t > 0 [s] after contact; the interface is at x = 0, and `left` at x < 0.
inline double two_half_spaces_temperature(double x, double t, const HalfSpace& left, const HalfSpace& right) {
  const HalfSpace& side = x < 0.0 ? left : right;
  const double between = interface_temperature(left, right);
  const double diffusivity = side.conductivity / side.capacity;
  return between + (side.temperature - between) * std::erf(std::abs(x) / std::sqrt(4.0 * diffusivity * t));
}

}  // namespace thawslide::physics::exact
