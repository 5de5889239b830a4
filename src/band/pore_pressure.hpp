// Pore pressure (Eqs. 4, 8, 21-23): Clapeyron while ice and water coexist, then thermal pressurization and seepage.
#pragma once

#include "band/flow_depth.hpp"
#include "band/model.hpp"
#include "band/pressure_kernels.hpp"
#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// Water that particles lost in one step: at the surface, with its heat, and to frozen pores [kg].
template <class Real>
struct WaterLoss {
  DrainedWater<Real> drained;
  Real vented = 0;
};

// Flow depth and pore pressure of all particles after dt; to follow conduct_heat in a step, and average_on_grid at its
// start.
template <int Dim, class Real>
WaterLoss<Real> drain_pore_pressure(const mpm::SparseGrid<Dim, Real>& grid, const BandModel<Dim, Real>& model,
                                    const FlowDepth<Dim, Real>& depth, Real dt, mpm::Nodes<Dim, Real>& nodes,
                                    mpm::Particles<Dim, Real>& particles);

// Pressures of particles that begin, from temperature and flow depth; of those that stand in memory from `first` on. A
// melted particle starts from P_L = P_I / r.
template <int Dim, class Real>
void set_pore_pressure(const BandModel<Dim, Real>& model, mpm::Particles<Dim, Real>& particles, std::size_t first = 0);

}  // namespace thawslide::band
