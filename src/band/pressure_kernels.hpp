// Particle kernels (mpm/kernel.hpp) of drain_pore_pressure.
#pragma once

#include "band/physics.hpp"
#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/mapping.hpp"
#include "mpm/reading.hpp"
#include "mpm/records.hpp"
#include "physics/pressurization.hpp"

namespace thawslide::band {

template <class Particles, class At>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto melted_before(const BandPhysics& model, const Particles& particles,
                                                        const At& at) {
  return particles.previous_temperature.load(at) >= model.reference_temperature;
}

// Pressures of liquid and pore [Pa].
template <class Value>
struct Pressures {
  Value liquid, pore;
};

// Frozen or partly frozen: the liquid follows the ice (Eq. 4).
template <class Value>
THAWSLIDE_HD Pressures<Value> frozen_pressures(const BandPhysics& model, Value ice_pressure, Value temperature,
                                               Value saturation) {
  const Value liquid =
      physics::liquid_pressure_clapeyron(model.phases, ice_pressure, temperature, model.reference_temperature);
  return {liquid, physics::pore_pressure(saturation, liquid, ice_pressure)};
}

// Initial liquid pressure when the last ice melts, before water fills a void. melting_pressure: continuous with Eq. 4
// at Tref. thawing_pressure: if ice does not press, the part of the load transferred to the water.
template <class Value>
THAWSLIDE_HD Value melting_pressure(const BandPhysics& model, Value ice_pressure) {
  return ice_pressure * model.phases.water_density / model.phases.ice_density;
}
template <class Particles, class At>
THAWSLIDE_HD typename At::Value thawing_pressure(const BandPhysics& model, const Particles& particles, const At& at) {
  if (model.ice_presses) {
    return melting_pressure(model, particles.ice_pressure.load(at));
  }
  return physics::thawing_pressure(particles.normal_load.load(at), typename At::Value(model.residual_stress));
}

// Void left by a particle's water after complete melting, at t = 0 (physics/pore_water.hpp).
template <class Particles>
THAWSLIDE_HD double void_at_start(const BandPhysics& model, const Particles& particles, std::size_t p) {
  return model.melt_contracts
             ? physics::melting_void(model.phases, particles.initial_porosity(p), 1.0 - particles.initial_saturation(p))
             : 0.0;
}

// Seepage between melted particles (Eq. 23: flow times xi, pore space over xi). Frozen particles keep their pressure
// and act as sinks. Differences within a cell, which nodes do not resolve, diffuse between particle and nodes; the
// change is subtracted at the nodes (Gerya and Yuen 2003). Impermeable particles do not contribute. Frozen particles
// contribute their pores if these are part of the nodal pressure (FrozenRows); water that reaches them is lost to the
// sink. Including them in only one of the two would give unbounded pressures at nodes with few melted particles.
template <int Dim>
struct SeepageFlows {
  using Reads = mpm::RecordList<mpm::NodalState>;
  using Adds = mpm::RecordList<mpm::Seepage>;
  using Totals = mpm::NoTotals;

  BandPhysics model;
  HydraulicConductivity hydraulic_conductivity;
  double dt, inverse_cell;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& added, Totals& /*totals*/) const {
    using Value = typename At::Value;
    const Value zero = 0.0;
    const Value hydraulic = hydraulic_conductivity(particles, at);
    const Value scaling = particles.thermal_scaling.load(at);
    const Value volume = particles.volume.load(at);
    const Value storing =
        physics::storing_porosity(model.phases, particles.porosity.load(at), model.skeleton_compressibility);
    const auto flows = melted_before(model, particles, at) & (hydraulic > 0.0);
    auto& seepage = added.template of<mpm::Seepage>();
    Value in_cell = zero;
    if (any(flows)) {
      const auto state = seen.template read<mpm::NodalState, 1>(mpm::NodalState::pore_pressure);
      const Value diffusivity =
          scaling * scaling * physics::hydraulic_diffusivity(model.phases, storing, Value(1.0), hydraulic);
      const Value inverse_layer = mpm::inverse_layer<Dim>(particles, at, inverse_cell);
      const Value fraction = physics::subgrid_diffusion_fraction(diffusivity, inverse_layer, Dim, dt);
      in_cell = select(flows, (state.value[0] - particles.pore_pressure.load(at)) * fraction, zero);
      const Value mobility = hydraulic / model.phases.water_unit_weight;
      const Value flow = select(flows, -volume * scaling * mobility * model.phases.water_bulk_modulus, zero);
      for (std::size_t a = 0; a < Dim; ++a) {
        seepage.flux[a][mpm::Seepage::inflow] = flow * state.gradient[a][0];
      }
    }
    particles.seepage_in_cell.store(at, in_cell);
    const auto participates = model.frozen_rows == FrozenRows::sealed ? flows : hydraulic > 0.0;
    const Value pore_space = select(participates, volume / scaling * storing, zero);
    seepage.value[mpm::Seepage::pore_space] = pore_space;
    seepage.value[mpm::Seepage::seeping] = select(flows, pore_space, zero);
    seepage.value[mpm::Seepage::subgrid] = pore_space * in_cell;
  }
};

// Water that leaves the body at its surface, and the heat that it carries.
struct DrainedWater {
  double mass = 0, heat = 0;  // [kg], [J]

  THAWSLIDE_HD DrainedWater& operator+=(const DrainedWater& part) {
    mass += part.mass;
    heat += part.heat;
    return *this;
  }
};
// Water lost by particles in one step: at the surface, with its heat, and to frozen pores.
struct WaterLoss {
  DrainedWater drained;
  double absorbed = 0;  // pressure change times frozen pore space [Pa m3]

  [[nodiscard]] double vented(const physics::Phases& phases) const {  // [kg]
    return phases.water_density / phases.water_bulk_modulus * absorbed;
  }
};

// Flow depth, ice pressure, and pressures of liquid and pore: Clapeyron while ice and water coexist, then thermal
// pressurization and seepage. Columns: of the sliding mass, with flow depth and depth below the top. Seeps: water seeps
// somewhere. Balances: BandPhysics::balances_water().
template <class Columns, bool Seeps, bool Balances>
struct PorePressure {
  using Reads = std::conditional_t<Seeps, mpm::RecordList<mpm::NodalState>, mpm::RecordList<>>;
  using Adds = mpm::RecordList<>;
  using Totals = DrainedWater;

  const BandPhysics& model;
  HydraulicConductivity hydraulic_conductivity;
  double drained_depth;  // depth below the top within which the pressure of a permeable body is 0 [m]
  Columns columns;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Scatter& /*added*/, Totals& drained) const {
    using Value = typename At::Value;
    if (model.thickness_each_step) {
      particles.flow_depth.store(at, columns.flow_depth(particles, at));
    }
    const Value ice = physics::ice_pressure(model.phases, model.gravity, particles.flow_depth.load(at));
    const Value temperature = particles.temperature.load(at);
    particles.ice_pressure.store(at, ice);
    const auto frozen = temperature < model.reference_temperature;
    Pressures<Value> now{};
    if (any(frozen) && (!Balances || model.ice_presses)) {
      now = frozen_pressures(model, ice, temperature, particles.liquid_saturation.load(at));
    }
    // newly frozen water still contracts down to Tref
    if (any(!frozen) || (Balances && any(melted_before(model, particles, at)))) {
      const Value melted = melted_pressure(particles, at, seen, !frozen, drained);
      now = {select(frozen, now.liquid, melted), select(frozen, now.pore, melted)};
    }
    particles.liquid_pressure.store(at, now.liquid);
    particles.pore_pressure.store(at, now.pore);
  }

 private:
  // Pressure from heating, load and seepage; 0 near the free surface of a drained body.
  template <class Particles, class At, class Seen, class Mask>
  THAWSLIDE_HD typename At::Value melted_pressure(Particles& particles, const At& at, [[maybe_unused]] const Seen& seen,
                                                  const Mask& melted, Totals& drained) const {
    using Value = typename At::Value;
    const Value zero = 0.0;
    const bool seepage = model.seepage && model.thermal_pressurization;
    const auto was_melted = melted_before(model, particles, at);
    const auto permeable = hydraulic_conductivity(particles, at) > zero;
    Value seeped = zero;
    if constexpr (Seeps) {
      if (any(was_melted & permeable)) {
        const auto change = seen.template read<mpm::NodalState, 1>(mpm::NodalState::pressure_change).value[0];
        seeped = select(was_melted & permeable, particles.seepage_in_cell.load(at) + change, zero);
        remove_water(particles, at, water_of(particles, at, seeped));
      }
    }
    const Value pressure =
        Balances ? balanced(particles, at, melted, was_melted, seeped) : pressurized(particles, at, was_melted, seeped);
    if (seepage && any(permeable)) {
      const auto at_surface = (columns.below_top(particles, at) < drained_depth) & permeable;
      if (any(at_surface & melted)) {
        drain(particles, at, select(at_surface & melted, pressure, zero), drained);
      }
      return select(at_surface, zero, pressure);
    }
    return pressure;
  }

  // Eq. 23 as published. seeped: pressure change by seepage [Pa].
  template <class Particles, class At, class Mask>
  THAWSLIDE_HD typename At::Value pressurized(const Particles& particles, const At& at, const Mask& was_melted,
                                              const typename At::Value& seeped) const {
    using Value = typename At::Value;
    const Value start = melting_pressure(model, particles.ice_pressure.load(at));
    if (!model.thermal_pressurization) {
      return start;
    }
    const Value porosity = particles.porosity.load(at);
    const Value from = select(was_melted, particles.previous_temperature.load(at), Value(model.reference_temperature));
    const Value coefficient =
        physics::undrained_pressure_coefficient(model.phases, porosity, particles.liquid_saturation.load(at));
    const Value pressure = select(was_melted, particles.liquid_pressure.load(at), start) +
                           coefficient * (particles.temperature.load(at) - from) + seeped;
    if (!model.volumetric_term) {
      return pressure;
    }
    const Value stiffness = physics::pore_stiffness(model.phases, porosity, Value(1.0));
    return select(was_melted, pressure - stiffness * particles.volume_strain.load(at), pressure);
  }

  // The same from the water balance of the pore, whose surplus is a pressure or a void.
  template <class Particles, class At, class Mask>
  THAWSLIDE_HD typename At::Value balanced(Particles& particles, const At& at, const Mask& melted,
                                           const Mask& was_melted, const typename At::Value& seeped) const {
    using Value = typename At::Value;
    const Value porosity = particles.porosity.load(at), gas_void = particles.pore_void.load(at), none = 0.0;
    const Value storage = physics::pore_storage(model.phases, porosity, model.skeleton_compressibility);
    const Value start = thawing_pressure(model, particles, at);
    if (!model.thermal_pressurization) {
      return max(start - gas_void / storage, none);
    }
    const Value from = select(was_melted, particles.previous_temperature.load(at), Value(model.reference_temperature));
    const Value to = max(particles.temperature.load(at), Value(model.reference_temperature));
    Value gained = physics::melted_swelling(model.phases, model.water, porosity, from, to);
    if (model.skeleton_compressibility > 0.0) {
      gained += select(was_melted, model.skeleton_compressibility * particles.load_change.load(at), none);
    }
    if (model.volumetric_term) {
      gained -= select(was_melted, particles.volume_strain.load(at), none);
    }
    const Value before = select(was_melted, particles.liquid_pressure.load(at), start);
    const Value surplus = physics::pore_surplus<Value>({before + seeped, gas_void, none}, storage) + gained;
    const auto filling = physics::pore_filling(surplus, storage);
    particles.pore_void.store(at, select(melted | was_melted, filling.gas_void, gas_void));
    return filling.pressure;
  }

  // Mass of water stored by a pressure change [Pa] in the particle's own part of the band [kg].
  template <class Particles, class At>
  THAWSLIDE_HD typename At::Value water_of(const Particles& particles, const At& at,
                                           const typename At::Value& pressure) const {
    using Value = typename At::Value;
    const Value storage =
        physics::pore_storage(model.phases, particles.porosity.load(at), model.skeleton_compressibility);
    const Value scaling = particles.thermal_scaling.load(at);
    return model.phases.water_density * storage * pressure * particles.volume.load(at) / scaling;
  }

  template <class Particles, class At>
  THAWSLIDE_HD static void remove_water(Particles& particles, const At& at, const typename At::Value& mass) {
    particles.seeped_water.store(at, particles.seeped_water.load(at) + mass);
  }

  // Removes the water stored by a pressure [Pa] from the body. With conservative advection, its heat is removed too,
  // from the heat content of melted material, which is linear.
  template <class Particles, class At>
  THAWSLIDE_HD void drain(Particles& particles, const At& at, const typename At::Value& pressure,
                          Totals& drained) const {
    using Value = typename At::Value;
    const Value mass = water_of(particles, at, pressure);
    remove_water(particles, at, -mass);
    at.add_to(drained.mass, mass);
    if (model.conservative_advection) {
      const Value temperature = particles.temperature.load(at),
                  of_band = particles.initial_volume.load(at) / particles.thermal_scaling.load(at);
      const Value heat =
          max(mass, Value(0.0)) * model.phases.water_heat_capacity * (temperature - model.reference_temperature);
      const Value capacity =
          physics::heat_capacity(model.phases, particles.initial_porosity.load(at), Value(1.0)) * of_band;
      particles.heat_content.store(at, particles.heat_content.load(at) - heat / of_band);
      particles.temperature.store(at, temperature - heat / capacity);
      at.add_to(drained.heat, heat);
    }
  }
};

template <class Columns, bool Seeps, bool Balances>
struct UpdatePorePressure {
  using InTile = PorePressure<typename Columns::OfTile, Seeps, Balances>;
  using Reads = typename InTile::Reads;
  using Adds = typename InTile::Adds;
  using Totals = typename InTile::Totals;

  BandPhysics model;
  HydraulicConductivity hydraulic;
  Columns columns;  // by tile

  [[nodiscard]] THAWSLIDE_HD InTile in_tile(std::size_t tile) const {
    return {model, hydraulic, 0.5 * columns.cell, columns.of_tile(tile)};
  }
};

}  // namespace thawslide::band
