// Particle extremes that limit the time step (sim/solver/time_step.hpp).
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "band/physics.hpp"
#include "mpm/scalar_index.hpp"
#include "physics/pressurization.hpp"
#include "physics/tension_gap.hpp"

namespace thawslide::band {

// Extreme value, and the id of the first particle that has it; negative: none.
struct Extreme {
  double value = 0.0;
  std::int64_t particle = -1;

  THAWSLIDE_HD void raise(const Extreme& other) {
    if (other.value > value) {
      *this = other;
    }
  }
  THAWSLIDE_HD void lower(const Extreme& other) {
    if (other.value < value) {
      *this = other;
    }
  }
};

struct StepExtremes {
  Extreme density{std::numeric_limits<double>::infinity()};  // smallest [kg/m3]
  // smallest density at which elastic stiffness acts [kg/m3]
  Extreme elastic_density{std::numeric_limits<double>::infinity()};
  Extreme speed;                // largest [m/s]
  Extreme diffusivity;          // largest, of heat [m2/s]
  Extreme seepage;              // largest, of pore pressure [m2/s]
  double pore_stiffness = 0.0;  // largest [Pa]
  double slope = 0.0;           // largest, of the ground below particles [1]

  THAWSLIDE_HD StepExtremes& operator+=(const StepExtremes& part) {
    density.lower(part.density);
    elastic_density.lower(part.elastic_density);
    speed.raise(part.speed);
    diffusivity.raise(part.diffusivity);
    seepage.raise(part.seepage);
    pore_stiffness = part.pore_stiffness > pore_stiffness ? part.pore_stiffness : pore_stiffness;
    slope = part.slope > slope ? part.slope : slope;
    return *this;
  }
};

// Free gaps by material (physics/tension_gap.hpp).
struct FreeGaps {
  const double* of_material;  // 1: free; 0: gaps bear stress

  // Density of the particle at which elastic stiffness acts [kg/m3].
  template <class Particles>
  [[nodiscard]] THAWSLIDE_HD double elastic_density(const Particles& particles, std::uint32_t p) const {
    const double density = particles.mass(p) / particles.volume(p);
    const bool is_free = of_material[static_cast<std::size_t>(particles.material(p))] > 0.0;
    return is_free && particles.gap.is_kept() ? physics::density_with_gap_closed(density, particles.gap(p)) : density;
  }
};

// Extremes of one particle.
template <int Dim>
struct ExtremesOfParticle {
  using Sums = StepExtremes;

  BandPhysics model;
  HydraulicConductivity hydraulic;
  FreeGaps free_gaps;

  template <class Particles>
  THAWSLIDE_HD StepExtremes operator()(const Particles& particles, std::uint32_t p) const {
    using std::sqrt;
    const std::int64_t id = particles.id(p);
    const double porosity = particles.initial_porosity(p), saturation = particles.liquid_saturation(p);
    const double storing = physics::storing_porosity(model.phases, porosity, model.skeleton_compressibility);
    double speed2 = 0.0;
    for (int a = 0; a < Dim; ++a) {
      speed2 += particles.velocity(p, a) * particles.velocity(p, a);
    }
    StepExtremes found;
    found.density = {particles.mass(p) / particles.volume(p), id};
    found.elastic_density = {free_gaps.elastic_density(particles, p), id};
    found.speed.raise({sqrt(speed2), id});
    found.diffusivity.raise({physics::conductivity(model.phases, porosity, saturation) /
                                 physics::heat_capacity(model.phases, porosity, saturation),
                             id});
    found.seepage.raise(
        {physics::hydraulic_diffusivity(model.phases, storing, 1.0, hydraulic(particles, mpm::ScalarIndex{{p}})), id});
    found.pore_stiffness = physics::pore_stiffness(model.phases, storing, 1.0);
    if (particles.ground_slope.is_kept()) {
      double slope2 = 0.0;
      for (int a = 0; a + 1 < Dim; ++a) {
        slope2 += particles.ground_slope(p, a) * particles.ground_slope(p, a);
      }
      found.slope = sqrt(slope2);
    }
    return found;
  }
};

}  // namespace thawslide::band
