// Particle kernels (mpm/kernel.hpp) of conduct_heat: fluxes to the nodes with the tangent capacity; sums with the
// secant capacity along the predicted change; update of the particles.
#pragma once

#include "band/particle_heat.hpp"
#include "band/physics.hpp"
#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/mapping.hpp"
#include "mpm/reading.hpp"
#include "mpm/records.hpp"
#include "physics/pressurization.hpp"

namespace thawslide::band {

// Conduction and advection (Eq. 19), and the tangent capacity. Differences within a cell, which nodes do not resolve,
// diffuse between particle and nodes; the heat that particles gain is subtracted at the nodes (subgrid diffusion; Gerya
// and Yuen 2003).
template <int Dim, class Law>
struct HeatFlows {
  using Reads = mpm::RecordList<mpm::NodalState>;
  using Adds = mpm::RecordList<mpm::HeatRates>;
  using Totals = mpm::NoTotals;

  BandPhysics model;
  HydraulicConductivity hydraulic;
  Law law;
  double dt, inverse_cell;
  // false in the first step, when prescribed temperatures jump and nodes are ahead of particles, and in the published
  // formulation
  bool subgrid;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& added, Totals& /*totals*/) const {
    using Value = typename At::Value;
    const auto state = seen.template read<mpm::NodalState, 1>(mpm::NodalState::temperature);
    const auto gradient = gradient_of(state, 0);
    const Value scaling = particles.thermal_scaling.load(at);
    const Value tangent = law.tangent(particles, at);
    const Value capacity = particles.initial_volume.load(at) / scaling * tangent;
    Value in_cell = 0.0;
    auto& rates = added.template of<mpm::HeatRates>();
    if (model.conduction) {
      const Value conductivity =
          physics::conductivity(model.phases, particles.porosity.load(at), particles.liquid_saturation.load(at));
      const Value flow = -particles.volume.load(at) * scaling * conductivity;
      for (std::size_t a = 0; a < Dim; ++a) {
        rates.flux[a][mpm::HeatRates::conduction] = flow * gradient[static_cast<int>(a)];
      }
      if (subgrid) {
        const Value inverse_layer = mpm::inverse_layer<Dim>(particles, at, inverse_cell);
        in_cell = (state.value[0] - particles.temperature.load(at)) *
                  physics::subgrid_diffusion_fraction(conductivity / tangent, inverse_layer * scaling, Dim, dt);
      }
    }
    particles.secant_capacity.store(at, tangent);
    particles.conduction_in_cell.store(at, in_cell);
    const auto melted = particles.temperature.load(at) >= model.reference_temperature;
    if (model.advection && model.seepage && model.thermal_pressurization && any(melted)) {
      if (model.conservative_advection) {
        const auto flux = carried_heat(particles, at, seen);
        for (std::size_t a = 0; a < Dim; ++a) {
          rates.flux[a][mpm::HeatRates::conduction] =
              rates.flux[a][mpm::HeatRates::conduction] + select(melted, flux[static_cast<int>(a)], Value(0.0));
        }
      } else {
        rates.value[mpm::HeatRates::advection] = select(melted, advection(particles, at, seen, gradient), Value(0.0));
      }
    }
    rates.value[mpm::HeatRates::capacity] = capacity;
    rates.value[mpm::HeatRates::subgrid] = capacity * in_cell;
  }

 private:
  // Heat advected by water seeping through melted material [W].
  template <class Particles, class At, class Seen, class Gradient>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE typename At::Value advection(const Particles& particles, const At& at,
                                                                    const Seen& seen,
                                                                    const Gradient& temperature_gradient) const {
    const auto pressure_gradient =
        gradient_of(seen.template read<mpm::NodalState, 1>(mpm::NodalState::pore_pressure), 0);
    const auto mobility =
        particles.thermal_scaling.load(at) * hydraulic(particles, at) / model.phases.water_unit_weight;
    const double capacity = model.phases.water_density * model.phases.water_heat_capacity;
    return particles.volume.load(at) * capacity * mobility * pressure_gradient.dot(temperature_gradient);
  }

  // Advection as a flux, V xi rho_L C_L q_L (T - Tref) with q_L = -(k_L/gamma_w) grad P [W m].
  template <class Particles, class At, class Seen>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto carried_heat(const Particles& particles, const At& at,
                                                         const Seen& seen) const {
    using Value = typename At::Value;
    const auto pressure_gradient =
        gradient_of(seen.template read<mpm::NodalState, 1>(mpm::NodalState::pore_pressure), 0);
    const Value mobility =
        particles.thermal_scaling.load(at) * hydraulic(particles, at) / model.phases.water_unit_weight;
    const double capacity = model.phases.water_density * model.phases.water_heat_capacity;
    const Value carried = particles.volume.load(at) * capacity * mobility *
                          (particles.temperature.load(at) - model.reference_temperature);
    return Vector<Value, Dim>(-carried * pressure_gradient);
  }
};

// Temperature change [K] in a step: interpolated from nodes plus the change within the cell.
template <class Particles, class At, class Seen>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE typename At::Value change_of_temperature(const Particles& particles, const At& at,
                                                                              const Seen& seen, double dt) {
  return particles.conduction_in_cell.load(at) +
         dt * seen.template read<mpm::NodalState, 1>(mpm::NodalState::temperature_rate).value[0];
}

// Secant capacity along the predicted change, which makes the sum of the particles' gains equal to the heat given by
// the nodes. Without a temperature change, it equals the tangent.
template <int Dim, class Law>
struct SecantCapacity {
  using Reads = mpm::RecordList<mpm::NodalState>;
  using Adds = mpm::RecordList<mpm::SecantRates>;
  using Totals = mpm::NoTotals;

  Law law;
  double dt;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& added, Totals& /*totals*/) const {
    using Value = typename At::Value;
    const Value change = change_of_temperature(particles, at, seen, dt);
    Value secant = particles.secant_capacity.load(at);  // still the tangent
    const auto negligible = law.content.is_negligible(change);
    if (any(!negligible)) {
      secant = select(negligible, secant, law.secant(particles, at, change));
      particles.secant_capacity.store(at, secant);
    }
    auto& rates = added.template of<mpm::SecantRates>();
    const Value capacity = particles.initial_volume.load(at) / particles.thermal_scaling.load(at) * secant;
    rates.value[mpm::HeatRates::capacity] = capacity;
    rates.value[mpm::HeatRates::subgrid] = capacity * particles.conduction_in_cell.load(at);
  }
};

// Adds friction heat of nodes out of reach of the linear shape functions to the particles within reach of the momentum
// shape functions, as a change within the cell.
template <int Dim>
struct RedistributeUnreachedHeat {
  using Reads = mpm::RecordList<mpm::UnreachedHeat>;
  using Adds = mpm::RecordList<>;
  using Totals = mpm::NoTotals;

  double dt;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& /*added*/, Totals& /*totals*/) const {
    const auto specific = seen.template read<mpm::UnreachedHeat, 1>().value[0];
    const auto gain = dt * specific * particles.mass.load(at) * particles.thermal_scaling.load(at) /
                      particles.initial_volume.load(at);  // [J/m3]
    particles.conduction_in_cell.store(at, particles.conduction_in_cell.load(at) +
                                               select(gain != 0.0, gain / particles.secant_capacity.load(at), gain));
  }
};

// Updates saturation and porosity after a change of temperature.
template <class Phases, class Law, class Particles, class At, class Mask, class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void follow_temperature(const Phases& phases, const Law& law, Particles& particles,
                                                             const At& at, const Mask& changed, const Value& before) {
  const Value temperature = particles.temperature.load(at), porosity = particles.porosity.load(at);
  const Value saturation = law.content.curve.saturation(temperature);
  particles.liquid_saturation.store(at, select(changed, saturation, particles.liquid_saturation.load(at)));
  const Value updated = physics::updated_porosity(phases, porosity, Value(0.0), temperature - before);
  particles.porosity.store(at, select(changed, updated, porosity));
}

// Eq. 18 for the heat content: adds the gain and updates the temperature.
template <int Dim, class Law>
struct UpdateHeat {
  using Reads = mpm::RecordList<mpm::NodalState>;
  using Adds = mpm::RecordList<>;
  using Totals = mpm::NoTotals;

  BandPhysics model;
  Law law;
  double dt;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& /*added*/, Totals& /*totals*/) const {
    using Value = typename At::Value;
    const Value secant = particles.secant_capacity.load(at);
    const Value gain = secant * change_of_temperature(particles, at, seen, dt);
    const Value temperature = particles.temperature.load(at), before = particles.heat_content.load(at);
    const Value heat_content = before + gain;
    particles.previous_temperature.store(at, temperature);
    const auto changed = heat_content != before;
    if (any(changed)) {
      particles.heat_content.store(at, heat_content);
      const Value now = law.temperature(particles, at, heat_content, temperature + gain / secant);
      particles.temperature.store(at, select(changed, now, temperature));
      follow_temperature(model.phases, law, particles, at, changed, temperature);
    }
  }
};

// Eqs. 18 and 19 as published: the old apparent capacity converts heat to a temperature change. The resulting heat
// content differs from the heat gained; the difference is summed [J].
template <int Dim, class Law>
struct UpdateHeatApparentCapacity {
  using Reads = mpm::RecordList<mpm::NodalState>;
  using Adds = mpm::RecordList<>;
  using Totals = double;

  BandPhysics model;
  Law law;
  double dt;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& /*added*/, Totals& made) const {
    using Value = typename At::Value;
    const Value tangent = particles.secant_capacity.load(at);
    const Value gain = tangent * change_of_temperature(particles, at, seen, dt);
    const Value before = particles.temperature.load(at), temperature = before + gain / tangent;
    particles.previous_temperature.store(at, before);
    particles.temperature.store(at, temperature);
    const auto changed = gain != 0.0;
    if (any(changed)) {
      follow_temperature(model.phases, law, particles, at, changed, before);
    }
    const Value conducted = tangent * (temperature - before), heat_before = particles.heat_content.load(at);
    const Value heat_after = law.heat(particles, at);
    particles.heat_content.store(at, heat_after);
    at.add_to(made, particles.initial_volume.load(at) / particles.thermal_scaling.load(at) *
                        (heat_after - heat_before - conducted));
  }
};

}  // namespace thawslide::band
