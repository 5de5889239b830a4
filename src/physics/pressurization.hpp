// Thermal pressurization and seepage of the melted pore (Eqs. 8, 22, 23 at S = 1).
//   dP_L/dt = K_L/(n S) [beta_m dT/dt - div q_L],  q_L = -(k_L/gamma_w) grad P_L
// and, as an option, Eq. 8's - [S + (1-S) r] div v within the bracket, which Eq. 23 drops.
#pragma once

#include <cmath>

#include "physics/mixture.hpp"

namespace thawslide::physics {

// Lambda = K_L beta_m/(n S) [Pa/K]: pressure per kelvin of undrained heating.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value undrained_pressure_coefficient(const Phases& phases, Value porosity,
                                                                          Value saturation) {
  return phases.water_bulk_modulus * expansion(phases, porosity, saturation) / (porosity * saturation);
}

// K_L/(n S) [Pa]: pressure per volumetric compression of an undrained pore (Eq. 8, r = rho_I/rho_L, times S + (1 - S)
// r, which is 1 once melted).
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value pore_stiffness(const Phases& phases, Value porosity, Value saturation) {
  const double ratio = phases.ice_density / phases.water_density;
  return phases.water_bulk_modulus * (saturation + (1.0 - saturation) * ratio) / (porosity * saturation);
}

// D = K_L k_L/(n S gamma_w) [m2/s]; hydraulic conductivity k_L [m/s].
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value hydraulic_diffusivity(const Phases& phases, Value porosity, Value saturation,
                                                                 Value hydraulic_conductivity) {
  return phases.water_bulk_modulus * hydraulic_conductivity / (porosity * saturation * phases.water_unit_weight);
}

// Fraction of the difference between the value of a particle and that interpolated from nodes that subgrid diffusion
// removes in a step: 1 - exp(-dt D sum_a 2/h_a^2), where h is the mesh size to which D applies (Gerya and Yuen 2003,
// Eq. 23). Nodes do not resolve differences within a cell; diffusion between nodes alone would preserve them.
// inverse_mesh_size: 1/h [1/m].
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value subgrid_diffusion_fraction(Value diffusivity, Value inverse_mesh_size,
                                                                      int dimension, double dt) {
  return -exponential_minus_one((-dt * double(2 * dimension)) * (inverse_mesh_size * inverse_mesh_size) * diffusivity);
}

// Pressures of ice, water and pore while ice and water coexist (Eqs. 4 and 21).
//   P_I = rho_I g H                                        ice carries the overburden, H normal to the terrain
//   P_L = P_I/r + rho_L L_f ln(T/Tref),  r = rho_I/rho_L   generalized Clapeyron equation, T absolute        (Eq. 4)
//   P_pore = S P_L + (1 - S) P_I                                                                            (Eq. 21)
// Eq. 4 is published with a minus sign. With it, the pore pressure rises while the band thaws; with a plus sign, it
// falls and then recovers, as the paper describes.

// P_I [Pa]; gravity [m/s2], depth H [m].
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value ice_pressure(const Phases& phases, double gravity, Value depth) {
  return phases.ice_density * gravity * depth;
}

// P_L of Eq. 4 [Pa]; temperatures [C]. Only meaningful with the weights of Eq. 21: far
// below 0 C it is about -12 MPa times a saturation of 1e-5.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value liquid_pressure_clapeyron(const Phases& phases, Value ice_pressure,
                                                                     Value temperature, double reference_temperature) {
  const Value absolute = temperature + celsius_to_kelvin;
  const double reference = reference_temperature + celsius_to_kelvin;
  return phases.water_density / phases.ice_density * ice_pressure +
         phases.water_density * phases.latent_heat * log_of_ratio(absolute, Value(reference));
}

// P_pore of Eq. 21 [Pa].
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value pore_pressure(Value saturation, Value liquid_pressure, Value ice_pressure) {
  return saturation * liquid_pressure + (Value(1) - saturation) * ice_pressure;
}

}  // namespace thawslide::physics
