// Sums over particles for history rows and budgets.
#pragma once

#include <cstdint>

#include "base/linear.hpp"
#include "base/sums.hpp"
#include "mpm/front.hpp"
#include "physics/mixture.hpp"
#include "physics/pore_water.hpp"

namespace thawslide::band {

template <int Dim>
struct BodySums {
  Vector<double, Dim> momentum = Vector<double, Dim>::Zero();   // [kg m/s]
  double kinetic = 0, potential = 0, sensible = 0, latent = 0;  // [J]
  ExactSum mass;                                                // [kg]; exact, because it must be conserved bitwise
  double rock = 0, ice = 0, water = 0;                          // [kg]
  double seeped = 0;                                            // net water gained by seepage [kg]
  double gas = 0;                                               // void in the pores of the band's own material [m3]
  double initial_volume = 0, volume_change = 0;                 // at t = 0 or on joining; change since then [m3]
  double largest_speed2 = 0;                                    // squared [m2/s2]
  double moved_mass = 0;                                        // farther than SumsOfParticle::moved_distance [kg]
  mpm::BodySet moved_bodies;                                    // with such mass
  // Weighted by mass: path length of particles [kg m] and plastic strain [kg].
  double displacement = 0, plastic_strain = 0;
  // Sums over particles in the band: mass [kg], temperature [kg C], saturation [kg] and pore pressure [kg Pa].
  double band_mass = 0, band_temperature = 0, band_saturation = 0, band_pore_pressure = 0;

  THAWSLIDE_HD BodySums& operator+=(const BodySums& part) {
    kinetic += part.kinetic;
    potential += part.potential;
    sensible += part.sensible;
    latent += part.latent;
    mass += part.mass;
    rock += part.rock;
    ice += part.ice;
    water += part.water;
    seeped += part.seeped;
    gas += part.gas;
    initial_volume += part.initial_volume;
    volume_change += part.volume_change;
    for (int a = 0; a < Dim; ++a) {
      momentum[a] += part.momentum[a];
    }
    largest_speed2 = part.largest_speed2 > largest_speed2 ? part.largest_speed2 : largest_speed2;
    moved_mass += part.moved_mass;
    moved_bodies |= part.moved_bodies;
    displacement += part.displacement;
    plastic_strain += part.plastic_strain;
    band_mass += part.band_mass;
    band_temperature += part.band_temperature;
    band_saturation += part.band_saturation;
    band_pore_pressure += part.band_pore_pressure;
    return *this;
  }
};

// Contribution of one particle.
template <int Dim>
struct SumsOfParticle {
  using Sums = BodySums<Dim>;

  Vector<double, Dim> gravity, origin;  // [m/s2]; of positions [m]
  physics::Phases phases;
  bool latent;            // melting consumes latent heat
  bool melt_contracts;    // melting leaves a void
  double moved_distance;  // [m]

  template <class Particles>
  [[nodiscard]] THAWSLIDE_HD BodySums<Dim> operator()(const Particles& particles, std::uint32_t p) const {
    const double mass = particles.mass(p);
    BodySums<Dim> sums;
    sums.mass = mass;
    for (int a = 0; a < Dim; ++a) {
      const double velocity = particles.velocity(p, a);
      sums.momentum[a] = mass * velocity;
      sums.largest_speed2 += velocity * velocity;
      sums.kinetic += 0.5 * mass * velocity * velocity;
      sums.potential -= mass * gravity[a] * (particles.position(p, a) + origin[a]);
    }
    if (particles.path_length(p) > moved_distance) {
      sums.moved_mass = mass;
      sums.moved_bodies.add(static_cast<std::size_t>(particles.body(p)));
    }
    sums.displacement = mass * particles.path_length(p);
    sums.plastic_strain = mass * particles.plastic_strain(p);
    add_heat(particles, p, sums);
    add_phases(particles, p, sums);
    sums.seeped = particles.seeped_water.is_kept() ? particles.seeped_water(p) : 0.0;
    sums.gas = void_in_pores(particles, p);
    sums.initial_volume = particles.initial_volume(p);
    sums.volume_change = particles.volume(p) - particles.initial_volume(p);
    if (particles.in_band(p) != 0) {
      sums.band_mass = mass;
      sums.band_temperature = mass * particles.temperature(p);
      sums.band_saturation = mass * particles.liquid_saturation(p);
      sums.band_pore_pressure = mass * particles.pore_pressure(p);
    }
    return sums;
  }

 private:
  template <class Particles>
  THAWSLIDE_HD void add_heat(const Particles& particles, std::uint32_t p, BodySums<Dim>& sums) const {
    const double pore = particles.initial_volume(p) * particles.initial_porosity(p);
    const double molten =
        latent ? phases.ice_density * pore * phases.latent_heat * particles.liquid_saturation(p) : 0.0;
    sums.latent = molten / particles.thermal_scaling(p);
    sums.sensible = (particles.initial_volume(p) * particles.heat_content(p) - molten) / particles.thermal_scaling(p);
  }

  // The sum of ice and water is that at t = 0. Heat acts on the volume V/xi of a particle, the band's own part, and
  // only that part melts. The rest represents material in its state at t = 0.
  template <class Particles>
  THAWSLIDE_HD void add_phases(const Particles& particles, std::uint32_t p, BodySums<Dim>& sums) const {
    const double start = particles.initial_saturation(p);
    const double saturation = start + (particles.liquid_saturation(p) - start) / particles.thermal_scaling(p);
    const double pore_water = particles.initial_volume(p) * particles.initial_porosity(p) *
                              (phases.water_density * start + phases.ice_density * (1.0 - start));
    sums.rock = sums.mass - pore_water;
    sums.ice = (1.0 - saturation) * pore_water;
    sums.water = saturation * pore_water;
  }

  // Void in the pores of a particle's own part of the band [m3]. Pores that are still frozen have less void than their
  // water will leave.
  template <class Particles>
  [[nodiscard]] THAWSLIDE_HD double void_in_pores(const Particles& particles, std::uint32_t p) const {
    if (!particles.pore_void.is_kept()) {
      return 0.0;
    }
    const double frozen = melt_contracts ? physics::melting_void(phases, particles.initial_porosity(p),
                                                                 1.0 - particles.liquid_saturation(p))
                                         : 0.0;
    const double open = particles.pore_void(p) - frozen;
    return (open > 0.0 ? open : 0.0) * particles.volume(p) / particles.thermal_scaling(p);
  }
};

}  // namespace thawslide::band
