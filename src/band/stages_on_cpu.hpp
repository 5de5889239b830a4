// Stages of heat and pore pressure (band/stages.hpp) on the CPU: heat with the shear band scaling of Sec. 2.3, which is
// equivalent to a grid finer by xi, and pore pressure (Eqs. 4, 8, 18-23).
#pragma once

#include "band/flow_depth.hpp"
#include "band/model.hpp"
#include "band/nodal_heat.hpp"
#include "band/pressure_kernels.hpp"
#include "mpm/nodes.hpp"

namespace thawslide::band {

template <int Dim>
struct StagesOnCpu {
  const mpm::SparseGrid<Dim>& grid;
  const BandModel<Dim>& model;
  mpm::Particles<Dim>& particles;
  mpm::Nodes<Dim>& nodes;

  // Averages temperature and pore pressure of particles to the nodes with the linear shape functions: nodes.averages
  // (sums) and nodes.state.
  void average_on_grid() const;
  // Sets the current scaling xi = layer / thickness of particles at memory index `first` and above (1 outside the
  // region). Returns the heat [J] that the change adds at constant temperature and pressure. thickness 0: no band,
  // xi = 1.
  double rescale_band(double thickness, std::size_t first = 0) const;
  // Updates heat content, temperature and saturation of all particles over dt. nodes.state must be that of
  // average_on_grid in this step. first_step: prescribed temperatures are applied as a jump.
  HeatGain conduct_heat(double dt, bool first_step) const;
  // Updates flow depth and pore pressure of all particles over dt. Call after conduct_heat.
  WaterLoss drain_pore_pressure(const FlowDepth<Dim>& depth, double dt) const;
};

}  // namespace thawslide::band
