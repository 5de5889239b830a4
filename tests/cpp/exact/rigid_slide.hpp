// Rigid bodies with Coulomb friction (chapters on rigid bodies of any textbook of mechanics).
//   plane   a = g (sin theta - mu cos theta); work of friction mu m g cos theta times the distance
//   arc     a body slides down a circular arc of radius R, turning about its centre O, with mass m, moment of inertia I
//           about O, centre of mass at r from O, and phi its angle from the lowest point:
//             (I/2) dw^2/dphi = -m g r sin phi + mu R m (g cos phi + r w^2),   w = -dphi/dt > 0
//           dw^2/dphi = a w^2 - b sin phi + c cos phi with a = 2 mu R m r/I, b = 2 m g r/I, c = 2 mu R m g/I, hence
//             w^2 = A sin phi + B cos phi + K exp(a phi),  A = (a b + c)/(1 + a^2), B = b - a A
//           (short compared with R: the ground's pressure acts along the radius of the centre of mass)
#pragma once

#include <cmath>

namespace thawslide::physics::exact {

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

}  // namespace thawslide::physics::exact
