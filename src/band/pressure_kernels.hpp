// What a particle does in drain_pore_pressure: kernels (mpm/kernel.hpp).
#pragma once

#include "band/physics.hpp"
#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/reading.hpp"
#include "mpm/records.hpp"
#include "physics/clapeyron.hpp"
#include "physics/pressurization.hpp"

namespace thawslide::band {

template <class Real, class Particles, class At>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto melted_before(const BandPhysics<Real>& model, const Particles& particles,
                                                        const At& at) {
  return particles.previous_temperature.load(at) >= model.reference_temperature;
}

// Pressures of liquid and pore [Pa].
template <class Value>
struct Pressures {
  Value liquid, pore;
};

// Frozen or partly frozen: the liquid follows the ice (Eq. 4).
template <class Real, class Value>
THAWSLIDE_HD Pressures<Value> frozen_pressures(const BandPhysics<Real>& model, Value ice_pressure, Value temperature,
                                               Value saturation) {
  const Value liquid = physics::liquid_pressure_clapeyron(model.phases, ice_pressure, temperature,
                                                          model.reference_temperature, model.clapeyron_sign);
  return {liquid, physics::pore_pressure(saturation, liquid, ice_pressure)};
}

// Pressure at which the liquid starts when the last ice melts, continuous with Eq. 4 at Tref.
template <class Real, class Value>
THAWSLIDE_HD Value melting_pressure(const BandPhysics<Real>& model, Value ice_pressure) {
  return ice_pressure * model.phases.water_density / model.phases.ice_density;
}

// Seepage between melted particles (Eq. 23: flow times xi; pore space over xi, or whole as printed); frozen particles
// keep their pressure and act as sinks. Differences within a cell, which nodes do not see, diffuse between particle and
// nodes by themselves, and what this changes at the nodes is taken off there (Gerya and Yuen 2003). Particles without
// hydraulic conductivity count for nothing; frozen ones count with their pores, as they do in the nodal pressure: the
// share that reaches them is lost to the sink. Left out, a node with few melted particles would drive these to
// pressures without bound.
template <int Dim, class Real>
struct SeepageFlows {
  using Reads = mpm::RecordList<mpm::NodalState>;
  using Adds = mpm::RecordList<mpm::Seepage>;
  using Account = mpm::NoAccount;

  const BandPhysics<Real>& model;
  HydraulicConductivity<Real> hydraulic_conductivity;
  Real dt, inverse_cell;

  template <class Particles, class At, class Seen, class Added>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Added& added, Account& /*account*/) const {
    using Value = typename At::Value;
    const Value zero = Real(0);
    const Value hydraulic = hydraulic_conductivity(particles, at);
    const Value scaling = particles.thermal_scaling.load(at);
    const Value pore_scaling = physics::pore_space_scaling(scaling, model.seepage_as_printed);
    const Value porosity = particles.porosity.load(at), volume = particles.volume.load(at);
    const auto flows = melted_before(model, particles, at) & (hydraulic > Real(0));
    auto& seepage = added.template of<mpm::Seepage>();
    Value in_cell = zero;
    if (any(flows)) {
      const auto state = seen.template read<mpm::NodalState, 1>(mpm::NodalState::pore_pressure);
      const Value diffusivity =
          scaling * pore_scaling * physics::hydraulic_diffusivity(model.phases, porosity, Value(Real(1)), hydraulic);
      const Value share = physics::share_of_subgrid_diffusion(diffusivity, Value(inverse_cell), Dim, dt);
      in_cell = select(flows, (state.value[0] - particles.pore_pressure.load(at)) * share, zero);
      const Value mobility = hydraulic / model.phases.water_unit_weight;
      const Value flow = select(flows, -volume * scaling * mobility * model.phases.water_bulk_modulus, zero);
      for (std::size_t a = 0; a < Dim; ++a) {
        seepage.flux[a][mpm::Seepage::inflow] = flow * state.gradient[a][0];
      }
    }
    particles.seepage_in_cell.store(at, in_cell);
    const Value pore_space = select(hydraulic > Real(0), volume / pore_scaling * porosity, zero);
    seepage.value[mpm::Seepage::pore_space] = pore_space;
    seepage.value[mpm::Seepage::subgrid] = pore_space * in_cell;
  }
};

// Depth, ice pressure, and the pressures of liquid and pore: Clapeyron while ice and water coexist, then thermal
// pressurization and seepage. Columns: of the slide, with the flow depth of a particle and its depth below the top.
// Seeps: somewhere water seeps.
template <class Real, class Columns, bool Seeps>
struct PorePressure {
  using Reads = std::conditional_t<Seeps, mpm::RecordList<mpm::NodalState>, mpm::RecordList<>>;
  using Adds = mpm::RecordList<>;
  using Account = mpm::NoAccount;

  const BandPhysics<Real>& model;
  HydraulicConductivity<Real> hydraulic_conductivity;
  Real drained_depth;  // below the top, where the pressure of a permeable body is 0 [m]
  Columns columns;

  template <class Particles, class At, class Seen, class Added>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void operator()(Particles& particles, const At& at, const Seen& seen,
                                                       Added& /*added*/, Account& /*account*/) const {
    using Value = typename At::Value;
    if (model.thickness_each_step) {
      particles.flow_depth.store(at, columns.flow_depth(particles, at));
    }
    const Value ice = physics::ice_pressure(model.phases, model.gravity, particles.flow_depth.load(at));
    const Value temperature = particles.temperature.load(at);
    particles.ice_pressure.store(at, ice);
    const auto frozen = temperature < model.reference_temperature;
    Pressures<Value> now{};
    if (any(frozen)) {
      now = frozen_pressures(model, ice, temperature, particles.liquid_saturation.load(at));
    }
    if (any(!frozen)) {
      const Value melted = melted_pressure(particles, at, seen);
      now = {select(frozen, now.liquid, melted), select(frozen, now.pore, melted)};
    }
    particles.liquid_pressure.store(at, now.liquid);
    particles.pore_pressure.store(at, now.pore);
  }

 private:
  // Undrained heating and seepage; 0 near the free surface of a drained body.
  template <class Particles, class At, class Seen>
  THAWSLIDE_HD typename At::Value melted_pressure(const Particles& particles, const At& at,
                                                  [[maybe_unused]] const Seen& seen) const {
    using Value = typename At::Value;
    const Value zero = Real(0);
    const bool seepage = model.seepage && model.thermal_pressurization;
    const auto was_melted = melted_before(model, particles, at);
    const auto permeable = hydraulic_conductivity(particles, at) > zero;
    Value seeped = zero;
    if constexpr (Seeps) {
      if (any(was_melted & permeable)) {
        const auto change = seen.template read<mpm::NodalState, 1>(mpm::NodalState::pressure_change).value[0];
        seeped = select(was_melted & permeable, particles.seepage_in_cell.load(at) + change, zero);
      }
    }
    const Value pressure = pressurized(particles, at, was_melted, seeped);
    if (seepage && any(permeable)) {
      const auto at_surface = columns.below_top(particles, at) < drained_depth;
      return select(at_surface & permeable, zero, pressure);
    }
    return pressure;
  }

  // `seeped`: what seepage changes [Pa].
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
    const Value stiffness = physics::pore_stiffness(model.phases, porosity, Value(Real(1)));
    return select(was_melted, pressure - stiffness * particles.volume_strain.load(at), pressure);
  }
};

}  // namespace thawslide::band
