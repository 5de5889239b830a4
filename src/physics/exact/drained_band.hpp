// The steady drained band, for the arrest or runaway of Goren and Aharonov (2009): friction heats a band over its
// thickness e, water leaves it through its top, where P = 0; its base is sealed, heat stays. With strength mu (N - P),
// P the mean over the band,
//   tau = mu N/(1 + A v/k),   A = mu beta_m gamma_w eta e/(3 C)
// A block that slides down an angle a speeds up where tau < N tan(a) and slows down where tau > N tan(a). Strength
// falls as the speed v rises, so that the speed at which both are equal,
//   v = (mu/tan(a) - 1) k/A,
// is unstable: of two blocks on either side of it one arrests and one runs away.
#pragma once

#include <cmath>

namespace thawslide::physics::exact {

struct DrainedBand {
  double friction;           // mu
  double expansion;          // beta_m of rock and water per volume [1/K]
  double water_unit_weight;  // gamma_w [N/m3]
  double heat_fraction;      // eta
  double thickness;          // e [m]
  double heat_capacity;      // C [J/m3/K]

  [[nodiscard]] double weakening() const {  // A
    return friction * expansion * water_unit_weight * heat_fraction * thickness / (3.0 * heat_capacity);
  }
  // Strength over N at speed v [m/s] and hydraulic conductivity k [m/s].
  [[nodiscard]] double strength(double speed, double conductivity) const {
    return friction / (1.0 + weakening() * speed / conductivity);
  }
  // The conductivity [m/s] at which a block of a speed [m/s] on a slope [rad] neither speeds up nor slows down: with
  // less it runs away, with more it arrests. The slope is less steep than friction is.
  [[nodiscard]] double boundary_conductivity(double speed, double slope) const {
    return weakening() * speed / (friction / std::tan(slope) - 1.0);
  }
};

}  // namespace thawslide::physics::exact
