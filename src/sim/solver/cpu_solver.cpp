#include "sim/solver/cpu_solver.hpp"

#include <cmath>
#include <utility>

#include "band/new_particles.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "mpm/box_sums.hpp"
#include "mpm/front_stage.hpp"
#include "mpm/step_sequence.hpp"
#include "mpm/sum_over_particles.hpp"
#include "sim/setup/terrain_at_columns.hpp"
#include "sim/solver/clock.hpp"
#include "sim/solver/time_step.hpp"

namespace thawslide::sim {

template <int Dim>
StepSums<Dim> CpuSolver<Dim>::step(double dt, const terrain::StrengthLaw* strength) {
  sums_ = {};
  mpm::perform_step(*this, clock_.time, dt, strength);
  sums_.band_rescale = std::exchange(rescaling_heat_, 0.0);
  return sums_;
}

template <int Dim>
void CpuSolver<Dim>::find_cells(double time) {
  blocks_of_nodes_.clear();
  slide_.locate(setup_.model);
  slide_.set_layers(setup_.model, time);
  slide_.update_grid(setup_.model, slide_.sorting_interval);
  if (slide_.grid.blocks_changed() && !setup_.parameters.mechanics.enabled) {
    terrain::start_contact(slide_on_ground());  // there is no contact, and no step resolves it
  }
}

template <int Dim>
void CpuSolver<Dim>::average_band_on_grid(bool law_is_given) {
  const Model<Dim>& model = setup_.model;
  const bool reads_mass = model.contact.reads_mass || law_is_given;
  if (!base_.columns && ((model.ground && reads_mass) || model.band.heat || model.band.pressure)) {
    band_stages().average_on_grid();
  }
}

template <int Dim>
void CpuSolver<Dim>::momentum_to_grid() {
  force_of_walls_ = mpm::momentum_to_grid(slide_.grid, slide_.particles, setup_.model.motion, nodes_);
  blocks_of_nodes_ = slide_.grid.blocks();
}

template <int Dim>
void CpuSolver<Dim>::resolve_contact(double time, double dt, const terrain::StrengthLaw* strength) {
  const Model<Dim>& model = setup_.model;
  if (model.between_bodies.any()) {
    body_contact_.update_pairs(slide_.grid.blocks(), model.between_bodies);
  }
  if (body_contact_.work_count() > 0) {
    between_bodies_.emplace(ContactOfBodies{slide_.grid.tables(tables_),
                                            mpm::view_of(slide_.particles),
                                            model.motion.sizes.view(),
                                            model.ground != nullptr,
                                            setup_.cell(),
                                            model.contact.mass_damping,
                                            dt,
                                            model.motion.gravity,
                                            {slide_.grid, nodes_}});
    body_contact_.add_forces(*between_bodies_);
  }
  mpm::BaseStates<Dim> columns;
  if (base_.columns) {
    base_.columns->to_nodes(slide_.grid.block_tables());
    columns = base_.columns->states();
  }
  sums_.contact = contact_.resolve(
      slide_on_ground(), time, dt, columns, [this] { band_stages().average_on_grid(); }, base_.bed_in_reach(model),
      strength, force_of_walls_);
  update_columns(setup_, slide_.grid, slide_.ground, time, dt, nodes_, base_);
}

template <int Dim>
void CpuSolver<Dim>::move_particles(double time, double dt) {
  const Model<Dim>& model = setup_.model;
  sums_.particle_kinetic = mpm::move_particles(slide_.grid, slide_.particles, model.motion, dt, nodes_);
  if (model.motion.filter_order > 0 && filters_in_step(setup_.parameters, time, dt)) {
    sums_.filtered = mpm::filter_velocities(slide_.grid, slide_.particles, model.motion, nodes_);
  }
  sums_.mapped_back = terrain::constrain_mapped_back(slide_on_ground(), time, dt);
  if (body_contact_.work_count() > 0) {
    std::vector<mpm::BodyContactWork> works(body_contact_.work_count());
    body_contact_.constrain_mapped_back(*between_bodies_, works.data());
    sums_.between_bodies = parallel_sum<mpm::BodyContactWork>(
        works.size(), [&](std::size_t k, mpm::BodyContactWork& sum) { sum += works[k]; });
  }
}

template <int Dim>
void CpuSolver<Dim>::update_stress_and_porosity(double dt) {
  sums_.deformed = mpm::update_stress_and_porosity(slide_.grid, slide_.particles, setup_.model.motion, dt, nodes_);
}

template <int Dim>
void CpuSolver<Dim>::rescale_band(double time) {
  const Model<Dim>& model = setup_.model;
  const double thickness = setup_.band_thickness(time);
  if (!model.contact.band_columns && model.band.scaling_changes(model.ground != nullptr, thickness, band_thickness_)) {
    rescaling_heat_ += band_stages().rescale_band(thickness);
  }
}

template <int Dim>
void CpuSolver<Dim>::conduct_heat(double dt) {
  if (!base_.columns) {  // otherwise, the body's temperature is constant
    sums_.heat = band_stages().conduct_heat(dt, clock_.step_number == 0);
  }
}

template <int Dim>
void CpuSolver<Dim>::drain_pore_pressure(double dt) {
  if (setup_.model.band.pressure && !base_.columns) {
    update_flow_depth();
    update_normal_load();
    sums_.water = band_stages().drain_pore_pressure(flow_depth_, dt);
  }
}

template <int Dim>
void CpuSolver<Dim>::update_positions() {
  mpm::Particles<Dim>& particles = slide_.particles;
  if (setup_.parameters.mechanics.enabled) {
    // Particles that will be removed may leave the domain before the end of the step.
    const double margin = setup_.parameters.grid.leaving == config::Policy::remove ? slide_.grid.cell() : 0.0;
    const Vector<double, Dim> beyond = Vector<double, Dim>::Constant(margin);
    slide_.are_located = false;
    sums_.invalid = mpm::update_positions(particles, Vector<double, Dim>(-beyond),
                                          Vector<double, Dim>(setup_.model.constraints.extent + beyond));
    return;
  }
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (!std::isfinite(particles.temperature(p)) || !std::isfinite(particles.pore_pressure(p))) {
      sums_.invalid.record(particles.id(p), mpm::Fault::state_not_finite);
    }
  }
}

template <int Dim>
void CpuSolver<Dim>::begin() {
  const Model<Dim>& model = setup_.model;
  find_cells(clock_.time);
  if (model.ground) {
    terrain::set_contact_offset(model.motion.sizes, slide_.grid.cell(), slide_.particles);
  }
  terrain::start_contact(slide_on_ground());
  if (!model.contact.band_columns) {
    band_stages().rescale_band(setup_.band_thickness(clock_.time));
  }
  update_flow_depth();
  flow_depth_.depth_to_particles(slide_.grid, slide_.particles);
  update_normal_load();
  band::set_pore_pressure(model.band, slide_.particles);
}

template <int Dim>
void CpuSolver<Dim>::join(std::size_t first) {
  const Model<Dim>& model = setup_.model;
  slide_.are_located = false;
  slide_.locate(model);
  slide_.update_grid(model, 0);
  if (needs_normal_load()) {
    update_flow_depth();
    update_normal_load(first);
  }
  band::set_pore_pressure(model.band, slide_.particles, first);
  if (model.motion.effective_stress) {
    mpm::split_total_stress(slide_.particles, first);
  }
  if (model.ground) {
    terrain::set_contact_offset(model.motion.sizes, slide_.grid.cell(), slide_.particles, first);
  }
  if (!model.contact.band_columns) {
    band_stages().rescale_band(setup_.band_thickness(clock_.time), first);
  }
}

template <int Dim>
void CpuSolver<Dim>::update_flow_depth() {
  flow_depth_.update(slide_.grid, setup_.model.band, slope_cosine_of(setup_.model, setup_.cell()),
                     needs_normal_load() ? normal_gravity_of(setup_.model, setup_.cell()) : band::OfPosition<Dim>(),
                     slide_.particles);
}

template <int Dim>
void CpuSolver<Dim>::update_normal_load(std::size_t first) {
  if (needs_normal_load()) {
    flow_depth_.load_to_particles(slide_.grid, slide_.particles, first);
  }
}

template <int Dim>
band::StepExtremes CpuSolver<Dim>::extremes() const {
  slide_.locate(setup_.model);
  return extremes_of(setup_.model, slide_.particles);
}

template <int Dim>
AnySums<Dim> CpuSolver<Dim>::reduce(const AnyReduction<Dim>& reduction) const {
  return std::visit(
      [this]<class Reduction>(const Reduction& of) -> AnySums<Dim> {
        return mpm::sum_over_particles<typename Reduction::Sums>(
            slide_.grid, [&](std::uint32_t p) { return of(slide_.particles, p); });
      },
      reduction);
}

template <int Dim>
mpm::PathSample CpuSolver<Dim>::front(const mpm::Transformation<Dim>& path, double mass) const {
  exec::Cpu cpu;
  const std::vector<std::uint32_t>& order = slide_.grid.order();
  return mpm::Front<exec::Cpu, Dim>(cpu).find(path, mass, mpm::view_of(slide_.particles), order.data(), order.size());
}

template <int Dim>
const band::MapSample* CpuSolver<Dim>::sample_map([[maybe_unused]] const mpm::MapCells& cells) const {
  if constexpr (Dim == 3) {
    if (slide_.grid.copy_tile_keys(tiles_of_maps_)) {
      maps_.forget_tiles();
    }
    return &maps_.sample(
        cells, [this] { return tiles_of_maps_; }, half_sizes_.view(), base_.columns ? &*base_.columns : nullptr,
        [this](const auto& boxes) { mpm::add_boxes(slide_.grid, slide_.particles, boxes); });
  } else {
    return nullptr;
  }
}

template <int Dim>
MomentumOfNodes CpuSolver<Dim>::momentum_of_nodes() const {
  MomentumOfNodes all{blocks_of_nodes_, {}};
  for (std::size_t b = 0; b < all.blocks.size(); ++b) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(mpm::Tile<Dim>::nodes); ++k) {
      const auto& record = nodes_.momentum(b, k);
      all.records.insert(all.records.end(), record.begin(), record.end());
    }
  }
  return all;
}

#define THAWSLIDE_INSTANTIATE(Dim) template class CpuSolver<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
