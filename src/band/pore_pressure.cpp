#include "band/pore_pressure.hpp"

#include <algorithm>

#include "base/instances.hpp"
#include "mpm/cell_sums.hpp"
#include "physics/clapeyron.hpp"
#include "physics/pressurization.hpp"

namespace thawslide::band {

namespace {

using mpm::LinearLayout;

template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE LaneMask<Real> melted_before(const BandModel<Dim, Real>& model,
                                                     const mpm::Particles<Dim, Real>& particles,
                                                     const mpm::Batch<Real>& batch) {
  return particles.previous_temperature.load(batch) >= model.reference_temperature;
}

// Pressures of liquid and pore [Pa].
template <class Value>
struct Pressures {
  Value liquid, pore;
};

// Frozen or partly frozen: the liquid follows the ice (Eq. 4).
template <int Dim, class Real, class Value>
Pressures<Value> frozen_pressures(const BandModel<Dim, Real>& model, Value ice_pressure, Value temperature,
                                  Value saturation) {
  const Value liquid = physics::liquid_pressure_clapeyron(model.phases, ice_pressure, temperature,
                                                          model.reference_temperature, model.clapeyron_sign);
  return {liquid, physics::pore_pressure(saturation, liquid, ice_pressure)};
}

// Pressure at which the liquid starts when the last ice melts, continuous with Eq. 4 at Tref.
template <int Dim, class Real, class Value>
Value melting_pressure(const BandModel<Dim, Real>& model, Value ice_pressure) {
  return ice_pressure * model.phases.water_density / model.phases.ice_density;
}

// What a batch adds to the records of SeepageNodes::flows. Particles without hydraulic conductivity count for nothing;
// frozen ones count with their pores, as they do in the nodal pressure: the share that reaches them is lost to the
// sink. Left out, a node with few melted particles would drive these to pressures without bound.
template <int Dim, class Real, class Stencil>
THAWSLIDE_ALWAYS_INLINE mpm::Contribution<Dim, Real, 3> seepage_flows(
    const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, Real dt, const Stencil& stencil,
    const mpm::Patch<Dim, Real, 1>& pressure, const Lanes<Real>& hydraulic, const mpm::Batch<Real>& batch,
    mpm::Particles<Dim, Real>& particles) {
  const Lanes<Real> zero = Real(0);
  const Lanes<Real> scaling = particles.thermal_scaling.load(batch);
  const Lanes<Real> pore_scaling = physics::pore_space_scaling(scaling, model.seepage_as_printed);
  const Lanes<Real> porosity = particles.porosity.load(batch);
  const Lanes<Real> volume = particles.volume.load(batch);
  const auto flows = melted_before(model, particles, batch) & (hydraulic > Real(0));
  Lanes<Real> in_cell = zero;
  mpm::Contribution<Dim, Real, 3> carried;
  if (any(flows)) {
    const auto seen = mpm::read_nodes<1>(stencil, pressure);
    const Lanes<Real> diffusivity =
        scaling * pore_scaling *
        physics::hydraulic_diffusivity(model.phases, porosity, Lanes<Real>(Real(1)), hydraulic);
    const Lanes<Real> share =
        physics::share_of_subgrid_diffusion(diffusivity, Lanes<Real>(grid.inverse_cell()), Dim, dt);
    in_cell = select(flows, (seen.value[0] - particles.pore_pressure.load(batch)) * share, zero);
    const Lanes<Real> mobility = hydraulic / model.phases.water_unit_weight;
    const Lanes<Real> flow = select(flows, -volume * scaling * mobility * model.phases.water_bulk_modulus, zero);
    for (std::size_t a = 0; a < Dim; ++a) {
      carried.flux[a][0] = flow * seen.gradient[a][0];
    }
  }
  particles.seepage_in_cell.store(batch, in_cell);
  carried.value[1] = select(hydraulic > Real(0), volume / pore_scaling * porosity, zero);
  carried.value[2] = carried.value[1] * in_cell;
  return carried;
}

// The nodal pore pressure about tile t [Pa] (Eq. 21).
template <int Dim, class Real>
void load_pressures(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t, const mpm::Nodes<Dim, Real>& nodes,
                    mpm::Patch<Dim, Real, 1>& pressures) {
  mpm::Patch<Dim, Real, LinearLayout::size> linear;
  load_patch(grid, t, nodes.linear, linear);
  for (std::size_t k = 0; k < linear.records.size(); ++k) {
    const auto& node = linear.records[k];
    const bool has_weight = node[LinearLayout::volume] > Real(0);
    pressures.records[k][0] = has_weight ? node[LinearLayout::pore_pressure] / node[LinearLayout::volume] : Real(0);
  }
}

// Marks the tiles and blocks where water may seep; false if there are none.
template <int Dim, class Real>
bool find_seepage(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                  const mpm::Particles<Dim, Real>& particles, SeepageNodes<Dim, Real>& work) {
  work.seeping_tiles.resize(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    const auto& batches = grid.batches(t);
    const auto seeps = [&](const mpm::Batch<Real>& batch) {
      const auto melted = melted_before(model, particles, batch);
      return any(melted) && any(melted & (model.hydraulic(particles, batch) > Real(0)));
    };
    work.seeping_tiles[t] = std::any_of(batches.begin(), batches.end(), seeps) ? 1 : 0;
  });
  grid.mark_blocks_about(work.seeping_tiles, work.seeping_blocks);
  return std::any_of(work.seeping_tiles.begin(), work.seeping_tiles.end(),
                     [](std::uint8_t seeps) { return seeps != 0; });
}

// Seepage between melted particles (Eq. 23: flow times xi; pore space over xi, or whole as printed); frozen particles
// keep their pressure and act as sinks. Differences within a cell, which nodes do not see, fall by the particles' own
// subgrid diffusion, and what this changes at the nodes is taken off there (Gerya and Yuen 2003).
template <int Dim, class Real>
void seepage_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                     const mpm::Nodes<Dim, Real>& nodes, Real dt, SeepageNodes<Dim, Real>& work,
                     mpm::Particles<Dim, Real>& particles) {
  const auto patches = work.flows.patches(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    if (!grid.any_about_tile(t, work.seeping_blocks)) {
      return;
    }
    auto& patch = patches[t];
    patch.clear();
    mpm::Patch<Dim, Real, 1> pressure;
    load_pressures(grid, t, nodes, pressure);
    auto sums = mpm::linear_cell_sums<true, 3>(patch);
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      const Lanes<Real> hydraulic = model.hydraulic(particles, batch);
      const auto stencil = linear_stencil(grid, particles, batch);
      auto carried = seepage_flows(grid, model, dt, stencil, pressure, hydraulic, batch, particles);
      sums.add(stencil, batch.count, carried);
    }
  });
  work.flows.resize(grid.blocks().size());
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    if (work.seeping_blocks[b] != 0) {
      sum_patches_in_block(grid, b, patches, work.flows);
    }
  });
}

// The pressure that seepage brings to a node in a step [Pa] (Eq. 22), in place of its flows.
template <int Dim, class Real>
void load_pressure_changes(const mpm::SparseGrid<Dim, Real>& grid, std::size_t t, const SeepageNodes<Dim, Real>& work,
                           Real dt, mpm::Patch<Dim, Real, 1>& changes) {
  mpm::Patch<Dim, Real, 3> flows;
  load_patch(grid, t, work.flows, flows);
  for (std::size_t k = 0; k < flows.records.size(); ++k) {
    const auto& node = flows.records[k];
    changes.records[k][0] = node[1] > Real(0) ? (dt * node[0] - node[2]) / node[1] : Real(0);
  }
}

// Pressure of melted particles: undrained heating and seepage; seepage_change [Pa].
template <int Dim, class Real>
Lanes<Real> pressurized(const BandModel<Dim, Real>& model, const LaneMask<Real>& was_melted,
                        const Lanes<Real>& seepage_change, const mpm::Batch<Real>& batch,
                        const mpm::Particles<Dim, Real>& particles) {
  const Lanes<Real> start = melting_pressure(model, particles.ice_pressure.load(batch));
  if (!model.thermal_pressurization) {
    return start;
  }
  const Lanes<Real> porosity = particles.porosity.load(batch);
  const Lanes<Real> from =
      select(was_melted, particles.previous_temperature.load(batch), Lanes<Real>(model.reference_temperature));
  const Lanes<Real> coefficient =
      physics::undrained_pressure_coefficient(model.phases, porosity, particles.liquid_saturation.load(batch));
  Lanes<Real> pressure = select(was_melted, particles.liquid_pressure.load(batch), start) +
                         coefficient * (particles.temperature.load(batch) - from) + seepage_change;
  if (model.volumetric_term) {
    const Lanes<Real> stiffness = physics::pore_stiffness(model.phases, porosity, Lanes<Real>(Real(1)));
    pressure = select(was_melted, pressure - stiffness * particles.volume_strain.load(batch), pressure);
  }
  return pressure;
}

// Particles near the free surface of a drained body: at atmospheric pressure.
template <int Dim, class Real>
LaneMask<Real> at_surface(const mpm::SparseGrid<Dim, Real>& grid, const ColumnsOfTile<Dim, Real>& columns,
                          const mpm::Batch<Real>& batch, const mpm::Particles<Dim, Real>& particles) {
  return columns.below_top(particles, batch) < Real(0.5) * grid.cell();
}

// The melted particles of a batch.
template <int Dim, class Real>
Pressures<Lanes<Real>> melted_pressures(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                                        const ColumnsOfTile<Dim, Real>& columns, bool seepage,
                                        const mpm::Patch<Dim, Real, 1>& changes, const mpm::TileBatch<Dim, Real>& batch,
                                        const mpm::Particles<Dim, Real>& particles) {
  const Lanes<Real> zero = Real(0);
  const auto was_melted = melted_before(model, particles, batch);
  const auto permeable = model.hydraulic(particles, batch) > zero;
  Lanes<Real> seepage_change = zero;
  if (seepage && any(was_melted & permeable)) {
    const auto stencil = linear_stencil(grid, particles, batch);
    const Lanes<Real> change = particles.seepage_in_cell.load(batch) + mpm::read_nodes<1>(stencil, changes).value[0];
    seepage_change = select(was_melted & permeable, change, zero);
  }
  Lanes<Real> pressure = pressurized(model, was_melted, seepage_change, batch, particles);
  if (seepage && any(permeable)) {
    pressure = select(at_surface(grid, columns, batch, particles) & permeable, zero, pressure);
  }
  return {pressure, pressure};
}

}  // namespace

template <int Dim, class Real>
void drain_pore_pressure(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                         const FlowDepth<Dim, Real>& depth, Real dt, const mpm::Nodes<Dim, Real>& nodes,
                         SeepageNodes<Dim, Real>& work, mpm::Particles<Dim, Real>& particles) {
  const bool seepage = model.seepage && model.thermal_pressurization;
  const bool any_seeps = seepage && find_seepage(grid, model, particles, work);
  if (any_seeps) {
    seepage_to_grid(grid, model, nodes, dt, work, particles);
  }
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    mpm::Patch<Dim, Real, 1> changes;
    if (any_seeps && work.seeping_tiles[t] != 0) {
      load_pressure_changes(grid, t, work, dt, changes);
    }
    const auto columns = depth.of_tile(grid, t);
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      if (model.thickness_each_step) {
        particles.flow_depth.store(batch, columns.flow_depth(particles, batch));
      }
      const Lanes<Real> ice = physics::ice_pressure(model.phases, model.gravity, particles.flow_depth.load(batch));
      const Lanes<Real> temperature = particles.temperature.load(batch);
      particles.ice_pressure.store(batch, ice);
      const auto frozen = temperature < model.reference_temperature;
      Pressures<Lanes<Real>> now{};
      if (any(frozen)) {
        now = frozen_pressures(model, ice, temperature, particles.liquid_saturation.load(batch));
      }
      if (any(!frozen)) {
        const auto melted = melted_pressures(grid, model, columns, seepage, changes, batch, particles);
        now = {select(frozen, now.liquid, melted.liquid), select(frozen, now.pore, melted.pore)};
      }
      particles.liquid_pressure.store(batch, now.liquid);
      particles.pore_pressure.store(batch, now.pore);
    }
  });
}

template <int Dim, class Real>
void set_pore_pressure(const BandModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles, std::size_t first) {
  for (std::size_t p = first; p < particles.size(); ++p) {
    if (!model.pressure) {
      particles.pore_pressure(p) = Real(0);
      continue;
    }
    particles.ice_pressure(p) = physics::ice_pressure(model.phases, model.gravity, particles.flow_depth(p));
    if (particles.temperature(p) < model.reference_temperature) {
      const auto frozen =
          frozen_pressures(model, particles.ice_pressure(p), particles.temperature(p), particles.liquid_saturation(p));
      particles.liquid_pressure(p) = frozen.liquid;
      particles.pore_pressure(p) = frozen.pore;
    } else {
      particles.liquid_pressure(p) = melting_pressure(model, particles.ice_pressure(p));
      particles.pore_pressure(p) = particles.liquid_pressure(p);
    }
  }
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                        \
  template void drain_pore_pressure<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const BandModel<Dim, Real>&,  \
                                               const FlowDepth<Dim, Real>&, Real, const mpm::Nodes<Dim, Real>&, \
                                               SeepageNodes<Dim, Real>&, mpm::Particles<Dim, Real>&);           \
  template void set_pore_pressure<Dim, Real>(const BandModel<Dim, Real>&, mpm::Particles<Dim, Real>&, std::size_t);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
