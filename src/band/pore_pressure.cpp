#include "band/pore_pressure.hpp"

#include <algorithm>

#include "band/pore_pressure_of_tile.hpp"
#include "base/instances.hpp"
#include "mpm/node_pass.hpp"
#include "mpm/particle_pass.hpp"

namespace thawslide::band {

namespace {

// Marks the tiles and blocks where water may seep; false if there are none.
template <int Dim, class Real>
bool find_seepage(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                  const mpm::Particles<Dim, Real>& particles, mpm::ActivityMarks& marks) {
  marks.seeping_tiles.resize(grid.tiles().size());
  parallel_for(grid.tiles().size(), [&](std::size_t t) {
    const auto& batches = grid.batches(t);
    const auto seeps = [&](const mpm::Batch<Real>& batch) {
      const auto melted = melted_before(model, particles, batch);
      return any(melted) && any(melted & (model.hydraulic()(particles, batch) > Real(0)));
    };
    marks.seeping_tiles[t] = std::any_of(batches.begin(), batches.end(), seeps) ? 1 : 0;
  });
  grid.mark_blocks_about(marks.seeping_tiles, marks.seeping_blocks);
  return std::any_of(marks.seeping_tiles.begin(), marks.seeping_tiles.end(),
                     [](std::uint8_t seeps) { return seeps != 0; });
}

// The pressure that seepage brings to nodes in a step (Eq. 22).
template <int Dim, class Real>
void seep(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model, Real dt,
          mpm::Particles<Dim, Real>& particles, mpm::Nodes<Dim, Real>& nodes) {
  const auto& blocks = nodes.marks.seeping_blocks;
  mpm::particle_pass(
      grid, mpm::LinearWeights{}, particles, nodes, [&](std::size_t t) { return grid.any_about_tile(t, blocks); },
      SeepageFlows<Dim, Real>{model, model.hydraulic(), dt, grid.inverse_cell()});
  nodes.seepage.hold(grid.blocks().size(), [&](std::size_t b) { return blocks[b] != 0; });
  mpm::node_pass<mpm::NoAccount>(
      grid,
      [&](std::size_t b) {
        if (blocks[b] != 0) {
          mpm::sum_block<mpm::Seepage>(grid, b, nodes);
        }
      },
      [&](const mpm::NodeAt& at, mpm::NoAccount& /*account*/) {
        const auto& sums = nodes.seepage(at);
        Real& change = nodes.state(at)[mpm::NodalState::pressure_change];
        change = sums[mpm::Seepage::pore_space] > Real(0)
                     ? (dt * sums[mpm::Seepage::inflow] - sums[mpm::Seepage::subgrid]) / sums[mpm::Seepage::pore_space]
                     : Real(0);
      });
}

}  // namespace

template <int Dim, class Real>
void drain_pore_pressure(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                         const FlowDepth<Dim, Real>& depth, Real dt, mpm::Nodes<Dim, Real>& nodes,
                         mpm::Particles<Dim, Real>& particles) {
  const auto update = [&](auto kernel) {
    mpm::particle_pass(grid, mpm::LinearWeights{}, particles, nodes, mpm::every_tile, kernel);
  };
  if (model.seepage && model.thermal_pressurization && find_seepage(grid, model, particles, nodes.marks)) {
    seep(grid, model, dt, particles, nodes);
    update(UpdatePorePressure<Dim, Real, true>{grid, model, depth});
  } else {
    update(UpdatePorePressure<Dim, Real, false>{grid, model, depth});
  }
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

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                       \
  template void drain_pore_pressure<Dim, Real>(const mpm::SparseGrid<Dim, Real>&, const BandModel<Dim, Real>&, \
                                               const FlowDepth<Dim, Real>&, Real, mpm::Nodes<Dim, Real>&,      \
                                               mpm::Particles<Dim, Real>&);                                    \
  template void set_pore_pressure<Dim, Real>(const BandModel<Dim, Real>&, mpm::Particles<Dim, Real>&, std::size_t);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
