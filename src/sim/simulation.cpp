#include "sim/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "band/averages.hpp"
#include "band/basal_segments.hpp"
#include "band/heat.hpp"
#include "band/pore_pressure.hpp"
#include "base/instances.hpp"
#include "base/rounding.hpp"
#include "device/solver.hpp"
#include "mpm/body_contact.hpp"
#include "mpm/velocity_filter.hpp"
#include "sim/bed_of_device.hpp"
#include "sim/bodies.hpp"
#include "sim/direction.hpp"
#include "sim/entrainment.hpp"
#include "sim/filter_times.hpp"
#include "sim/grid_of_device.hpp"
#include "sim/memory_need.hpp"
#include "sim/splitting.hpp"
#include "sim/terrain_at_columns.hpp"
#include "terrain/band_marks.hpp"
#include "terrain/ground_on_grid.hpp"
#include "terrain/map_back.hpp"
#include "terrain/near_ground.hpp"

namespace thawslide::sim {

// Discrete step, Section 2.3 of the paper; all stages use the shape functions at the initial positions of the step.
//   m_i = sum S m,  p_i = sum S m v,  f_i = sum S m b - V sigma.G                              Eq. 12
//   P_i, S_i, n_i: averages with the linear shape functions; with band columns, only if a node presses on ground
//   without a column                                                                         Eq. 21
//   f_i of bodies that do not share nodes: including the forces between them                 mpm/body_contact.hpp
//   p_i + f_i dt corrected by contact: N = p.n/(A dt), S_slide = mu_e (N - P) + c_S            Eqs. 15-17, 25
//   v_p += sum S a dt,  x_p += sum S (v_i + a_i dt/2) dt                                       Eqs. 13, 14
//   stress and porosity from the mapped-back velocities                                        Eqs. 11, 6
//   heat content from conduction, advection and the friction heat of the contact nodes         Eqs. 9, 18-20
//   pore pressure: Clapeyron, then thermal pressurization and seepage                          Eqs. 4, 8, 22, 23
template <int Dim>
void Simulation<Dim>::step(double dt, const terrain::StrengthLaw* strength) {
  THAWSLIDE_ASSERT(!device_has_failed_, "a step after {} has failed", device_name_);
  THAWSLIDE_ASSERT(strength == nullptr || !make_solver_, "a law of the caller on {}", device_name_);
  dt_ = static_cast<Real>(dt);
  budget_before_ = budget_;
  if (step_number_ == 0) {
    start_monitor();  // again, because the caller may have changed the state
  }
  if (make_solver_) {
    stopwatch_.time("step_on_device", [&] { advance_on_device(); });
  } else {
    step_on_cpu(strength);
  }
  ++step_number_;
  time_ = time_after(dt);
  last_step_ = dt;
  post_step();
}

// Time at the end of the step. Fixed steps are counted from the first step of their size, so round-off does not
// accumulate.
template <int Dim>
double Simulation<Dim>::time_after(double dt) {
  if (parameters_.time.stepping != config::Stepping::fixed || dt != parameters_.time.step) {
    fixed_step_clock_ = {};
    return time_ + dt;
  }
  if (dt != fixed_step_clock_.step) {
    fixed_step_clock_ = {dt, time_, step_number_ - 1};
  }
  return fixed_step_clock_.from_time + static_cast<double>(step_number_ - fixed_step_clock_.from_number) * dt;
}

template <int Dim>
void Simulation<Dim>::step_on_cpu(const terrain::StrengthLaw* strength) {
  stopwatch_.time("find_cells", [&] { find_particles_cells(); });
  const bool reads_mass = model_.contact.reads_mass || strength != nullptr;
  stopwatch_.time("average_band_on_grid", [&] { average_band_on_grid(reads_mass); });
  if (parameters_.mechanics.enabled) {
    stopwatch_.time("momentum_to_grid", [&] { momentum_to_grid(); });
    stopwatch_.time("resolve_contact", [&] { resolve_contact(strength); });
    stopwatch_.time("move_particles", [&] { move_particles(); });
    stopwatch_.time("update_stress_and_porosity", [&] { update_stress_and_porosity(); });
  }
  stopwatch_.time("conduct_heat", [&] { conduct_heat(); });
  stopwatch_.time("drain_pore_pressure", [&] { drain_pore_pressure(); });
  stopwatch_.time("update_positions", [&] { update_positions(); });
}

// Ends the run, or removes or adds particles, if necessary.
template <int Dim>
void Simulation<Dim>::post_step() {
  monitor();
  if (!needs_no_host_check()) {
    sync_to_host();
    stop_for_or_remove_particles();
  }
  if (bed_in_reach() != nullptr) {
    stopwatch_.time("entrain_bed", [&] { entrain_bed(); });
  }
  split_stretched();
}

template <int Dim>
void Simulation<Dim>::stop_for_or_remove_particles() {
  mark_invalid_particles();
  stop_if_invalid();
  mark_left_particles();
  if (invalid_.id >= 0) {
    monitor();  // reports an instability before an out-of-DEM error, so that the user is not advised to enlarge the DEM
  }
  stop_if_invalid();
  remove_marked_particles();
}

template <int Dim>
void Simulation<Dim>::find_particles_cells() {
  locate_particles();
  update_layers();
  grid_.update(particles_, sorting_interval_);
  update_ground();
  if (grid_.blocks_changed() && !parameters_.mechanics.enabled) {
    terrain::start_contact(grid_, ground(), nodes_);  // there is no contact, and no step resolves it
  }
}

template <int Dim>
void Simulation<Dim>::update_ground() const {
  if (model_.ground && grid_.blocks_changed()) {
    ground_->update(*model_.ground, grid_, model_.substrates.get());
  }
}

template <int Dim>
void Simulation<Dim>::average_band_on_grid(bool reads_mass) {
  if (model_.band.rescaling_mixes) {
    rescale_band();  // changes temperatures
  }
  if (!band_columns_ && ((model_.ground && reads_mass) || model_.band.heat || model_.band.pressure)) {
    band::average_on_grid(grid_, model_.band, particles_, nodes_);
  }
}

template <int Dim>
void Simulation<Dim>::momentum_to_grid() {
  force_of_walls_ = mpm::momentum_to_grid(grid_, particles_, model_.motion, nodes_);
}

// Only nodes out of reach of band columns need the state of particles, and only if a law reads it.
template <int Dim>
void Simulation<Dim>::press_on_ground(bool reads_mass) {
  if (!model_.ground) {
    return;
  }
  const auto to_grid =
      band_columns_ || !reads_mass ? &terrain::clearance_to_grid<Dim> : &terrain::near_ground_to_grid<Dim>;
  to_grid(grid_, *ground_, model_.motion, particles_, nodes_);
  if (band_columns_) {
    band_columns_->to_nodes(grid_, nodes_);
  }
  terrain::press_on_ground(grid_, *ground_, model_.constraints, model_.contact, static_cast<Real>(time_), dt_, nodes_);
  if (band_columns_ && reads_mass && terrain::loads_bare_ground(grid_, nodes_)) {
    band::average_on_grid(grid_, model_.band, particles_, nodes_);
    terrain::near_ground_to_grid(grid_, *ground_, model_.motion, particles_, nodes_);
  }
}

template <int Dim>
void Simulation<Dim>::resolve_contact(const terrain::StrengthLaw* strength) {
  if (body_contact_) {
    body_contact_->add_forces(grid_, particles_, model_.between_bodies, model_.motion.sizes,
                              model_.contact.mass_damping, dt_, nodes_);
  }
  press_on_ground(model_.contact.reads_mass || strength != nullptr);
  contact_ = terrain::resolve_contact(grid_, ground(), model_.constraints, model_.contact, static_cast<Real>(time_),
                                      dt_, nodes_, bed_to_meet(), strength);
  contact_.force[0] -= force_of_walls_;  // the walls are part of the ground
  collect_bed();
  add_contact_energy();
  add_bed_energy();
  if (model_.ground) {
    terrain::mark_band_and_slip(grid_, *ground_, dt_, nodes_, particles_);
  }
  band_columns_follow(grid_, *ground_, nodes_);
}

template <int Dim>
void Simulation<Dim>::move_particles() {
  const auto work = mpm::move_particles(grid_, particles_, model_.motion, dt_, nodes_);
  budget_.numerical += work.particle_kinetic - contact_.node_kinetic;
  if (model_.motion.filter_order > 0 && filters_in_step(parameters_, time_, static_cast<double>(dt_))) {
    budget_.numerical += mpm::filter_velocities(grid_, particles_, model_.motion, nodes_);
  }
  budget_.numerical += terrain::constrain_mapped_back(grid_, ground(), model_.constraints, model_.contact,
                                                      model_.motion.gravity, static_cast<Real>(time_), dt_, nodes_);
  if (body_contact_) {
    const auto between = body_contact_->constrain_mapped_back(model_.motion.gravity, dt_, nodes_);
    budget_.contact_loss += between.loss;
    budget_.numerical += between.numerical;
  }
}

template <int Dim>
void Simulation<Dim>::update_stress_and_porosity() {
  add_stress_work(mpm::update_stress_and_porosity(grid_, particles_, model_.motion, dt_, nodes_, invalid_));
}

template <int Dim>
void Simulation<Dim>::rescale_band() {
  if (model_.contact.band_columns) {
    return;
  }
  Real added = 0;
  const bool depends_on_position = model_.band.region != band::BandRegion::all || model_.ground;
  if (depends_on_position || band_thickness() != current_band_thickness_) {
    current_band_thickness_ = band_thickness();
    added = band::rescale_band(grid_, model_.band, static_cast<Real>(current_band_thickness_), particles_);
  }
  budget_.band_rescale += model_.band.heat ? added : Real(0);
}

template <int Dim>
void Simulation<Dim>::conduct_heat() {
  if (!model_.band.rescaling_mixes) {
    rescale_band();
  }
  if (band_columns_) {  // the body's temperature is constant
    budget_.friction_heat += contact_.friction_work - contact_.converted;
    return;
  }
  band::average_seeping_water(grid_, model_.band, particles_, nodes_);
  if (!model_.band.heat) {
    return;
  }
  add_heat_gain(band::conduct_heat(grid_, model_.band, dt_, step_number_ == 0, nodes_, particles_));
}

template <int Dim>
void Simulation<Dim>::drain_pore_pressure() {
  if (!model_.band.pressure || band_columns_) {
    return;
  }
  update_columns();
  update_normal_load();
  const auto loss = band::drain_pore_pressure(grid_, model_.band, flow_depth_, dt_, nodes_, particles_);
  budget_.drained_water += loss.drained.mass;
  budget_.drained_heat += loss.drained.heat;
  budget_.vented_water += loss.vented;
}

template <int Dim>
void Simulation<Dim>::update_positions() {
  if (parameters_.mechanics.enabled) {
    // Particles that will be removed may leave the domain before the end of the step.
    const Real margin = parameters_.grid.leaving == config::Policy::remove ? grid_.cell() : Real(0);
    const Vector<Real, Dim> beyond = Vector<Real, Dim>::Constant(margin);
    mpm::update_positions(particles_, Vector<Real, Dim>(-beyond), Vector<Real, Dim>(model_.constraints.extent + beyond),
                          invalid_);
    are_particles_located_ = false;
    return;
  }
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    if (!std::isfinite(particles_.temperature(p)) || !std::isfinite(particles_.pore_pressure(p))) {
      invalid_.record(particles_.id(p), mpm::Fault::state_not_finite);
    }
  }
}

namespace {

// Material parameter behind a fast wave, possibly a typing error in the case; empty for other limits.
template <int Dim>
std::string material_text(const config::Case& parameters, const Model<Dim>& model, const mpm::Particles<Dim>& particles,
                          const StepLimit& limit) {
  if (limit.kind != LimitKind::wave && limit.kind != LimitKind::viscosity) {
    return "";
  }
  std::size_t p = 0;
  while (p + 1 < particles.size() && particles.id(p) != limit.particle) {
    ++p;
  }
  const std::string& material = model.material_names[static_cast<std::size_t>(particles.material(p))];
  return fmt::format(", with a Young's modulus of {:g} Pa and {} kg/m3",
                     parameters.materials.at(material).youngs_modulus,
                     rounded_text(particles.mass(p) / particles.volume(p), 3));
}

}  // namespace

template <int Dim>
Simulation<Dim>::Simulation(const config::Case& parameters, const config::Site& site)
    : parameters_(require_memory<Dim>(parameters, site)),  // checked before any allocation
      site_(site),
      model_(make_model<Dim>(parameters, site)),
      grid_(make_grid(parameters, model_)),
      ground_(std::make_unique<terrain::GroundOnGrid<Dim>>()),
      bed_(make_bed<Dim>(parameters, site, model_)) {
  if (model_.between_bodies.any()) {
    body_contact_ = std::make_unique<mpm::BodyContact<Dim>>();
  }
  seed();
  if (parameters_.time.stepping == config::Stepping::fixed) {
    const StepLimit limit =
        sim::step_limit(parameters_, model_, parameters_.band.thickness.smallest(), extremes_of(model_, particles_));
    if (parameters_.time.step > limit.step) {
      throw UserError(
          fmt::format("{}: time.step is {} s, above the limit of {:.3g} s set by {}{}. Use a smaller time.step, or "
                      "time.stepping = \"adaptive\".",
                      config::location_of(parameters_, "time.step"), parameters_.time.step, rounded_down(limit.step, 3),
                      limit.what, material_text(parameters_, model_, particles_, limit)));
    }
  }
  begin();
  if (model_.motion.effective_stress) {
    mpm::split_total_stress(particles_);
  }
}

// Defined here, because instantiation wherever a run ends took half of the compile time of those sources.
template <int Dim>
Simulation<Dim>::~Simulation() = default;

template <int Dim>
void Simulation<Dim>::begin() {
  time_ = last_step_ = 0.0;
  step_number_ = 0;
  fixed_step_clock_ = {};
  contact_ = {};
  find_particles_cells();
  if (model_.ground) {
    terrain::set_contact_offset(model_.motion.sizes, grid_.cell(), particles_);
  }
  mark_band();
  if (!model_.contact.band_columns) {
    band::rescale_band(grid_, model_.band, static_cast<Real>(band_thickness()), particles_);
  }
  update_columns();
  flow_depth_.depth_to_particles(grid_, particles_);
  update_normal_load();
  band::set_pore_pressure(model_.band, particles_);
  start_band_columns();
  start_ledger();
  start_monitor();
}

template <int Dim>
void Simulation<Dim>::seed() {
  const auto& materials = model_.motion.materials;
  particles_.affine_velocity.keep(model_.motion.transfer == mpm::TransferKind::apic);
  particles_.viscous_stress.keep(model_.motion.viscous());
  keep_split_fields(model_.splits_stretched, particles_);
  particles_.height_above_ground.keep(model_.ground != nullptr);
  particles_.ground_slope.keep(model_.ground != nullptr);
  particles_.linear_slope.keep(model_.ground != nullptr);
  band::keep_fields(model_.band, particles_);
  particles_.gap.keep(
      std::any_of(materials.begin(), materials.end(), [](const auto& m) { return m.gaps_close_first; }));
  fill_bodies(parameters_, site_, model_, particles_);
  are_particles_located_ = false;
  locate_particles();  // the limits of a time step depend on the slope below them
  particles_at_start_ = particles_.size();
  next_id_ = static_cast<std::int64_t>(particles_at_start_);
  split_count_ = 0;
  set_unsplit(particles_);
  band::set_heat_content(model_.band, particles_);
  grid_ = make_grid(parameters_, model_);
}

// Marks the particles in the band before anything has moved.
template <int Dim>
void Simulation<Dim>::mark_band() {
  terrain::start_contact(grid_, ground(), nodes_);
  if (model_.ground) {
    terrain::mark_band_and_slip(grid_, *ground_, Real(0), nodes_, particles_);
  }
}

template <int Dim>
void Simulation<Dim>::update_columns() {
  flow_depth_.update(grid_, model_.band, slope_cosine_of(model_, parameters_.grid.cell), particles_);
}

template <int Dim>
void Simulation<Dim>::start_ledger() {
  const BodySums<Dim> sums = sum_over_body();
  budget_ = {};
  budget_.initial_mechanical = sums.kinetic + sums.potential;
  budget_.initial_thermal = sums.sensible + sums.latent;
  budget_.initial_mass = sums.mass;
  budget_.initial_momentum = sums.momentum;
  bodies_at_start_ = sim::bodies_at_start(model_, particles_, parameters_.grid.cell);
}

#define THAWSLIDE_INSTANTIATE(Dim) template class Simulation<Dim>;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
