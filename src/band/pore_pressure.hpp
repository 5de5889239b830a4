// Pore pressure (Eqs. 4, 8, 21-23): Clapeyron while ice and water coexist, then thermal pressurization and seepage.
#pragma once

#include <cstdint>
#include <vector>

#include "band/flow_depth.hpp"
#include "band/model.hpp"
#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// Records of the pore pressure stage at a node.
template <int Dim, class Real>
struct SeepageNodes {
  explicit SeepageNodes(const std::shared_ptr<mpm::PatchRoom>& room) : flows(room) {}

  std::vector<std::uint8_t> seeping_tiles;   // with particles from or to which water seeps
  std::vector<std::uint8_t> seeping_blocks;  // with nodes that these see; flows are of these alone
  mpm::NodeRecords<Dim, Real, 3>
      flows;  // inflow times K_L [Pa m3/s], pore space [m3], pore space times seepage within cells
};

// Flow depth and pore pressure of all particles after dt; to follow conduct_heat in a step, and average_on_grid at its
// start.
template <int Dim, class Real>
void drain_pore_pressure(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                         const FlowDepth<Dim, Real>& depth, Real dt, const mpm::Nodes<Dim, Real>& nodes,
                         SeepageNodes<Dim, Real>& work, mpm::Particles<Dim, Real>& particles);

// Pressures of particles that begin, from temperature and flow depth; of those that stand in memory from `first` on. A
// melted particle starts from P_L = P_I / r.
template <int Dim, class Real>
void set_pore_pressure(const BandModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles, std::size_t first = 0);

}  // namespace thawslide::band
