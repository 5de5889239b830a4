// Steady drained band, derived in docs/theory/band-columns.md, for the arrest or runaway of Goren and Aharonov (2009).
// Friction heats a band over its thickness e; water leaves it through its top, where P = 0; its base is sealed, and no
// heat is lost. With strength mu (N - P), P the mean over the band,
//   tau = mu N/(1 + A v/k),   A = mu beta_m gamma_w eta e/(3 C)
// A block on a slope a accelerates if tau < N tan(a) and decelerates if tau > N tan(a). Strength decreases with the
// speed v; the speed at which both are equal,
//   v = (mu/tan(a) - 1) k/A,
// is therefore unstable: below it, a block arrests; above it, it runs away.
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
  // Conductivity [m/s] at which a block at a speed [m/s] on a slope [rad] neither accelerates nor decelerates: below
  // it, the block runs away; above it, the block arrests. The slope must be below the friction angle.
  [[nodiscard]] double boundary_conductivity(double speed, double slope) const {
    return weakening() * speed / (friction / std::tan(slope) - 1.0);
  }
};

}  // namespace thawslide::physics::exact
