#include "band/pore_pressure.hpp"

#include "band/nodal_seepage.hpp"
#include "band/seeping_tiles.hpp"
#include "base/instances.hpp"
#include "mpm/node_pass.hpp"
#include "mpm/particle_pass.hpp"

namespace thawslide::band {

namespace {

// Nodal pressure change by seepage in a step (Eq. 22). Returns the mass of water lost to frozen pores [kg].
template <int Dim>
double seep(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model, double dt, mpm::Particles<Dim>& particles,
            mpm::Nodes<Dim>& nodes) {
  const auto& blocks = nodes.marks.seeping_blocks;
  mpm::particle_pass(
      grid, mpm::LinearWeights{}, particles, nodes, [&](std::size_t t) { return grid.any_about_tile(t, blocks); },
      SeepageFlows<Dim>{model, model.hydraulic(), dt, grid.inverse_cell()});
  nodes.seepage.allocate(grid.blocks().size(), [&](std::size_t b) { return blocks[b] != 0; });
  const double absorbed = mpm::node_pass<double>(
      grid, [&](std::size_t b) { return blocks[b] != 0 ? mpm::sum_block<mpm::Seepage>(grid, b, nodes) : 0; },
      [&](const mpm::NodeAt& at, double& sum) {
        const auto& sums = nodes.seepage(at);
        double& change = nodes.state(at)[mpm::NodalState::pressure_change];
        change = pressure_change(sums, dt);
        sum += absorbed_by_frozen(sums, change);
      });
  return mass_of_absorbed(model.phases, absorbed);
}

}  // namespace

template <int Dim>
WaterLoss drain_pore_pressure(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model,
                              const FlowDepth<Dim>& depth, double dt, mpm::Nodes<Dim>& nodes,
                              mpm::Particles<Dim>& particles) {
  const auto update = [&](auto seeps) {
    const auto pass = [&](const auto& kernel) {
      return std::get<0>(mpm::particle_pass(grid, mpm::LinearWeights{}, particles, nodes, mpm::every_tile, kernel));
    };
    using Columns = typename FlowDepth<Dim>::Columns;
    return model.balances_water()
               ? pass(UpdatePorePressure<Columns, seeps(), true>{model, model.hydraulic(), depth.by_tile()})
               : pass(UpdatePorePressure<Columns, seeps(), false>{model, model.hydraulic(), depth.by_tile()});
  };
  const auto seeps = [&](const mpm::SimdBatch& batch) {
    return any_seeped(model, model.hydraulic(), particles, batch);
  };
  WaterLoss loss;
  if (model.seepage && model.thermal_pressurization && find_seepage(grid, nodes.marks, seeps)) {
    loss.vented = seep(grid, model, dt, particles, nodes);
    loss.drained = update(std::true_type{});
  } else {
    loss.drained = update(std::false_type{});
  }
  return loss;
}

template <int Dim>
void set_pore_pressure(const BandModel<Dim>& model, mpm::Particles<Dim>& particles, std::size_t first) {
  for (std::size_t p = first; p < particles.size(); ++p) {
    if (!model.pressure) {
      particles.pore_pressure(p) = 0.0;
      continue;
    }
    particles.ice_pressure(p) = physics::ice_pressure(model.phases, model.gravity, particles.flow_depth(p));
    if (model.balances_water()) {
      particles.pore_void(p) = void_at_start(model, particles, p);
    }
    if (particles.temperature(p) < model.reference_temperature) {
      const auto frozen = model.ice_presses ? frozen_pressures(model, particles.ice_pressure(p),
                                                               particles.temperature(p), particles.liquid_saturation(p))
                                            : Pressures<double>{};
      particles.liquid_pressure(p) = frozen.liquid;
      particles.pore_pressure(p) = frozen.pore;
    } else {
      particles.liquid_pressure(p) =
          thawing_pressure(model, particles, mpm::ScalarIndex{{static_cast<std::uint32_t>(p)}});
      particles.pore_pressure(p) = particles.liquid_pressure(p);
    }
  }
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                    \
  template WaterLoss drain_pore_pressure<Dim>(const mpm::SparseGrid<Dim>&, const BandModel<Dim>&,                     \
                                              const FlowDepth<Dim>&, double, mpm::Nodes<Dim>&, mpm::Particles<Dim>&); \
  template void set_pore_pressure<Dim>(const BandModel<Dim>&, mpm::Particles<Dim>&, std::size_t);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
