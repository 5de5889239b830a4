// A run in memory: particles, grid and the step of Section 2.3.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "band/basal_segments.hpp"
#include "band/body_sums.hpp"
#include "band/heat.hpp"
#include "band/pore_pressure.hpp"
#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "config/case.hpp"
#include "device/solver.hpp"
#include "mpm/front.hpp"
#include "mpm/motion.hpp"
#include "sim/bed_of_device.hpp"
#include "sim/grid_of_device.hpp"
#include "sim/ledger.hpp"
#include "sim/model.hpp"
#include "sim/monitor.hpp"
#include "sim/time_step.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::mpm {
template <int Dim, class Real>
class BodyContact;
}  // namespace thawslide::mpm

namespace thawslide::sim {

// A particle that joins a run; what is not told of it is as for one at t = 0.
template <int Dim, class Real>
struct NewParticle {
  std::int32_t body = 0, material = 0;                     // numbers, as in Model
  Vector<Real, Dim> position = Vector<Real, Dim>::Zero();  // relative to the domain's lower corner [m]
  Vector<Real, Dim> velocity = Vector<Real, Dim>::Zero();  // [m/s]
  Real volume = 0;                                         // [m3], per metre of width in 2D
  Real temperature = 0, porosity = 0;                      // [C], [1]
  Real flow_depth = 0;                                     // below the surface across the ground [m]: what ice bears
  SymmetricTensor<Real> stress = SymmetricTensor<Real>::Zero();  // total [Pa]
  Real heat = 0;  // that it has beyond what its temperature says [J]: it warms or melts it
};

using band::BodySums;

template <int Dim, class Real>
class Simulation {
 public:
  // Particles at t = 0, not yet settled. site: what the map files of the case hold, needed where the terrain is a DEM.
  // Throws UserError for a fixed step above a limit, and for what does not fit into memory, before any of it is made.
  explicit Simulation(const config::Case& parameters, const config::Site& site = {});
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  // Whether the case asks for gravity to be switched on before t = 0, with damping and on a base that holds.
  [[nodiscard]] bool needs_settling() const;
  // Does that; then everything but the stress is as at the start. Nothing happens in a case that does not ask for it.
  // goes_on: asked before each step; once it says no, false is returned, and there is no run to go on with. Throws
  // RunError if a particle becomes invalid.
  bool settle(const std::function<bool()>& goes_on = [] { return true; });

  // One time step of dt [s]. Throws RunError if a particle becomes invalid; the state is then that of the failed step.
  void step(double dt);

  // From now on steps are taken on a device. Throws UserError, with the key, for what no device does yet; a step throws
  // DeviceError where the device fails.
  void use_device(const std::string& device, device::SolverFactory<Dim, Real> make);

  // Particles join between two steps, with ids that none has had. They are in no band until the next step.
  void append(const std::vector<NewParticle<Dim, Real>>& joining);

  // The step to take next [s]: the fixed one, or the largest adaptive one, shortened to end at `until`. Throws RunError
  // for an adaptive step too short to go on with (guards.smallest_step, guards.most_steps).
  [[nodiscard]] double next_step(double until) const;

  // Whether the slide is at rest: for time.rest_time no more than the stray share has been faster than
  // time.stop_at_rest or, where that is not given, the usual speed (sim/monitor.hpp). The rule in words; and since when
  // it holds [s].
  [[nodiscard]] bool is_at_rest() const;
  [[nodiscard]] std::string rest_rule() const;
  [[nodiscard]] double rest_since() const { return monitor_.rest_since; }
  // Whether the run ends for it: the case asks for that, and the slide has moved before. Since when, in words.
  [[nodiscard]] bool ends_at_rest() const;
  [[nodiscard]] std::string rest_text() const;
  // What has come to rest is to rest for time.rest_time once more.
  void restart_rest_time();
  // What is to be said of energy that came slowly and without a cause, by more than guards.energy_growth; empty:
  // nothing.
  [[nodiscard]] std::string energy_warning() const;
  [[nodiscard]] const Removed& removed() const { return removed_; }

  // Particles then are not those of now, and no step goes on from them.
  [[nodiscard]] bool device_has_failed() const { return device_has_failed_; }
  // That takes the steps; empty: the processor.
  [[nodiscard]] const std::string& device_name() const { return device_name_; }

  [[nodiscard]] const config::Case& parameters() const { return parameters_; }
  [[nodiscard]] const config::Site& site() const { return site_; }
  [[nodiscard]] const Model<Dim, Real>& model() const { return model_; }
  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] double last_step() const { return last_step_; }
  [[nodiscard]] std::int64_t step_number() const { return step_number_; }
  // Who may change them must not keep the reference over a step that a device takes.
  [[nodiscard]] mpm::Particles<Dim, Real>& particles() {
    release_device();
    return particles_;
  }
  [[nodiscard]] const mpm::Particles<Dim, Real>& particles() const {
    copy_particles_back();
    return particles_;
  }
  [[nodiscard]] const mpm::SparseGrid<Dim, Real>& grid() const {
    sync_to_host();
    return grid_;
  }
  [[nodiscard]] std::size_t particle_count() const { return particles_.size(); }
  // Over all particles, wherever they stand, or over the marked ones, by particle.
  [[nodiscard]] BodySums<Dim, Real> sum_over_body() const;
  [[nodiscard]] BodySums<Dim, Real> sum_over_marked(const std::vector<std::uint8_t>& marked) const;
  // The particle at the front along a line, or along the x axis where the line has no segments. There must be one.
  [[nodiscard]] mpm::PathSample front(const LineView& line = {}) const;
  // What maps take of a step that a device took; null after one of the processor.
  [[nodiscard]] const device::MapSample* sample_map(const mpm::MapCells& cells) const;
  // Of a step of the processor.
  [[nodiscard]] const mpm::Nodes<Dim, Real>& nodes() const {
    THAWSLIDE_ASSERT(device_name_.empty(), "nodes are asked for, which {} keeps", device_name_);
    return nodes_;
  }
  // Null without terrain.
  [[nodiscard]] const terrain::GroundOnGrid<Dim, Real>* ground() const { return model_.ground ? &ground_ : nullptr; }
  [[nodiscard]] const Ledger<Dim, Real>& ledger() const { return ledger_; }
  [[nodiscard]] const terrain::ContactWork<Dim, Real>& contact() const { return contact_; }
  // Null where the band is not of columns.
  [[nodiscard]] const band::BasalSegments<Dim, Real>* band_columns() const {
    return band_columns_ ? &*band_columns_ : nullptr;
  }
  void restore_band_columns(const std::vector<double>& state);
  // Null where there is none that is erodible.
  [[nodiscard]] const terrain::Bed<Dim, Real>* bed() const { return bed_ ? &*bed_ : nullptr; }
  void restore_bed(const std::vector<double>& state) { bed_->restore(state); }
  [[nodiscard]] const Stopwatch& stopwatch() const { return stopwatch_; }
  [[nodiscard]] double rear_at_start() const { return rear_at_start_; }
  [[nodiscard]] std::size_t particles_at_start() const { return particles_at_start_; }
  [[nodiscard]] StepLimit step_limit() const;

  // How many steps particles keep their place in memory; results do not depend on it.
  // 0: only at the start.
  void set_sorting_interval(int steps) { sorting_interval_ = steps; }

  // Everything a checkpoint must hold beyond the particles' fields, as numbers; and its way back.
  [[nodiscard]] std::vector<double> scalars() const;
  // To the particles that a checkpoint gave back. This, and restore_band_columns and restore_bed, throw UserError for a
  // state that no run has.
  void restore(const std::vector<double>& scalars);

 private:
  // The step on a device (step_on_device.cpp).
  void advance_on_device();
  void on_device(const std::function<void()>& work) const;
  [[nodiscard]] device::StepSums<Dim, Real> step_on_device();
  // Where particles stand on a device, copies them; they stay there. And brings the grid to where they are.
  void copy_particles_back() const;
  void sync_to_host() const;
  // The same, and the next step on the device begins with those of the processor.
  void release_device();
  [[nodiscard]] BodySums<Dim, Real> sum_over_particles(const std::uint8_t* marked) const;
  [[nodiscard]] band::SumsOfParticle<Dim, Real> sums_of_particle() const;
  [[nodiscard]] bool any_has_left(const std::vector<Vector<Real, Dim>>& places) const;
  // Whether a device took the step, and no particle is bad or has left: it is asked where strays are.
  [[nodiscard]] bool needs_no_host_check() const;

  // What a step did goes to the accounts (step_accounts.cpp).
  void add_contact_energy();
  void add_bed_energy();
  void add_stress_work(const mpm::StressWork<Real>& work);
  void add_heat_gain(const band::HeatGain<Real>& gain);

  // The stages of a step, in order (simulation.cpp).
  [[nodiscard]] double time_after(double dt);
  void step_on_cpu();
  void post_step();
  void find_particles_cells();
  void update_ground() const;
  void momentum_to_grid();
  void average_band_on_grid();
  void press_on_ground();
  void resolve_contact();
  void move_particles();
  void update_stress_and_porosity();
  void conduct_heat();
  void drain_pore_pressure();
  void update_positions();
  void watch();
  void stop_for_or_remove_particles();
  void mark_invalid_particles();
  void mark_left_particles();
  void remove_marked_particles();
  // Null where there is none, and while the base holds.
  [[nodiscard]] const terrain::Bed<Dim, Real>* bed_in_reach() const {
    return model_.contact.base_holds ? nullptr : bed();
  }
  const terrain::Bed<Dim, Real>* bed_to_meet();
  void collect_bed();
  void entrain_bed();

  void seed();
  // Everything that follows from positions and stress at t = 0.
  void begin();
  void start_monitor();
  [[nodiscard]] mpm::MonitorSums<Real> monitor_sums() const;
  void stop_if_energy_grows(const mpm::MonitorSums<Real>& seen);
  void update_rest(const mpm::MonitorSums<Real>& seen);
  void add_removed_particles();
  void correct_energy_for_removal();
  [[nodiscard]] band::StepExtremes extremes() const;
  [[nodiscard]] double adaptive_step() const;
  void stop_if_step_collapses(double dt) const;
  [[nodiscard]] std::size_t place_in_memory(std::int64_t id) const;
  [[nodiscard]] Vector<double, Dim> place_of(std::size_t particle) const;
  [[nodiscard]] std::string particle_text(std::size_t particle) const;
  [[nodiscard]] std::string fault_text(std::size_t particle) const;
  [[nodiscard]] bool is_too_soft(std::size_t particle) const;
  [[nodiscard]] std::string step_to_halve() const;
  [[nodiscard]] std::string cause_in_material(std::size_t particle) const;
  [[noreturn]] void stop_for_energy(double growth, double share) const;
  [[noreturn]] void stop_for_removed_mass(double share);
  [[nodiscard]] std::string likely_cause(std::size_t particle) const;
  [[nodiscard]] std::string terrain_ahead(std::size_t particle) const;
  void mark_band();
  void update_columns();
  void update_normal_load(std::size_t first = 0);
  void rescale_band();
  void start_band_columns();
  void band_columns_follow(const mpm::SparseGrid<Dim, Real>& grid, const terrain::GroundOnGrid<Dim, Real>& ground,
                           mpm::Nodes<Dim, Real>& nodes);
  // Where a device takes the steps (columns_of_device.cpp).
  [[nodiscard]] device::HostColumns<Real> host_columns();
  // The same (bed_of_device.cpp).
  [[nodiscard]] device::HostBed<Dim, Real> host_bed();
  void start_ledger();
  [[nodiscard]] std::vector<Vector<double, Dim - 1>> places_below_slide(
      const std::vector<typename terrain::Bed<Dim, Real>::Column>& columns) const;
  [[nodiscard]] NewParticle<Dim, Real> particle_of_bed(Vector<double, Dim - 1> place,
                                                       const terrain::LooseMaterial<Dim, Real>& material,
                                                       std::int64_t number) const;
  void stop_if_invalid();
  [[nodiscard]] double band_thickness() const;

  config::Case parameters_;
  config::Site site_;
  Model<Dim, Real> model_;
  // Where a device takes the steps these are what was brought back last: how they are brought back is no change.
  mutable mpm::Particles<Dim, Real> particles_;
  mutable mpm::SparseGrid<Dim, Real> grid_;
  mutable terrain::GroundOnGrid<Dim, Real> ground_;
  mpm::Nodes<Dim, Real> nodes_;
  device::SolverFactory<Dim, Real> make_solver_;  // empty: the processor takes the steps
  // Null: particles have changed here since, or the device has failed.
  mutable std::unique_ptr<device::Solver<Dim, Real>> device_solver_;
  device::StepSums<Dim, Real> device_sums_;  // of its last step
  mutable device::MapSample map_sample_;     // the last one
  std::string device_name_;
  band::FlowDepth<Dim, Real> flow_depth_;
  std::optional<band::BasalSegments<Dim, Real>> band_columns_;
  std::unique_ptr<GridOfDevice<Dim, Real>> grid_of_device_;  // as band columns see it; null: none do
  std::optional<terrain::Bed<Dim, Real>> bed_;
  std::unique_ptr<BedOfDevice<Dim, Real>> bed_of_device_;  // null: it lies below no step of a device
  terrain::ContactWork<Dim, Real> contact_;
  std::unique_ptr<mpm::BodyContact<Dim, Real>> body_contact_;  // null: all bodies share nodes
  Ledger<Dim, Real> ledger_, ledger_before_;                   // of now, and before the step
  RunMonitor monitor_;
  Removed removed_;
  mpm::InvalidParticle invalid_;
  std::vector<std::uint8_t> marks_;  // by particle, of those that are to be removed
  Stopwatch stopwatch_;
  double time_ = 0.0, last_step_ = 0.0, rear_at_start_ = 0.0, current_band_thickness_ = -1.0,
         column_time_ = 0.0;  // since the last step of the band columns
  std::int64_t step_number_ = 0, next_id_ = 0;
  // Fixed steps of one size: that size, and the time and the number of steps when the first of them began.
  struct FixedStepClock {
    double step = 0.0, from_time = 0.0;
    std::int64_t from_number = 0;
  } fixed_step_clock_;
  std::size_t particles_at_start_ = 0;
  int sorting_interval_ = 64;
  mutable bool host_particles_valid_ = true, host_grid_valid_ = true, device_has_failed_ = false;
  Real dt_ = 0, force_of_walls_ = 0;  // of the step, the latter along x [N]
};

}  // namespace thawslide::sim
