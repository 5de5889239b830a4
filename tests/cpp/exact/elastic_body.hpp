// Elastic bodies: closed-form solutions (Timoshenko and Goodier 1951).
//   bar that hits a rigid wall end on, nu = 0 (ch. 15): pressure rho c v on the wall for 2 H/c, c = sqrt(E/rho); then
//   it rebounds with its initial speed
//   cylinder rotating about its axis, plane strain (ch. 4):
//     s_r = (3-2 nu)/(8 (1-nu)) rho w^2 (R^2 - r^2)
//     s_t = rho w^2/(8 (1-nu)) [(3-2 nu) R^2 - (1+2 nu) r^2],  s_z = nu (s_r + s_t)
#pragma once

#include <cmath>

namespace thawslide::physics::exact {

// Pressure [Pa] on the wall: density [kg/m3], Young's modulus [Pa], speed [m/s].
inline double impact_pressure(double density, double youngs_modulus, double speed) {
  return std::sqrt(density * youngs_modulus) * speed;
}

// Contact time [s] of a bar of a length [m] with the wall.
inline double impact_time(double density, double youngs_modulus, double length) {
  return 2.0 * length / std::sqrt(youngs_modulus / density);
}

struct TurningCylinder {
  double density, poisson_ratio, angular_speed, radius;  // kg/m3, 1, rad/s, m

  struct Stress {
    double radial, around, along;  // [Pa], tension positive
  };
  // Stress at distance r [m] from the axis.
  [[nodiscard]] Stress at(double r) const {
    const double scale = density * angular_speed * angular_speed / (8.0 * (1.0 - poisson_ratio));
    const double middle = (3.0 - 2.0 * poisson_ratio) * radius * radius;
    const double radial = scale * (middle - (3.0 - 2.0 * poisson_ratio) * r * r);
    const double around = scale * (middle - (1.0 + 2.0 * poisson_ratio) * r * r);
    return {radial, around, poisson_ratio * (radial + around)};
  }
};

}  // namespace thawslide::physics::exact
