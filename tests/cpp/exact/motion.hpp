// Closed-form solutions for rigid and elastic bodies.
#pragma once

#include <cmath>

namespace thawslide::physics::exact {

// Rigid bodies with Coulomb friction (chapters on rigid bodies of any textbook of mechanics).
//   plane   a = g (sin theta - mu cos theta); work of friction mu m g cos theta times the distance
//   arc     a body slides down a circular arc of radius R, turning about its centre O, with mass m, moment of inertia I
//           about O, centre of mass at r from O, and phi its angle from the lowest point:
//             (I/2) dw^2/dphi = -m g r sin phi + mu R m (g cos phi + r w^2),   w = -dphi/dt > 0
//           dw^2/dphi = a w^2 - b sin phi + c cos phi with a = 2 mu R m r/I, b = 2 m g r/I, c = 2 mu R m g/I, hence
//             w^2 = A sin phi + B cos phi + K exp(a phi),  A = (a b + c)/(1 + a^2), B = b - a A
//           (short compared with R: the ground's pressure acts along the radius of the centre of mass)

// Acceleration [m/s2] down a plane of a slope [rad] above the friction angle, from rest; 0 below the friction angle.
inline double acceleration_on_plane(double slope, double friction, double gravity) {
  const double down = gravity * (std::sin(slope) - friction * std::cos(slope));
  return down > 0.0 ? down : 0.0;
}

struct ArcSlide {
  double radius;           // R of the ground [m]
  double centre_distance;  // r of the centre of mass from O [m]
  double inertia;          // I/m [m2]
  double friction;         // mu
  double gravity;          // [m/s2]

  // Angular speed [rad/s] at the angle phi <= start [rad], from rest at `start`.
  [[nodiscard]] double angular_speed(double phi, double start) const {
    const double a = 2.0 * friction * radius * centre_distance / inertia;
    const double b = 2.0 * gravity * centre_distance / inertia;
    const double c = 2.0 * friction * radius * gravity / inertia;
    const double sine = (a * b + c) / (1.0 + a * a);
    const double cosine = b - a * sine;
    const double rest = -(sine * std::sin(start) + cosine * std::cos(start)) * std::exp(a * (phi - start));
    return std::sqrt(std::fmax(0.0, sine * std::sin(phi) + cosine * std::cos(phi) + rest));
  }
};

// Elastic bodies: closed-form solutions (Timoshenko and Goodier 1951).
//   bar that hits a rigid wall end on, nu = 0 (ch. 15): pressure rho c v on the wall for 2 H/c, c = sqrt(E/rho); then
//   it rebounds with its initial speed
//   cylinder rotating about its axis, plane strain (ch. 4):
//     s_r = (3-2 nu)/(8 (1-nu)) rho w^2 (R^2 - r^2)
//     s_t = rho w^2/(8 (1-nu)) [(3-2 nu) R^2 - (1+2 nu) r^2],  s_z = nu (s_r + s_t)

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
