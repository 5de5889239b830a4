#include "band/pore_pressure.hpp"

#include <algorithm>

#include "band/pore_pressure_of_tile.hpp"
#include "band/seeping_tiles.hpp"
#include "base/instances.hpp"
#include "mpm/node_pass.hpp"
#include "mpm/particle_pass.hpp"

namespace thawslide::band {

namespace {

// What frozen pores take of the seepage at a node [Pa m3]: the nodes' change of pressure times their pore space.
template <class Real, class Sums>
Real taken_by_frozen(const Sums& sums, Real change) {
  return (sums[mpm::Seepage::pore_space] - sums[mpm::Seepage::seeping]) * change;
}

// The pressure that seepage brings to nodes in a step (Eq. 22); returns the mass of water lost to frozen pores [kg].
template <int Dim, class Real>
Real seep(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, Real dt,
          mpm::Particles<Dim, Real>& particles, mpm::Nodes<Dim, Real>& nodes) {
  const auto& blocks = nodes.marks.seeping_blocks;
  mpm::particle_pass(
      grid, mpm::LinearWeights{}, particles, nodes, [&](std::size_t t) { return grid.any_about_tile(t, blocks); },
      SeepageFlows<Dim, Real>{model, model.hydraulic(), dt, grid.inverse_cell()});
  nodes.seepage.hold(grid.blocks().size(), [&](std::size_t b) { return blocks[b] != 0; });
  const Real taken = mpm::node_pass<Real>(
      grid,
      [&](std::size_t b) {
        if (blocks[b] != 0) {
          mpm::sum_block<mpm::Seepage>(grid, b, nodes);
        }
      },
      [&](const mpm::NodeAt& at, Real& sum) {
        const auto& sums = nodes.seepage(at);
        Real& change = nodes.state(at)[mpm::NodalState::pressure_change];
        change = sums[mpm::Seepage::pore_space] > Real(0)
                     ? (dt * sums[mpm::Seepage::inflow] - sums[mpm::Seepage::subgrid]) / sums[mpm::Seepage::pore_space]
                     : Real(0);
        sum += taken_by_frozen(sums, change);
      });
  return model.phases.water_density / model.phases.water_bulk_modulus * taken;
}

}  // namespace

template <int Dim, class Real>
WaterLoss<Real> drain_pore_pressure(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                                    const FlowDepth<Dim, Real>& depth, Real dt, mpm::Nodes<Dim, Real>& nodes,
                                    mpm::Particles<Dim, Real>& particles) {
  const auto update = [&](auto seeps) {
    const auto pass = [&](const auto& kernel) {
      return std::get<0>(mpm::particle_pass(grid, mpm::LinearWeights{}, particles, nodes, mpm::every_tile, kernel));
    };
    return model.balances_water() ? pass(UpdatePorePressure<Dim, Real, seeps(), true>{grid, model, depth})
                                  : pass(UpdatePorePressure<Dim, Real, seeps(), false>{grid, model, depth});
  };
  const auto seeps = [&](const mpm::Batch<Real>& batch) {
    const auto melted = melted_before(model, particles, batch);
    return any(melted) && any(melted & (model.hydraulic()(particles, batch) > Real(0)));
  };
  WaterLoss<Real> loss;
  if (model.seepage && model.thermal_pressurization && find_seepage(grid, nodes.marks, seeps)) {
    loss.vented = seep(grid, model, dt, particles, nodes);
    loss.drained = update(std::true_type{});
  } else {
    loss.drained = update(std::false_type{});
  }
  return loss;
}

template <int Dim, class Real>
void set_pore_pressure(const BandModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles, std::size_t first) {
  for (std::size_t p = first; p < particles.size(); ++p) {
    if (!model.pressure) {
      particles.pore_pressure(p) = Real(0);
      continue;
    }
    particles.ice_pressure(p) = physics::ice_pressure(model.phases, model.gravity, particles.flow_depth(p));
    if (model.balances_water()) {
      particles.pore_void(p) = void_at_start(model, particles, p);
    }
    if (particles.temperature(p) < model.reference_temperature) {
      const auto frozen = model.ice_presses ? frozen_pressures(model, particles.ice_pressure(p),
                                                               particles.temperature(p), particles.liquid_saturation(p))
                                            : Pressures<Real>{};
      particles.liquid_pressure(p) = frozen.liquid;
      particles.pore_pressure(p) = frozen.pore;
    } else {
      particles.liquid_pressure(p) =
          thawing_pressure(model, particles, mpm::One<Real>{{static_cast<std::uint32_t>(p)}});
      particles.pore_pressure(p) = particles.liquid_pressure(p);
    }
  }
}

template <int Dim, class Real>
void mix_water(const BandModel<Dim, Real>& model, Real kept, Real before, Real joining, std::uint32_t p,
               mpm::Particles<Dim, Real>& particles) {
  const Real tref = model.reference_temperature, porosity = particles.porosity(p);
  const Real to = std::max(particles.temperature(p), tref);
  const bool was_melted = before >= tref, is_melted = particles.temperature(p) >= tref;
  const Real start = thawing_pressure(model, particles, mpm::One<Real>{{p}});
  const Real pressure = was_melted ? particles.liquid_pressure(p) : start;
  Real mixed = start;
  if (model.balances_water()) {
    const Real storage = physics::pore_storage(model.phases, porosity, model.skeleton_compressibility);
    const auto surplus = [&](Real held, Real gas_void, Real from) {
      return physics::pore_surplus<Real>({held, gas_void, Real(0)}, storage) +
             physics::melted_swelling(model.phases, model.water, porosity, std::max(from, tref), to);
    };
    const Real own = surplus(pressure, particles.pore_void(p), before);
    const Real own_void = was_melted ? std::max(-own, Real(0)) : particles.pore_void(p);
    const Real new_void = void_at_start(model, particles, p);
    const auto filling = physics::pore_filling(physics::mixed(own, surplus(start, new_void, joining), kept), storage);
    particles.pore_void(p) = is_melted ? filling.gas_void : physics::mixed(own_void, new_void, kept);
    mixed = model.thermal_pressurization ? filling.pressure : start;
  } else if (model.thermal_pressurization) {
    const Real coefficient = physics::undrained_pressure_coefficient(model.phases, porosity, Real(1));
    mixed = physics::mixed(pressure + coefficient * (to - std::max(before, tref)),
                           start + coefficient * (to - std::max(joining, tref)), kept);
  }
  if (is_melted) {
    particles.liquid_pressure(p) = particles.pore_pressure(p) = mixed;
  }
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                             \
  template WaterLoss<Real> drain_pore_pressure<Dim, Real>(const mpm::SparseGrid<Dim, Real>&,                         \
                                                          const BandModel<Dim, Real>&, const FlowDepth<Dim, Real>&,  \
                                                          Real, mpm::Nodes<Dim, Real>&, mpm::Particles<Dim, Real>&); \
  template void mix_water<Dim, Real>(const BandModel<Dim, Real>&, Real, Real, Real, std::uint32_t,                   \
                                     mpm::Particles<Dim, Real>&);                                                    \
  template void set_pore_pressure<Dim, Real>(const BandModel<Dim, Real>&, mpm::Particles<Dim, Real>&, std::size_t);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
