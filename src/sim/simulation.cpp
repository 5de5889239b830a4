#include "sim/simulation.hpp"

#include <algorithm>
#include <utility>

#include "band/new_particles.hpp"
#include "base/rounding.hpp"
#include "sim/between_steps/entrainment.hpp"
#include "sim/direction.hpp"
#include "sim/memory_need.hpp"
#include "sim/setup/bodies.hpp"
#include "sim/solver/device_solver.hpp"

namespace thawslide::sim {

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

// Fills in the new particles at the end of the arrays, from `first` on; ids count from `next_id`.
template <int Dim>
void fill_new(const std::vector<NewParticle<Dim>>& joining, std::size_t first, std::int64_t& next_id,
              const Model<Dim>& model, mpm::Particles<Dim>& particles) {
  for (std::size_t k = 0; k < joining.size(); ++k) {
    const NewParticle<Dim>& one = joining[k];
    const std::size_t p = first + k;
    THAWSLIDE_ASSERT(static_cast<std::size_t>(one.body) < model.body_names.size() &&
                         static_cast<std::size_t>(one.material) < model.material_names.size() && one.volume > 0.0,
                     "a particle of body {}, material {} and {} m3 joins", one.body, one.material, one.volume);
    particles.id(p) = next_id++;
    particles.body(p) = one.body;
    particles.material(p) = one.material;
    particles.position.set(p, one.position);
    particles.velocity.set(p, one.velocity);
    particles.volume(p) = particles.initial_volume(p) = one.volume;
    particles.temperature(p) = one.temperature;
    particles.porosity(p) = particles.initial_porosity(p) = one.porosity;
    particles.flow_depth(p) = one.flow_depth;
    particles.thermal_scaling(p) = 1.0;
    for (int c = 0; c < mpm::tensor_components<Dim>; ++c) {
      particles.stress(p, c) = one.stress[c];
    }
  }
}

// Appends particles with new ids, with mass and heat content. They are in no band until the next step. Returns the
// index in memory of the first.
template <int Dim>
std::size_t append_particles(const std::vector<NewParticle<Dim>>& joining, const Model<Dim>& model, Slide<Dim>& slide) {
  mpm::Particles<Dim>& particles = slide.particles;
  const std::size_t first = particles.append(joining.size());
  fill_new(joining, first, slide.next_id, model, particles);
  set_unsplit(particles, first);
  band::set_heat_content(model.band, particles, first);
  for (std::size_t p = first; p < particles.size(); ++p) {
    particles.mass(p) = particles.volume(p) * physics::mixture_density(model.motion.phases, particles.porosity(p),
                                                                       particles.liquid_saturation(p));
  }
  return first;
}

}  // namespace

template <int Dim>
Simulation<Dim>::Simulation(const config::Case& parameters, const config::Site& site)
    : setup_{require_memory<Dim>(parameters, site), site, make_model<Dim>(parameters, site)},  // before any allocation
      slide_(std::make_unique<Slide<Dim>>(make_grid(parameters, setup_.model))),
      cpu_(setup_, *slide_, base_, clock_, stopwatch_) {
  base_.bed = make_bed<Dim>(parameters, site, setup_.model);
  seed();
  if (!setup_.is_adaptive()) {
    const StepLimit limit = sim::step_limit(parameters, setup_.model, parameters.band.thickness.smallest(),
                                            extremes_of(setup_.model, slide_->particles));
    if (parameters.time.step > limit.step) {
      throw UserError(fmt::format(
          "{}: time.step is {} s, above the limit of {:.3g} s set by {}{}. Use a smaller time.step, or time.stepping = "
          "\"adaptive\".",
          config::location_of(parameters, "time.step"), parameters.time.step, rounded_down(limit.step, 3), limit.what,
          material_text(parameters, setup_.model, slide_->particles, limit)));
    }
  }
  begin();
  if (setup_.model.motion.effective_stress) {
    mpm::split_total_stress(slide_->particles);
  }
}

// Defined here, because instantiation wherever a run ends took half of the compile time of those sources.
template <int Dim>
Simulation<Dim>::~Simulation() = default;

template <int Dim>
void Simulation<Dim>::step(double dt, const terrain::StrengthLaw* strength) {
  THAWSLIDE_ASSERT(left_text_.empty(), "a step without particles");
  budget_before_ = budget_;
  if (clock_.step_number == 0) {
    start_monitor();  // again, because the caller may have changed the state
  }
  sums_ = solver().step(dt, strength);
  add_step(sums_, setup_, base_.bed_in_reach(setup_.model) != nullptr, dt, budget_);
  invalid_ += sums_.deformed.invalid;
  invalid_ += sums_.invalid;
  clock_.advance(dt, setup_.parameters.time);
  monitor();
  if (invalid_.id >= 0 || !solver().none_has_left()) {
    solver().sync_to_host();
    stop_for_or_remove_particles();
  }
  if (left_text_.empty()) {
    entrain_bed();
    split_stretched();
  }
}

template <int Dim>
void Simulation<Dim>::monitor() {
  if (!setup_.parameters.mechanics.enabled || (clock_.step_number % watch_interval != 0 && invalid_.id < 0)) {
    return;
  }
  const mpm::MonitorSums seen = solver().sum_over_particles(monitor_kernel(setup_, clock_.last_step));
  if (const auto growth = check_energy(setup_, budget_, seen, monitor_)) {
    solver().sync_to_host();
    fail_run(clock_, failure_text().of_energy(growth->energy, growth->fraction));
  }
  invalid_ += seen.volumes;
  update_rest(setup_, clock_.time, seen, solver(), *slide_, monitor_);
}

template <int Dim>
void Simulation<Dim>::stop_for_or_remove_particles() {
  mark_invalid(setup_.parameters.guards, slide_->particles, marks_, invalid_);
  stop_if_invalid();
  // After a step on a device, its tiles may be outdated.
  mark_left(setup_, *slide_, device_ != nullptr, marks_, invalid_);
  if (invalid_.id >= 0) {
    monitor();  // reports an instability before an out-of-DEM error, so that the user is not advised to enlarge the DEM
  }
  stop_if_invalid();
  remove_marked();
}

template <int Dim>
void Simulation<Dim>::stop_if_invalid() const {
  if (invalid_.id >= 0) {
    fail_run(clock_, failure_text().of_particle(invalid_));
  }
}

template <int Dim>
void Simulation<Dim>::remove_marked() {
  const Removed now = count_of(marks_);
  if (now.all() == 0) {
    return;
  }
  const bool none_stays = static_cast<std::size_t>(now.all()) == slide_->particles.size();
  if (none_stays && now.by_guards() == 0) {
    left_text_ = text_of_left_slide<Dim>(clock_, sum_over_body().mass);
    return;
  }
  add_removed(setup_, *slide_, marks_, budget_before_, sums_of_particle(), budget_);
  removed_ += now;
  const double fraction = budget_.removed_mass / (budget_.initial_mass + budget_.joined_mass);
  if (none_stays || fraction > setup_.parameters.guards.removed_mass) {
    invalid_ = first_invalid(setup_.parameters.guards, slide_->particles, marks_);
    fail_run(clock_, failure_text().of_removed(text_of(removed_), fraction, invalid_));
  }
  solver().release();
  slide_->grid.remove(slide_->particles, slide_->particles.remove(marks_));
  slide_->update_ground(setup_.model);
}

template <int Dim>
void Simulation<Dim>::entrain_bed() {
  terrain::Bed<Dim>* bed = base_.bed_in_reach(setup_.model);
  if (bed == nullptr) {
    return;
  }
  stopwatch_.time("entrain_bed", [&] {
    if (clock_.step_number % joining_interval == 0) {
      append(loose_particles(setup_, solver(), *slide_, *bed, budget_));
    }
  });
}

template <int Dim>
void Simulation<Dim>::split_stretched() {
  if (!setup_.model.splits_stretched || clock_.step_number % split_interval != 0) {
    return;
  }
  stopwatch_.time("split_stretched", [&] {
    solver().copy_particles_back();
    const std::vector<Split<Dim>> due = splits_due(setup_, *slide_);
    if (!due.empty()) {
      solver().release();
      split(setup_, due, *slide_, budget_.numerical);
    }
  });
}

template <int Dim>
void Simulation<Dim>::append(const std::vector<NewParticle<Dim>>& joining) {
  if (joining.empty()) {
    return;
  }
  solver().release();
  const std::size_t first = append_particles(joining, setup_.model, *slide_);
  cpu_.join(first);
  for (std::size_t k = 0; setup_.model.band.heat && k < joining.size(); ++k) {
    band::add_heat(setup_.model.band, joining[k].heat, first + k, slide_->particles);
  }
  Marks is_new(slide_->particles.size(), 0);
  std::fill(is_new.begin() + static_cast<std::ptrdiff_t>(first), is_new.end(), std::uint8_t{1});
  const BodySums<Dim> sums = sum_over_marked(*slide_, sums_of_particle(), is_new);
  budget_.joined_mass += sums.mass;
  budget_.joined_mechanical += sums.kinetic + sums.potential;
  budget_.joined_thermal += sums.sensible + sums.latent;
  budget_.joined_momentum += sums.momentum;
}

template <int Dim>
void Simulation<Dim>::use_device(const std::string& device, device::SolverFactory<Dim> make) {
  solver().release();
  device_ = make_device_solver<Dim>(setup_, *slide_, base_, clock_, stopwatch_, cpu_, device, std::move(make));
}

template <int Dim>
void Simulation<Dim>::begin() {
  clock_ = {};
  sums_ = {};
  left_text_.clear();
  cpu_.begin();
  start_columns(setup_, slide_->particles, base_);
  start_budget();
  start_monitor();
}

template <int Dim>
void Simulation<Dim>::seed() {
  const Model<Dim>& model = setup_.model;
  mpm::Particles<Dim>& particles = slide_->particles;
  particles.affine_velocity.keep(model.motion.transfer == mpm::TransferKind::apic);
  particles.viscous_stress.keep(model.motion.viscous());
  keep_split_fields(model.splits_stretched, particles);
  particles.height_above_ground.keep(model.ground != nullptr);
  particles.ground_slope.keep(model.ground != nullptr);
  particles.linear_slope.keep(model.ground != nullptr);
  band::keep_fields(model.band, particles);
  const auto& materials = model.motion.materials;
  particles.gap.keep(std::any_of(materials.begin(), materials.end(), [](const auto& m) { return m.gaps_close_first; }));
  fill_bodies(setup_.parameters, setup_.site, model, particles);
  slide_->are_located = false;
  slide_->locate(model);  // the limits of a time step depend on the slope below the particles
  slide_->count_at_start = particles.size();
  slide_->next_id = static_cast<std::int64_t>(particles.size());
  slide_->split_count = 0;
  set_unsplit(particles);
  band::set_heat_content(model.band, particles);
  slide_->grid = make_grid(setup_.parameters, model);
}

template <int Dim>
void Simulation<Dim>::start_budget() {
  const BodySums<Dim> sums = sum_over_body();
  budget_ = {};
  budget_.initial_mechanical = sums.kinetic + sums.potential;
  budget_.initial_thermal = sums.sensible + sums.latent;
  budget_.initial_mass = sums.mass;
  budget_.initial_momentum = sums.momentum;
  bodies_at_start_ = sim::bodies_at_start(setup_.model, slide_->particles, setup_.cell());
}

template <int Dim>
void Simulation<Dim>::start_monitor() {
  removed_ = {};
  monitor_ = setup_.parameters.mechanics.enabled
                 ? monitor_at_start(setup_, *slide_, budget_, solver().sum_over_particles(monitor_kernel(setup_, 0.0)))
                 : RunMonitor{};
  monitor_.first_step = setup_.is_adaptive() ? adaptive_step() : 0.0;
}

template <int Dim>
band::SumsOfParticle<Dim> Simulation<Dim>::sums_of_particle() const {
  const Model<Dim>& model = setup_.model;
  return {model.motion.gravity,      model.origin,
          model.motion.phases,       setup_.parameters.heat.latent,
          model.band.melt_contracts, setup_.parameters.time.moved_distance};
}

template <int Dim>
MovedMass Simulation<Dim>::moved_mass() const {
  const BodySums<Dim> sums = sum_over_body();
  const auto all = static_cast<double>(sums.mass);
  double of_moved_bodies = all;
  for (std::size_t body = 0; body < bodies_at_start_.size(); ++body) {
    of_moved_bodies -= sums.moved_bodies.contains(body) ? 0.0 : bodies_at_start_[body].mass;
  }
  if (sums.moved_mass > mpm::fraction_ahead_of_front * of_moved_bodies && sums.moved_mass > 0.0) {
    return {false, of_moved_bodies, sums.moved_bodies, true};
  }
  MovedMass released{false, all, {}};
  for (std::size_t body = 0; body < bodies_at_start_.size(); ++body) {
    if (is_held(body)) {
      released.mass -= bodies_at_start_[body].mass;
    } else {
      released.bodies.add(body);
    }
  }
  return released.mass < all && released.mass > round_off * all ? released : MovedMass{true, all, {}};
}

template <int Dim>
mpm::PathSample Simulation<Dim>::front(const MovedMass& mass, const LineView& line) const {
  THAWSLIDE_ASSERT(particle_count() > 0, "the front of {} particles", particle_count());
  mpm::Transformation<Dim> path{line, {}, mass.all, mass.bodies};
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    path.origin[a] = setup_.model.origin[static_cast<int>(a)];
  }
  return solver().front(path, mass.mass);
}

template class Simulation<2>;
template class Simulation<3>;

}  // namespace thawslide::sim
