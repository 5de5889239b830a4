// Change of a particle's band scaling. For host and device.
#pragma once

#include "band/heat_kernels.hpp"
#include "band/pressure_kernels.hpp"
#include "mpm/scalar_index.hpp"

namespace thawslide::band {

// Thickness [m], along the normal of the ground below a particle, of the layers of cells that follow the ground.
template <int Dim, class Particles>
THAWSLIDE_HD double layer_along_normal(double cell, const Particles& particles, std::uint32_t p) {
  using std::sqrt;
  double square = 1.0;
  for (int a = 0; a + 1 < Dim; ++a) {
    square += particles.ground_slope(p, a) * particles.ground_slope(p, a);
  }
  return cell / sqrt(square);
}

// Scaling xi of particles. thickness: of the band; 0: there is none.
template <int Dim>
struct BandScaling {
  bool everywhere;         // also outside the band
  bool follows_ground;     // layers of cells follow the ground
  double cell, thickness;  // [m]

  template <class Particles>
  [[nodiscard]] THAWSLIDE_HD double of(const Particles& particles, std::uint32_t p) const {
    if (!(thickness > 0.0) || !(everywhere || particles.in_band(p) != 0)) {
      return 1.0;
    }
    return (follows_ground ? layer_along_normal<Dim>(cell, particles, p) : cell) / thickness;
  }
};

// Mixes the water of a particle's part of the band with that of joining material in its state at t = 0. kept: fraction
// of the previous band. before, joining: temperatures [C]. Melted material swells or contracts on the way to the
// temperature of the mixture.
template <class Particles>
THAWSLIDE_HD void mix_water(const BandPhysics& model, double kept, double before, double joining, std::uint32_t p,
                            Particles& particles) {
  const double tref = model.reference_temperature, porosity = particles.porosity(p);
  const double to = max(particles.temperature(p), tref);
  const bool was_melted = before >= tref, is_melted = particles.temperature(p) >= tref;
  const double start = thawing_pressure(model, particles, mpm::ScalarIndex{{p}});
  const double pressure = was_melted ? particles.liquid_pressure(p) : start;
  double mixed = start;
  if (model.balances_water()) {
    const double storage = physics::pore_storage(model.phases, porosity, model.skeleton_compressibility);
    const auto surplus = [&](double excess, double gas_void, double from) {
      return physics::pore_surplus<double>({excess, gas_void, 0.0}, storage) +
             physics::melted_swelling(model.phases, model.water, porosity, max(from, tref), to);
    };
    const double own = surplus(pressure, particles.pore_void(p), before);
    const double own_void = was_melted ? max(-own, 0.0) : particles.pore_void(p);
    const double new_void = void_at_start(model, particles, p);
    const auto filling = physics::pore_filling(physics::mixed(own, surplus(start, new_void, joining), kept), storage);
    particles.pore_void(p) = is_melted ? filling.gas_void : physics::mixed(own_void, new_void, kept);
    mixed = model.thermal_pressurization ? filling.pressure : start;
  } else if (model.thermal_pressurization) {
    const double coefficient = physics::undrained_pressure_coefficient(model.phases, porosity, 1.0);
    mixed = physics::mixed(pressure + coefficient * (to - max(before, tref)),
                           start + coefficient * (to - max(joining, tref)), kept);
  }
  if (is_melted) {
    particles.liquid_pressure(p) = particles.pore_pressure(p) = mixed;
  }
}

// Mixes material in its state at t = 0, with its own heat and water, into a particle's part of the band. kept: fraction
// of the previous band in the mixture. Porosity follows temperature as in a step. has_water: pore pressures change.
template <class Law, class Particles>
THAWSLIDE_HD void mix_in(const BandPhysics& model, const Law& law, bool has_water, double kept, std::uint32_t p,
                         Particles& particles) {
  const mpm::ScalarIndex one{{p}};
  const double before = particles.temperature(p);
  const double joining = law.temperature(particles, one, particles.initial_heat_content(p), before);
  particles.heat_content(p) = physics::mixed(particles.heat_content(p), particles.initial_heat_content(p), kept);
  particles.temperature(p) = law.temperature(particles, one, particles.heat_content(p), before);
  follow_temperature(model.phases, law, particles, one, true, before);
  if (has_water) {
    mix_water(model, kept, before, joining, p, particles);
  }
}

// Kernel (mpm/kernel.hpp) that sets the scaling of particles at memory index `first` and above; sums the heat [J] that
// this adds at constant temperature and pressure. has_water: pore pressures change.
template <int Dim, class Law>
struct RescaleBand {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = double;

  BandPhysics model;
  Law law;
  bool has_water;
  BandScaling<Dim> scaling;
  std::size_t first;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                               double& added_heat) const {
    at.for_each([&](std::uint32_t p) {
      const double old = particles.thermal_scaling(p), now = scaling.of(particles, p);
      if (p < first || now == old) {
        return;
      }
      const bool mixes = model.rescaling_mixes && now < old;
      const double heat = mixes ? particles.initial_heat_content(p) : particles.heat_content(p);
      added_heat += particles.initial_volume(p) * heat * (1.0 / now - 1.0 / old);
      particles.thermal_scaling(p) = now;
      if (mixes) {
        mix_in(model, law, has_water, now / old, p, particles);
      }
    });
  }
};

}  // namespace thawslide::band
