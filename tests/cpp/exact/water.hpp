// Closed-form solutions for pore water and drained bands.
#pragma once

#include <cmath>

namespace thawslide::physics::exact {

// Pore pressure of melted material: closed-form solutions.
//   consolidation       P = P0 sum_k (2/M) sin(M z/H) exp(-M^2 D t/H^2), M = (k + 1/2) pi   (Terzaghi 1943, ch. 13)
//   undrained heating   dP = K_L [(1-n) beta_S + n beta_L]/n dT with 1-n = (1-n0) exp(beta_S (T - T0)) (Eqs. 6 and 8):
//                       P - P0 = K_L {beta_S I + (beta_L - beta_S) (T - T0)}, I = integral of dT/n
//   slip on a plane     tau/tau0 = exp(d/L) erfc(sqrt(d/L)), d = V t                       (Rice 2006, Eq. 9)
//                       L = s (C/Lam)^2 (sqrt(D) + sqrt(a))^2/(f^2 V), s = 4 with material on both sides (Rice), 1
//                       with material on one side of a sealed, insulated plane, which receives twice the heat.

// P/P0 at depth z [m] below the drained top of a layer of thickness H [m] with a sealed base and initial pressure P0;
// diffusivity D [m2/s], t > 0 [s].
inline double consolidation_pressure(double z, double thickness, double diffusivity, double t) {
  const double pi = std::acos(-1.0);
  constexpr int terms = 200;
  double sum = 0.0;
  for (int k = 0; k < terms; ++k) {
    const double m = (k + 0.5) * pi;
    sum += 2.0 / m * std::sin(m * z / thickness) * std::exp(-m * m * diffusivity * t / (thickness * thickness));
  }
  return sum;
}

// Pressure rise [Pa] by undrained heating of melted material of porosity n0 by `heating` [K]; water_bulk_modulus [Pa],
// expansions [1/K].
inline double undrained_pressure_rise(double heating, double porosity, double water_bulk_modulus, double rock_expansion,
                                      double water_expansion) {
  const double solid = 1.0 - porosity;
  const double integral =
      heating - std::log((1.0 - solid * std::exp(rock_expansion * heating)) / porosity) / rock_expansion;
  return water_bulk_modulus * (rock_expansion * integral + (water_expansion - rock_expansion) * heating);
}

// Slip length L [m] over which a plane with material on one side loses its strength: heat capacity C [J/m3/K],
// undrained pressure coefficient Lam [Pa/K], hydraulic and thermal diffusivity [m2/s], friction f, speed V [m/s].
inline double one_sided_slip_length(double capacity, double pressure_coefficient, double hydraulic_diffusivity,
                                    double thermal_diffusivity, double friction, double speed) {
  const double roots = std::sqrt(hydraulic_diffusivity) + std::sqrt(thermal_diffusivity);
  const double ratio = capacity / pressure_coefficient * roots / friction;
  return ratio * ratio / speed;
}

// Strength of the plane after a slip [m], relative to the initial strength.
inline double strength_on_plane(double slip, double slip_length) {
  const double x = slip / slip_length;
  return std::exp(x) * std::erfc(std::sqrt(x));
}

// Steady drained band, derived in docs/theory/band-columns.md, for the arrest or runaway of Goren and Aharonov (2009).
// Friction heats a band over its thickness e; water leaves it through its top, where P = 0; its base is sealed, and no
// heat is lost. With strength mu (N - P), P the mean over the band,
//   tau = mu N/(1 + A v/k),   A = mu beta_m gamma_w eta e/(3 C)
// A block on a slope a accelerates if tau < N tan(a) and decelerates if tau > N tan(a). Strength decreases with the
// speed v; the speed at which both are equal,
//   v = (mu/tan(a) - 1) k/A,
// is therefore unstable: below it, a block arrests; above it, it runs away.

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
