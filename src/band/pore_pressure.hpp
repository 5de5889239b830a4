// Pore pressure (Eqs. 4, 8, 21-23): Clapeyron while ice and water coexist, then thermal pressurization and seepage.
#pragma once

#include "band/flow_depth.hpp"
#include "band/model.hpp"
#include "band/pressure_kernels.hpp"
#include "mpm/nodes.hpp"
#include "mpm/particles.hpp"

namespace thawslide::band {

// Water lost by particles in one step: at the surface, with its heat, and to frozen pores [kg].
struct WaterLoss {
  DrainedWater drained;
  double vented = 0;
};

// Updates flow depth and pore pressure of all particles over dt. Call after conduct_heat, with average_on_grid at the
// beginning of the step.
template <int Dim>
WaterLoss drain_pore_pressure(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model,
                              const FlowDepth<Dim>& depth, double dt, mpm::Nodes<Dim>& nodes,
                              mpm::Particles<Dim>& particles);

// Sets the pressures of new particles, those at memory index `first` and above, from temperature and flow depth. A
// melted particle starts from P_L = P_I / r.
template <int Dim>
void set_pore_pressure(const BandModel<Dim>& model, mpm::Particles<Dim>& particles, std::size_t first = 0);

}  // namespace thawslide::band
