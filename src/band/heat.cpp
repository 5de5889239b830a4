#include "band/heat.hpp"

#include <algorithm>

#include "band/heat_nodes.hpp"
#include "band/particle_heat.hpp"
#include "base/instances.hpp"
#include "mpm/cell_sums.hpp"
#include "physics/pressurization.hpp"

namespace thawslide::band {

namespace {

// Water seeps where it is melted; the heat it carries [W].
template <int Dim, class Real, class Stencil>
Lanes<Real> advected_heat(const BandModel<Dim, Real>& model, const Stencil& stencil,
                          const mpm::Patch<Dim, Real, 3>& state, const Vector<Lanes<Real>, Dim>& temperature_gradient,
                          const LaneMask<Real>& melted, const mpm::Batch<Real>& batch,
                          const mpm::Particles<Dim, Real>& particles) {
  const Vector<Lanes<Real>, Dim> pressure_gradient = gradient_of(read_nodes<1>(stencil, state, 1), 0);
  const Lanes<Real> mobility =
      particles.thermal_scaling.load(batch) * model.hydraulic(particles, batch) / model.phases.water_unit_weight;
  const Real capacity = model.phases.water_density * model.phases.water_heat_capacity;
  return select(melted,
                particles.volume.load(batch) * capacity * mobility * pressure_gradient.dot(temperature_gradient),
                Lanes<Real>(Real(0)));
}

// What a batch adds to the records of HeatNodes::rates.
template <int Dim, class Real, class Law, class Stencil>
THAWSLIDE_ALWAYS_INLINE mpm::Contribution<Dim, Real, 4> heat_flows(const mpm::SparseGrid<Dim, Real>& grid,
                                                                   const BandModel<Dim, Real>& model, const Law& law,
                                                                   Real dt, bool subgrid, const Stencil& stencil,
                                                                   const mpm::Patch<Dim, Real, 3>& state,
                                                                   const mpm::Batch<Real>& batch,
                                                                   mpm::Particles<Dim, Real>& particles) {
  const auto seen = mpm::read_nodes<1>(stencil, state);
  const Vector<Lanes<Real>, Dim> gradient = gradient_of(seen, 0);
  const Lanes<Real> scaling = particles.thermal_scaling.load(batch);
  const Lanes<Real> tangent = law.tangent(batch);
  const Lanes<Real> capacity = particles.initial_volume.load(batch) / scaling * tangent;
  Lanes<Real> in_cell = Real(0);
  mpm::Contribution<Dim, Real, 4> carried;
  if (model.conduction) {
    const Lanes<Real> conductivity =
        physics::conductivity(model.phases, particles.porosity.load(batch), particles.liquid_saturation.load(batch));
    const Lanes<Real> flow = -particles.volume.load(batch) * scaling * conductivity;
    for (std::size_t a = 0; a < Dim; ++a) {
      carried.flux[a][0] = flow * gradient[static_cast<int>(a)];
    }
    if (subgrid) {
      in_cell = (seen.value[0] - particles.temperature.load(batch)) *
                physics::share_of_subgrid_diffusion(conductivity / tangent, grid.inverse_cell() * scaling, Dim, dt);
    }
  }
  particles.secant_capacity.store(batch, tangent);
  particles.conduction_in_cell.store(batch, in_cell);
  const auto melted = particles.temperature.load(batch) >= model.reference_temperature;
  if (model.advection && model.seepage && model.thermal_pressurization && any(melted)) {
    carried.value[1] = advected_heat(model, stencil, state, gradient, melted, batch, particles);
  }
  carried.value[2] = capacity;
  carried.value[3] = capacity * in_cell;
  return carried;
}

// What particles add to Eq. 19's sums, not yet summed: conduction and advection, and the capacity with the tangent to
// the heat content. Differences within a cell, which nodes do not see, fall by the particles' own subgrid diffusion,
// and the heat that this brings is taken off at the nodes (Gerya and Yuen 2003); `subgrid` is false in the step in
// which prescribed temperatures jump, since the nodes then are ahead of the particles, and for the printed update.
template <int Dim, class Real, class Law>
void flows_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, const Law& law, Real dt,
                   bool subgrid, mpm::Particles<Dim, Real>& particles, HeatNodes<Dim, Real>& work) {
  const auto patches = work.rates.patches(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    auto& patch = patches[t];
    patch.clear();
    mpm::Patch<Dim, Real, 3> state;
    load_patch(grid, t, work.state, state);
    auto sums = mpm::linear_cell_sums<true, 4>(patch);
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      const auto stencil = linear_stencil(grid, particles, batch);
      auto carried = heat_flows(grid, model, law, dt, subgrid, stencil, state, batch, particles);
      sums.add(stencil, batch.count, carried);
    }
  });
}

// The change of temperature [K] of a step, at the particles' places and within their cells.
template <int Dim, class Real>
THAWSLIDE_ALWAYS_INLINE Lanes<Real> change_of_temperature(const mpm::LinearStencil<Dim, Real>& stencil,
                                                          const mpm::Patch<Dim, Real, 3>& state, Real dt,
                                                          const mpm::Batch<Real>& batch,
                                                          const mpm::Particles<Dim, Real>& particles) {
  return particles.conduction_in_cell.load(batch) + dt * mpm::read_nodes<1>(stencil, state, 2).value[0];
}

// Whether some particle's temperature in a tile may change by more than is negligible.
template <int Dim, class Real, class Law>
bool temperatures_change(const std::vector<mpm::TileBatch<Dim, Real>>& batches, const Law& law, Real dt,
                         const mpm::Patch<Dim, Real, 3>& state, const mpm::Particles<Dim, Real>& particles) {
  const auto half_negligible = [&](auto change) { return law.content.is_negligible(Real(2) * change); };
  return !std::all_of(state.records.begin(), state.records.end(), [&](const auto& node) {
    return half_negligible(dt * node[2]);
  }) || std::any_of(batches.begin(), batches.end(), [&](const auto& batch) {
    return any(!half_negligible(particles.conduction_in_cell.load(batch)));
  });
}

// Secant capacity along the predicted change, to particles and, not yet summed, to nodes: with it the sum of what
// particles take equals what nodes give. Where no temperature changes it is the tangent, which particles and the
// patches of work.rates still hold.
template <int Dim, class Real, class Law>
void secant_capacity_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const Law& law, Real dt,
                             HeatNodes<Dim, Real>& work, mpm::Particles<Dim, Real>& particles) {
  const auto patches = work.rates.patches(grid.tiles().size());
  work.changing_tiles.resize(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    mpm::Patch<Dim, Real, 3> state;
    load_patch(grid, t, work.state, state);
    const bool changes = temperatures_change(grid.batches(t), law, dt, state, particles);
    work.changing_tiles[t] = changes ? 1 : 0;
    if (!changes) {
      return;
    }
    auto& patch = patches[t];
    patch.clear();
    auto sums = mpm::linear_cell_sums<false, 4>(patch);
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      const auto stencil = linear_stencil(grid, particles, batch);
      const Lanes<Real> change = change_of_temperature(stencil, state, dt, batch, particles);
      Lanes<Real> secant = particles.secant_capacity.load(batch);  // still the tangent
      const auto negligible = law.content.is_negligible(change);
      if (any(!negligible)) {
        secant = select(negligible, secant, law.secant(batch, change));
        particles.secant_capacity.store(batch, secant);
      }
      mpm::Contribution<Dim, Real, 4> carried;
      carried.value[2] = particles.initial_volume.load(batch) / particles.thermal_scaling.load(batch) * secant;
      carried.value[3] = carried.value[2] * particles.conduction_in_cell.load(batch);
      sums.add(stencil, batch.count, carried);
    }
  });
  grid.mark_blocks_about(work.changing_tiles, work.changing_blocks);
}

// What particles get of the heat of nodes without linear weight [W/kg], by the weight of their momentum there.
template <int Dim, class Real>
Lanes<Real> orphan_heating(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                           const mpm::Patch<Dim, Real, 1>& orphan, const mpm::Particles<Dim, Real>& particles,
                           const mpm::TileBatch<Dim, Real>& batch) {
  const auto size = model.sizes.of(particles, batch);
  Lanes<Real> specific = Real(0);
  mpm::with_shape<Real>(model.shape, [&](auto shape) {
    const auto place = place_of(grid, particles, batch);
    const auto stencil = mpm::make_stencil<decltype(shape)>(grid, batch, place, size, model.sides);
    specific = mpm::read_nodes<1>(stencil, orphan).value[0];
  });
  return specific;
}

// Adds up what `of_particles(batch)` [J/m3, per volume of t = 0] makes over all particles [J], with the volume heat
// counts.
template <int Dim, class Real, class OfParticles>
Real sum_of_heat(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                 const OfParticles& of_particles) {
  return parallel_sum<Real>(grid.tiles().size(), [&](std::size_t t, Real& sum) {
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      const Lanes<Real> volume = particles.initial_volume.load(batch) / particles.thermal_scaling.load(batch);
      batch.add_to(sum, volume * of_particles(batch));
    }
  });
}

// What the nodes give goes into the particles by take(batch, gain [J/m3]), which says whose temperature changed;
// saturation and porosity follow.
template <int Dim, class Real, class Law, class Take>
void heat_to_particles(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, const Law& law,
                       Real dt, HeatNodes<Dim, Real>& work, mpm::Particles<Dim, Real>& particles, const Take& take) {
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    mpm::Patch<Dim, Real, 3> state;
    mpm::Patch<Dim, Real, 1> orphan;
    load_patch(grid, t, work.state, state);
    bool any_orphan = false;
    if (work.any_orphan) {
      load_patch(grid, t, work.orphan, orphan);
      any_orphan = std::any_of(orphan.records.begin(), orphan.records.end(),
                               [](const auto& record) { return record[0] != Real(0); });
    }
    for (const mpm::TileBatch<Dim, Real>& batch : grid.batches(t)) {
      const auto stencil = linear_stencil(grid, particles, batch);
      Lanes<Real> gain =
          particles.secant_capacity.load(batch) * change_of_temperature(stencil, state, dt, batch, particles);
      if (any_orphan) {
        gain += dt * orphan_heating(grid, model, orphan, particles, batch) * particles.mass.load(batch) *
                particles.thermal_scaling.load(batch) / particles.initial_volume.load(batch);
      }
      const Lanes<Real> old_temperature = particles.temperature.load(batch);
      particles.previous_temperature.store(batch, old_temperature);
      const auto changed = take(batch, gain);
      if (any(changed)) {
        const Lanes<Real> temperature = particles.temperature.load(batch);
        const Lanes<Real> porosity = particles.porosity.load(batch);
        const Lanes<Real> saturation = law.content.curve.saturation(temperature);
        particles.liquid_saturation.store(batch, select(changed, saturation, particles.liquid_saturation.load(batch)));
        const Lanes<Real> updated =
            physics::updated_porosity(model.phases, porosity, Lanes<Real>(Real(0)), temperature - old_temperature);
        particles.porosity.store(batch, select(changed, updated, porosity));
      }
    }
  });
}

// Heat made by masses that follow porosity and volume: temperatures stay, the heat the particles hold does not.
template <int Dim, class Real, class Law>
Real count_masses_anew(const mpm::SparseGrid<Dim, Real>& grid, const Law& law, mpm::Particles<Dim, Real>& particles) {
  return sum_of_heat(grid, particles, [&](const mpm::Batch<Real>& batch) {
    const Lanes<Real> before = particles.heat_content.load(batch);
    const Lanes<Real> anew = law.heat(batch);
    particles.heat_content.store(batch, anew);
    return anew - before;
  });
}

// Eq. 18 for the heat content: the gain goes into the particle's account, and its temperature follows.
template <int Dim, class Real, class Law, class SumRates>
HeatGain<Real> update_heat_content(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                                   const Law& law, Real dt, bool first_step, const mpm::Nodes<Dim, Real>& nodes,
                                   const SumRates& sum_rates, HeatNodes<Dim, Real>& work,
                                   mpm::Particles<Dim, Real>& particles) {
  const auto with_tangent = [&](std::size_t b, std::size_t k) {
    return std::pair(work.rates(b, k)[2], work.rates(b, k)[3]);
  };
  const auto with_secant = [&](std::size_t b, std::size_t k) {
    const auto& stored = work.changing_blocks[b] != 0 ? work.capacity(b, k) : work.rates(b, k);
    return std::pair(stored[2], stored[3]);
  };
  const auto sum_secant = [&](std::size_t b) {
    if (work.changing_blocks[b] != 0) {
      sum_patches_in_block(grid, b, work.rates.patches(grid.tiles().size()), work.capacity);
    }
  };
  solve_rates(grid, model, dt, first_step, nodes, sum_rates, with_tangent, work);
  secant_capacity_to_grid(grid, law, dt, work, particles);
  work.capacity.resize(grid.blocks().size());
  const HeatGain<Real> gain = solve_rates(grid, model, dt, first_step, nodes, sum_secant, with_secant, work);
  heat_to_particles(grid, model, law, dt, work, particles, [&](const mpm::Batch<Real>& batch, Lanes<Real> taken) {
    const Lanes<Real> before = particles.heat_content.load(batch);
    const Lanes<Real> heat_content = before + taken;
    const auto changed = heat_content != before;
    if (any(changed)) {
      particles.heat_content.store(batch, heat_content);
      const Lanes<Real> temperature = particles.temperature.load(batch);
      const Lanes<Real> guess = temperature + taken / particles.secant_capacity.load(batch);
      particles.temperature.store(batch, select(changed, law.temperature(batch, heat_content, guess), temperature));
    }
    return changed;
  });
  return gain;
}

// Eqs. 18 and 19 as printed: the old apparent capacity turns heat into a change of temperature. The heat a particle
// then holds is not what it was given; the difference is counted.
template <int Dim, class Real, class Law, class SumRates>
HeatGain<Real> update_temperature(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                                  const Law& law, Real dt, bool first_step, const mpm::Nodes<Dim, Real>& nodes,
                                  const SumRates& sum_rates, HeatNodes<Dim, Real>& work,
                                  mpm::Particles<Dim, Real>& particles) {
  const auto with_tangent = [&](std::size_t b, std::size_t k) { return std::pair(work.rates(b, k)[2], Real(0)); };
  HeatGain<Real> gain = solve_rates(grid, model, dt, first_step, nodes, sum_rates, with_tangent, work);
  heat_to_particles(grid, model, law, dt, work, particles, [&](const mpm::Batch<Real>& batch, Lanes<Real> taken) {
    // The secant capacity still is the tangent.
    particles.temperature.store(batch,
                                particles.temperature.load(batch) + taken / particles.secant_capacity.load(batch));
    return taken != Real(0);
  });
  gain.capacity = sum_of_heat(grid, particles, [&](const mpm::Batch<Real>& batch) {
    const Lanes<Real> change = particles.temperature.load(batch) - particles.previous_temperature.load(batch);
    const Lanes<Real> taken = particles.secant_capacity.load(batch) * change;
    const Lanes<Real> before = particles.heat_content.load(batch);
    const Lanes<Real> after = law.heat(batch);
    particles.heat_content.store(batch, after);
    return after - before - taken;
  });
  return gain;
}

}  // namespace

template <int Dim, class Real>
HeatGain<Real> conduct_heat(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, Real dt,
                            bool first_step, const mpm::Nodes<Dim, Real>& nodes, HeatNodes<Dim, Real>& work,
                            mpm::Particles<Dim, Real>& particles) {
  return with_particle_heat(model, particles, [&](const auto& law) {
    const Real from_porosity = model.current_masses ? count_masses_anew(grid, law, particles) : Real(0);
    flows_to_grid(grid, model, law, dt, model.secant_capacity && !first_step, particles, work);
    work.rates.resize(grid.blocks().size());
    const auto sum_rates = [&](std::size_t b) {
      sum_patches_in_block(grid, b, work.rates.patches(grid.tiles().size()), work.rates);
    };
    HeatGain<Real> gain = model.secant_capacity
                              ? update_heat_content(grid, model, law, dt, first_step, nodes, sum_rates, work, particles)
                              : update_temperature(grid, model, law, dt, first_step, nodes, sum_rates, work, particles);
    gain.porosity = from_porosity;
    return gain;
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                           \
  template HeatGain<Real> conduct_heat<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const BandModel<Dim, Real>&,  \
                                                  Real, bool, const mpm::Nodes<Dim, Real>&, HeatNodes<Dim, Real>&, \
                                                  mpm::Particles<Dim, Real>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
