#include "band/stages_on_cpu.hpp"

#include "band/stages.hpp"
#include "base/instances.hpp"
#include "mpm/step_passes.hpp"

namespace thawslide::band {

namespace {

template <int Dim>
mpm::StepPasses<Dim> passes_of(const StagesOnCpu<Dim>& on) {
  return {on.grid, {on.model.shape, on.model.sizes, on.model.sides}, on.particles, on.nodes};
}

}  // namespace

template <int Dim>
void StagesOnCpu<Dim>::average_on_grid() const {
  nodes.state.resize(grid.blocks().size());
  auto passes = passes_of(*this);
  stages::average_on_grid(passes, model);
}

template <int Dim>
double StagesOnCpu<Dim>::rescale_band(double thickness, std::size_t first) const {
  auto passes = passes_of(*this);
  double added_heat = 0;
  stages::rescale_band(passes, model, grid.mapping().has_ground, thickness, &added_heat, first);
  return added_heat;
}

template <int Dim>
HeatGain StagesOnCpu<Dim>::conduct_heat(double dt, bool first_step) const {
  if (model.heat) {
    nodes.unreached_heat.allocate(grid.blocks().size(), [&](std::size_t b) { return nodes.contact.contains(b); });
  }
  auto passes = passes_of(*this);
  HeatGain gain;
  stages::conduct_heat(passes, model, model.hydraulic(), dt, first_step, &gain);
  return gain;
}

template <int Dim>
WaterLoss StagesOnCpu<Dim>::drain_pore_pressure(const FlowDepth<Dim>& depth, double dt) const {
  auto passes = passes_of(*this);
  WaterLoss loss;
  stages::drain_pore_pressure(passes, model, model.hydraulic(), depth.by_tile(), dt, &loss);
  return loss;
}

#define THAWSLIDE_INSTANTIATE(Dim) template struct StagesOnCpu<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
