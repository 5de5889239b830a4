#include "sim/solver/step_model.hpp"

#include "base/instances.hpp"
#include "sim/setup/release_body.hpp"
#include "sim/setup/terrain_at_columns.hpp"
#include "sim/solver/clock.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::sim {

template <int Dim>
device::StepModel<Dim> step_model_of(const config::Case& parameters, const Model<Dim>& model, const Clock& clock) {
  device::StepModel<Dim> device;
  device.cell = parameters.grid.cell;
  device.mapping = mapping_of(model);
  if (model.ground) {
    device.columns = model.ground->columns();
  }
  for (std::size_t body = 0; body < model.body_names.size(); ++body) {
    device.half_sizes.push_back(model.motion.sizes.half(body));
  }
  device.motion = model.motion;
  device.moves = parameters.mechanics.enabled;
  device.filters_in_step = [parameters](double time, double dt) { return filters_in_step(parameters, time, dt); };
  device.free_gaps = model.free_gaps;
  device.extent = model.constraints.extent;
  device.conditions = model.constraints.conditions;
  device.width = model.motion.width;
  device.between_bodies = model.between_bodies;
  if (model.between_bodies.any()) {
    device.layers_of_bodies = [&model](double time) { return layers_of_bodies(model, time); };
  }
  // Particles that will be removed may leave the domain before the end of the step.
  const double margin = parameters.grid.leaving == config::Policy::remove ? device.cell : 0.0;
  const Vector<double, Dim> beyond = Vector<double, Dim>::Constant(margin);
  device.lower = -beyond;
  device.upper = model.constraints.extent + beyond;
  device.finds_extremes = parameters.time.stepping == config::Stepping::adaptive;
  device.counts_escaped =
      parameters.grid.leaving == config::Policy::remove || parameters.terrain.kind == config::TerrainKind::dem;
  device.contact = model.contact;
  const bool has_columns = model.contact.band_columns;  // columns carry all heat and pore pressure of the base
  device.band = model.band;
  device.band.pressure = model.band.pressure && !has_columns;
  device.band.heat = model.band.heat && !has_columns;
  device.starts = clock.step_number == 0;
  device.time = clock.time;
  device.rescales_band = !has_columns;
  device.band_thickness = [thickness = parameters.band.thickness](double time) { return thickness.at(time); };
  return device;
}

template <int Dim>
device::HostCallbacks<Dim> host_callbacks_of(const Model<Dim>& model, double cell) {
  device::HostCallbacks<Dim> callbacks;
  if (model.ground) {
    callbacks.ground = [&model, cell](std::uint64_t block, terrain::GroundAtNode<Dim>* nodes) {
      terrain::query_ground<Dim>(*model.ground, model.substrates.get(), block, cell, nodes);
      return terrain::is_ground_known<Dim>(*model.ground, block, cell);
    };
    callbacks.column_heights = [&model] { return model.ground->column_heights(); };
  }
  if (model.band.normal_thickness) {
    callbacks.slope_cosine = slope_cosine_of(model, cell);
  }
  callbacks.normal_gravity = normal_gravity_of(model, cell);
  if (model.band.width.varies()) {
    callbacks.width = [&model](const auto& position) { return model.band.width.at(position[0]); };
  }
  return callbacks;
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                          \
  template device::StepModel<Dim> step_model_of<Dim>(const config::Case&, const Model<Dim>&, const Clock&); \
  template device::HostCallbacks<Dim> host_callbacks_of<Dim>(const Model<Dim>&, double);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
