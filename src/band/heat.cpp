#include "band/heat.hpp"

#include <cmath>

#include "band/particle_heat.hpp"
#include "physics/pressurization.hpp"

namespace thawslide::band {

namespace {

using mpm::ContactLayout;
using mpm::HatLayout;
using mpm::MomentumLayout;

// The face of the domain a node lies on, if that face has a condition for heat; null otherwise.
template <int Dim, class Real>
const HeatFace<Real>* face_of(const BandModel<Dim, Real>& model, const Vector<Real, Dim>& position) {
  constexpr Real round_off = static_cast<Real>(1e-9);
  for (int a = 0; a < Dim; ++a) {
    const HeatFace<Real>& lower = model.faces[2 * a];
    const HeatFace<Real>& upper = model.faces[2 * a + 1];
    if (lower.kind != FaceHeat::insulated && position[a] <= round_off * model.extent[a]) {
      return &lower;
    }
    if (upper.kind != FaceHeat::insulated && position[a] >= model.extent[a] * (Real(1) - round_off)) {
      return &upper;
    }
  }
  return nullptr;
}

// Nodal temperature and pore pressure; a prescribed temperature takes its node before gradients are formed.
template <int Dim, class Real>
void set_node_state(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                    const mpm::Nodes<Dim, Real>& nodes, HeatNodes<Dim, Real>& work) {
  work.state.resize(grid.blocks().size());
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      const auto& hats = nodes.hats(b, k);
      auto& state = work.state(b, k);
      state.fill(Real(0));
      if (hats[HatLayout::volume] > Real(0)) {
        state[0] = hats[HatLayout::temperature] / hats[HatLayout::volume];
        state[1] = hats[HatLayout::pore_pressure] / hats[HatLayout::volume];
        const HeatFace<Real>* face = face_of(model, mpm::node_position(grid, b, k));
        if (face != nullptr && face->kind == FaceHeat::temperature) {
          state[0] = face->value;
        }
      }
    }
  });
}

// Eq. 19's sums over particles: conduction and advection, and the capacity with the tangent to the heat content.
// Differences within a cell, which nodes do not see, are levelled by the particles themselves, and the heat that this
// brings is taken off at the nodes (Gerya and Yuen 2003); `levels` is false in the step in which prescribed
// temperatures jump, since the nodes then are ahead of the particles, and for the printed update.
template <int Dim, class Real, class Law>
void flows_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, const Law& law, Real dt,
                   bool levels, mpm::Particles<Dim, Real>& particles, HeatNodes<Dim, Real>& work) {
  auto& patches = work.rates.patches(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    auto& patch = patches[t];
    patch.clear();
    mpm::Patch<Dim, Real, 3> state;
    load_patch(grid, t, work.state, state);
    const auto& tile = grid.tiles()[t];
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      const auto stencil = mpm::hat_stencil(grid, tile.key, particles, p);
      Vector<Real, Dim> temperature_gradient = Vector<Real, Dim>::Zero();
      Vector<Real, Dim> pressure_gradient = Vector<Real, Dim>::Zero();
      Real seen = 0;
      stencil.for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& slope) {
        seen += state.records[place][0] * weight;
        temperature_gradient += state.records[place][0] * slope;
        pressure_gradient += state.records[place][1] * slope;
      });
      const Real scaling = particles.thermal_scaling(p);
      const Real volume = particles.volume(p);
      const Real tangent = law.tangent(p);
      particles.secant_capacity(p) = tangent;
      particles.conduction_in_cell(p) = Real(0);
      Vector<Real, Dim> flow = Vector<Real, Dim>::Zero();
      if (model.conduction) {
        const Real conductivity =
            physics::conductivity(model.phases, particles.porosity(p), particles.liquid_saturation(p));
        flow = -volume * scaling * conductivity * temperature_gradient;
        if (levels) {
          particles.conduction_in_cell(p) =
              (seen - particles.temperature(p)) *
              physics::share_levelled_within_cell(conductivity / tangent, grid.cell() / scaling, Dim, dt);
        }
      }
      Real advection = 0;
      const Real hydraulic = model.hydraulic_conductivity[static_cast<std::size_t>(particles.material(p))];
      if (model.advection && model.seepage && model.thermal_pressurization && hydraulic > Real(0) &&
          particles.temperature(p) >= model.reference_temperature) {
        const Real mobility = scaling * hydraulic / model.phases.water_unit_weight;
        advection = volume * model.phases.water_density * model.phases.water_heat_capacity * mobility *
                    pressure_gradient.dot(temperature_gradient);
      }
      const Real capacity = particles.initial_volume(p) / scaling * tangent;
      stencil.for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& slope) {
        auto& node = patch.records[place];
        node[0] += flow.dot(slope);
        node[1] += weight * advection;
        node[2] += weight * capacity;
        node[3] += weight * capacity * particles.conduction_in_cell(p);
      });
    }
  });
  sum_patches(grid, work.rates);
}

// The nodal rate of temperature with what `stored_at` gives: the capacity, and the heat that particles took by
// levelling within cells; friction heat and face conditions come in here.
template <int Dim, class Real, class StoredAt>
HeatGain<Real> solve_rates(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, Real dt,
                           bool first_step, const mpm::Nodes<Dim, Real>& nodes, const StoredAt& stored_at,
                           HeatNodes<Dim, Real>& work) {
  std::vector<HeatGain<Real>> gains(grid.blocks().size());
  std::vector<std::uint8_t> orphans(grid.blocks().size(), 0);
  work.orphan.resize(grid.blocks().size());
  parallel_for(grid.blocks().size(), [&](std::size_t b) {
    HeatGain<Real>& gain = gains[b];
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      const auto& rates = work.rates(b, k);
      const Real friction = nodes.contact(b, k)[ContactLayout::friction_heat];
      const auto [capacity, levelled] = stored_at(b, k);
      Real& rate = work.state(b, k)[2];
      rate = Real(0);
      work.orphan(b, k)[0] = Real(0);
      gain.friction += dt * friction;
      if (!(capacity > Real(0))) {
        if (friction > Real(0)) {
          work.orphan(b, k)[0] = friction / nodes.momentum(b, k)[MomentumLayout<Dim>::mass];
          orphans[b] = 1;
        }
        continue;
      }
      Real power = rates[0] + rates[1] + friction - levelled / dt;
      gain.advection += dt * rates[1];
      const HeatFace<Real>* face = face_of(model, mpm::node_position(grid, b, k));
      if (face != nullptr && face->kind == FaceHeat::temperature) {
        const auto& hats = nodes.hats(b, k);
        const Real mapped = hats[HatLayout::temperature] / hats[HatLayout::volume];
        rate = first_step ? (face->value - mapped) / dt : Real(0);
        gain.boundary += dt * (capacity * rate - power);
        continue;
      }
      if (face != nullptr && face->kind == FaceHeat::flux) {
        // A full row of cells gives its face node half a cell of volume: area = 2 V / cell.
        const Real inflow = face->value * Real(2) * nodes.hats(b, k)[HatLayout::volume] / grid.cell();
        gain.boundary += dt * inflow;
        power += inflow;
      }
      rate = power / capacity;
    }
  });
  HeatGain<Real> sum;
  work.any_orphan = false;
  for (std::size_t b = 0; b < gains.size(); ++b) {
    sum.friction += gains[b].friction;
    sum.boundary += gains[b].boundary;
    sum.advection += gains[b].advection;
    work.any_orphan = work.any_orphan || orphans[b] != 0;
  }
  return sum;
}

template <int Dim, class Real>
Real interpolated_rate(const mpm::Stencil<Dim, Real, 2>& stencil, const mpm::Patch<Dim, Real, 3>& state) {
  Real rate = 0;
  stencil.for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& /*slope*/) {
    rate += weight * state.records[place][2];
  });
  return rate;
}

// Secant capacity along the predicted change, to particles and nodes: with it the sum of what particles take equals
// what nodes give.
template <int Dim, class Real, class Law>
void secant_capacity_to_grid(const mpm::SparseGrid<Dim, Real>& grid, const Law& law, Real dt,
                             HeatNodes<Dim, Real>& work, mpm::Particles<Dim, Real>& particles) {
  auto& patches = work.capacity.patches(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    auto& patch = patches[t];
    patch.clear();
    mpm::Patch<Dim, Real, 3> state;
    load_patch(grid, t, work.state, state);
    const auto& tile = grid.tiles()[t];
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      const auto stencil = mpm::hat_stencil(grid, tile.key, particles, p);
      const Real change = particles.conduction_in_cell(p) + dt * interpolated_rate(stencil, state);
      if (!law.content.drowns_in_round_off(change)) {  // else the tangent, which stands there already, is the secant
        particles.secant_capacity(p) = law.secant(p, change);
      }
      const Real capacity = particles.initial_volume(p) / particles.thermal_scaling(p) * particles.secant_capacity(p);
      stencil.for_each_node([&](std::size_t place, Real weight, const Vector<Real, Dim>& /*slope*/) {
        patch.records[place][0] += weight * capacity;
        patch.records[place][1] += weight * capacity * particles.conduction_in_cell(p);
      });
    }
  });
  sum_patches(grid, work.capacity);
}

// What a particle gets of the heat of nodes without hat weight [W/kg], by the weight of its momentum there.
template <int Dim, class Real>
Real orphan_heating(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, std::uint64_t tile,
                    const mpm::Patch<Dim, Real, 1>& orphan, const mpm::Particles<Dim, Real>& particles,
                    std::uint32_t p) {
  Real specific = 0;
  mpm::with_shape<Real>(model.shape, [&](auto shape) {
    const auto place = mpm::place_of(grid, particles.position.template get<Vector<Real, Dim>>(p));
    const Real half = model.half_size[static_cast<std::size_t>(particles.body(p))];
    const auto stencil = mpm::make_stencil<decltype(shape)>(grid, tile, place, half, model.sides);
    stencil.for_each_node([&](std::size_t node, Real weight, const Vector<Real, Dim>& /*slope*/) {
      specific += weight * orphan.records[node][0];
    });
  });
  return specific;
}

// Adds up what `of_particle(p)` [J/m3, per volume of t = 0] makes over all particles [J], with the volume heat counts.
template <int Dim, class Real, class OfParticle>
Real sum_of_heat(const mpm::SparseGrid<Dim, Real>& grid, const mpm::Particles<Dim, Real>& particles,
                 const OfParticle& of_particle) {
  std::vector<Real> sums(grid.tiles().size(), Real(0));
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    const auto& tile = grid.tiles()[t];
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      sums[t] += particles.initial_volume(p) / particles.thermal_scaling(p) * of_particle(p);
    }
  });
  Real sum = 0;
  for (const Real part : sums) {
    sum += part;
  }
  return sum;
}

// What the nodes give goes into each particle by take(p, gain [J/m3]); its saturation and porosity follow.
template <int Dim, class Real, class Law, class Take>
void heat_to_particles(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, const Law& law,
                       Real dt, HeatNodes<Dim, Real>& work, mpm::Particles<Dim, Real>& particles, const Take& take) {
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    mpm::Patch<Dim, Real, 3> state;
    mpm::Patch<Dim, Real, 1> orphan;
    load_patch(grid, t, work.state, state);
    if (work.any_orphan) {
      load_patch(grid, t, work.orphan, orphan);
    }
    const auto& tile = grid.tiles()[t];
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t p = grid.order()[k];
      const auto stencil = mpm::hat_stencil(grid, tile.key, particles, p);
      Real gain =
          particles.secant_capacity(p) * (particles.conduction_in_cell(p) + dt * interpolated_rate(stencil, state));
      if (work.any_orphan) {
        gain += dt * orphan_heating(grid, model, tile.key, orphan, particles, p) * particles.mass(p) *
                particles.thermal_scaling(p) / particles.initial_volume(p);
      }
      const Real old_temperature = particles.temperature(p);
      particles.previous_temperature(p) = old_temperature;
      if (take(p, gain)) {
        particles.liquid_saturation(p) = law.content.curve.saturation(particles.temperature(p));
        particles.porosity(p) = physics::updated_porosity(model.phases, particles.porosity(p), Real(0),
                                                          particles.temperature(p) - old_temperature);
      }
    }
  });
}

// Heat made by masses that follow porosity and volume: temperatures stay, the heat the particles hold does not.
template <int Dim, class Real, class Law>
Real count_masses_anew(const mpm::SparseGrid<Dim, Real>& grid, const Law& law, mpm::Particles<Dim, Real>& particles) {
  return sum_of_heat(grid, particles, [&](std::uint32_t p) {
    const Real before = particles.heat_content(p);
    particles.heat_content(p) = law.heat(p);
    return particles.heat_content(p) - before;
  });
}

// Eq. 18 for the heat content: the gain goes into the particle's account, and its temperature follows.
template <int Dim, class Real, class Law>
HeatGain<Real> update_heat_content(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                                   const Law& law, Real dt, bool first_step, const mpm::Nodes<Dim, Real>& nodes,
                                   HeatNodes<Dim, Real>& work, mpm::Particles<Dim, Real>& particles) {
  const auto with_tangent = [&](std::size_t b, std::size_t k) {
    return std::pair(work.rates(b, k)[2], work.rates(b, k)[3]);
  };
  const auto with_secant = [&](std::size_t b, std::size_t k) {
    return std::pair(work.capacity(b, k)[0], work.capacity(b, k)[1]);
  };
  solve_rates(grid, model, dt, first_step, nodes, with_tangent, work);
  secant_capacity_to_grid(grid, law, dt, work, particles);
  const HeatGain<Real> gain = solve_rates(grid, model, dt, first_step, nodes, with_secant, work);
  heat_to_particles(grid, model, law, dt, work, particles, [&](std::uint32_t p, Real taken) {
    const Real heat_content = particles.heat_content(p) + taken;
    if (heat_content == particles.heat_content(p)) {
      return false;
    }
    particles.heat_content(p) = heat_content;
    const Real guess = particles.temperature(p) + taken / particles.secant_capacity(p);
    particles.temperature(p) = law.temperature(p, heat_content, guess);
    return true;
  });
  return gain;
}

// Eqs. 18 and 19 as printed: the old apparent capacity turns heat into a change of temperature. The heat a particle
// then holds is not what it was given; the difference is counted.
template <int Dim, class Real, class Law>
HeatGain<Real> update_temperature(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                                  const Law& law, Real dt, bool first_step, const mpm::Nodes<Dim, Real>& nodes,
                                  HeatNodes<Dim, Real>& work, mpm::Particles<Dim, Real>& particles) {
  const auto with_tangent = [&](std::size_t b, std::size_t k) { return std::pair(work.rates(b, k)[2], Real(0)); };
  HeatGain<Real> gain = solve_rates(grid, model, dt, first_step, nodes, with_tangent, work);
  heat_to_particles(grid, model, law, dt, work, particles, [&](std::uint32_t p, Real taken) {
    particles.temperature(p) += taken / particles.secant_capacity(p);  // which still is the tangent
    return taken != Real(0);
  });
  gain.capacity = sum_of_heat(grid, particles, [&](std::uint32_t p) {
    const Real taken = particles.secant_capacity(p) * (particles.temperature(p) - particles.previous_temperature(p));
    const Real before = particles.heat_content(p);
    particles.heat_content(p) = law.heat(p);
    return particles.heat_content(p) - before - taken;
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
    set_node_state(grid, model, nodes, work);
    flows_to_grid(grid, model, law, dt, model.secant_capacity && !first_step, particles, work);
    HeatGain<Real> gain = model.secant_capacity
                              ? update_heat_content(grid, model, law, dt, first_step, nodes, work, particles)
                              : update_temperature(grid, model, law, dt, first_step, nodes, work, particles);
    gain.porosity = from_porosity;
    return gain;
  });
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                           \
  template HeatGain<Real> conduct_heat<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const BandModel<Dim, Real>&,  \
                                                  Real, bool, const mpm::Nodes<Dim, Real>&, HeatNodes<Dim, Real>&, \
                                                  mpm::Particles<Dim, Real>&);
THAWSLIDE_INSTANTIATE(2, double)
THAWSLIDE_INSTANTIATE(3, double)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
