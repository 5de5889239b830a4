// Simulation in memory: particles, grid and the step of Section 2.3.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "band/body_sums.hpp"
#include "band/flow_depth.hpp"
#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "config/case.hpp"
#include "device/solver_factory.hpp"
#include "mpm/motion.hpp"
#include "sim/budget.hpp"
#include "sim/model.hpp"
#include "sim/monitor.hpp"
#include "sim/moved_mass.hpp"
#include "sim/time_step.hpp"

// Declared only, so that users of a simulation do not compile them.
namespace thawslide::mpm {
template <int Dim>
class BodyContact;
struct MapCells;
}  // namespace thawslide::mpm
namespace thawslide::band {
template <int Dim>
class BasalSegments;
struct HeatGain;
}  // namespace thawslide::band
namespace thawslide::sim {

template <int Dim>
struct GridOfDevice;
template <int Dim>
struct BedOfDevice;

// Particle that joins a run; properties not listed here are those at t = 0.
template <int Dim>
struct NewParticle {
  std::int32_t body = 0, material = 0;                     // numbers, as in Model
  Vector<Real, Dim> position = Vector<Real, Dim>::Zero();  // relative to the domain's lower corner [m]
  Vector<Real, Dim> velocity = Vector<Real, Dim>::Zero();  // [m/s]
  Real volume = 0;                                         // [m3], per metre of width in 2D
  Real temperature = 0, porosity = 0;                      // [C], [1]
  Real flow_depth = 0;                                     // below the surface, normal to the ground [m]: loads the ice
  SymmetricTensor<Real> stress = SymmetricTensor<Real>::Zero();  // total [Pa]
  Real heat = 0;  // in addition to the heat content at its temperature [J]: it warms or melts the particle
};

// Thrown by a step that leaves no particle, if the case removes leaving particles. The state is that of this step and
// still contains the particles that left last; they count in no left_* column of the history.
class SlideLeft : public RunError {
 public:
  using RunError::RunError;
};

// Particle that is split in two, and half of the way between its halves.
template <int Dim>
struct Split {
  std::size_t particle = 0;  // in memory
  std::array<Vector<Real, Dim>, 2> positions;
  Vector<Real, Dim - 1> direction;  // along which it is halved

  [[nodiscard]] Vector<Real, Dim> half_way() const { return Real(0.5) * (positions[1] - positions[0]); }
};

using band::BodySums;

template <int Dim>
class Simulation {
 public:
  // Initializes particles at t = 0, not yet settled. site: contents of the map files of the case, required if the
  // terrain is a DEM. Throws UserError for a fixed step above a limit, and for insufficient memory, before any
  // allocation.
  explicit Simulation(const config::Case& parameters, const config::Site& site = {});
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  // True if the case applies gravity before t = 0, with damping and on a fixed base.
  [[nodiscard]] bool needs_settling() const;
  // Settles the initial stress; afterwards everything but the stress is as at the start. Does nothing if the case does
  // not request it. may_continue: called before each step; if it returns false, settling is aborted, false is returned,
  // and the run cannot continue. Throws RunError if a particle becomes invalid.
  bool settle(const std::function<bool()>& may_continue = [] { return true; });

  // Performs one time step of dt [s]. Throws RunError if a particle becomes invalid; the state is then that of the
  // failed step. strength: replaces the basal laws of the case on the CPU; if it throws, the particles are those before
  // the step, which can be repeated.
  void step(double dt, const terrain::StrengthLaw* strength = nullptr);

  // Performs all further steps on a device. Throws UserError, with the key, for features that no device supports; a
  // step throws DeviceError if the device fails.
  void use_device(const std::string& device, device::SolverFactory<Dim> make);

  // Appends particles between two steps, with new ids. They are in no band until the next step.
  void append(const std::vector<NewParticle<Dim>>& joining);

  // Next step [s]: the fixed one, or the largest adaptive one, shortened to end at `until` and when a body is released.
  // Throws RunError if the adaptive step becomes too small (guards.smallest_step, guards.most_steps).
  [[nodiscard]] double next_step(double until);

  // True until the release time of a body, given by its number.
  [[nodiscard]] bool is_held(std::size_t body) const;

  // True if the slide is at rest: for time.rest_time, at most moving_fraction_at_rest of the mass has been faster than
  // time.stop_at_rest or, by default, usual_rest_speed (sim/monitor.hpp). Also the criterion as text, and the time
  // since when it is met [s].
  [[nodiscard]] bool is_at_rest() const;
  [[nodiscard]] std::string rest_rule() const;
  [[nodiscard]] double rest_since() const { return monitor_.rest_since; }
  // True if the run ends at rest: the case requests it, and the slide has moved before. Also the time since when, as
  // text.
  [[nodiscard]] bool ends_at_rest() const;
  [[nodiscard]] std::string rest_text() const;
  // Restarts the period of time.rest_time for a slide at rest.
  void restart_rest_time();
  // Warning of slow unexplained energy growth by more than guards.energy_growth; empty if there is none.
  [[nodiscard]] std::string energy_warning() const;
  [[nodiscard]] const Removed& removed() const { return removed_; }
  // Warning that mechanics.split_limit prevents further splitting; empty if it does not.
  [[nodiscard]] std::string split_warning() const;
  // Number of particles that splitting has added.
  [[nodiscard]] std::int64_t split_count() const { return split_count_; }

  // True if particles are outdated and no step can continue from them.
  [[nodiscard]] bool device_has_failed() const { return device_has_failed_; }
  // Device that performs the steps; empty for the CPU.
  [[nodiscard]] const std::string& device_name() const { return device_name_; }

  [[nodiscard]] const config::Case& parameters() const { return parameters_; }
  [[nodiscard]] const config::Site& site() const { return site_; }
  [[nodiscard]] const Model<Dim>& model() const { return model_; }
  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] double last_step() const { return last_step_; }
  [[nodiscard]] std::int64_t step_number() const { return step_number_; }
  // Callers that modify particles must not keep the reference over a step on a device. Those that modify positions must
  // not keep it over any step.
  [[nodiscard]] mpm::Particles<Dim>& particles() {
    release_device();
    are_particles_located_ = false;
    return particles_;
  }
  [[nodiscard]] const mpm::Particles<Dim>& particles() const {
    copy_particles_back();
    return particles_;
  }
  [[nodiscard]] const mpm::SparseGrid<Dim>& grid() const {
    sync_to_host();
    return grid_;
  }
  [[nodiscard]] std::size_t particle_count() const { return particles_.size(); }
  // Sums over all particles, in host or device memory, or over marked ones, by particle.
  [[nodiscard]] BodySums<Dim> sum_over_body() const;
  [[nodiscard]] BodySums<Dim> sum_over_marked(const std::vector<std::uint8_t>& marked) const;
  // Mass that counts for front, runout and travel distance.
  [[nodiscard]] MovedMass moved_mass() const;
  // Particle at the front of a mass along a line, or along the x axis if the line has no segments. At least one
  // particle must exist.
  [[nodiscard]] mpm::PathSample front(const MovedMass& mass, const LineView& line = {}) const;
  // Map sums of a step on a device; null after a step on the CPU.
  [[nodiscard]] const device::MapSample* sample_map(const mpm::MapCells& cells) const;
  // Nodes of a step on the CPU.
  [[nodiscard]] const mpm::Nodes<Dim>& nodes() const {
    THAWSLIDE_ASSERT(device_name_.empty(), "nodes are asked for, which {} keeps", device_name_);
    return nodes_;
  }
  // Null without terrain.
  [[nodiscard]] const terrain::GroundOnGrid<Dim>* ground() const { return model_.ground ? ground_.get() : nullptr; }
  [[nodiscard]] const Budget<Dim>& budget() const { return budget_; }
  [[nodiscard]] const terrain::ContactWork<Dim>& contact() const { return contact_; }
  // Null unless the band consists of columns.
  [[nodiscard]] const band::BasalSegments<Dim>* band_columns() const { return band_columns_.get(); }
  void restore_band_columns(const std::vector<double>& state);
  // Null without an erodible bed.
  [[nodiscard]] const terrain::Bed<Dim>* bed() const { return bed_ ? &*bed_ : nullptr; }
  void restore_bed(const std::vector<double>& state) { bed_->restore(state); }
  [[nodiscard]] const Stopwatch& stopwatch() const { return stopwatch_; }
  [[nodiscard]] const std::vector<BodyAtStart>& bodies_at_start() const { return bodies_at_start_; }
  [[nodiscard]] std::size_t particles_at_start() const { return particles_at_start_; }
  [[nodiscard]] StepLimit step_limit() const;

  // Steps between two sortings of particles in memory; results do not depend on it. 0: only at the start.
  void set_sorting_interval(int steps) { sorting_interval_ = steps; }

  // State for a checkpoint beyond the particles' fields, as numbers.
  [[nodiscard]] std::vector<double> scalars() const;
  // Restores this state for particles read from a checkpoint. Like restore_band_columns and restore_bed, throws
  // UserError for an impossible state.
  void restore(const std::vector<double>& scalars);

 private:
  // The step on a device (step_on_device.cpp).
  void advance_on_device();
  void on_device(const std::function<void()>& work) const;
  // Copies the particles to the device unless they are there.
  void start_on_device();
  [[nodiscard]] device::StepSums<Dim> step_on_device();
  // Copies particles from the device, where they remain; sync_to_host() also updates the grid to their positions.
  void copy_particles_back() const;
  void sync_to_host() const;
  // The same; the next step on the device begins with the host's particles.
  void release_device();
  [[nodiscard]] BodySums<Dim> sum_over_particles(const std::uint8_t* marked) const;
  [[nodiscard]] band::SumsOfParticle<Dim> sums_of_particle() const;
  [[nodiscard]] bool any_has_left(const std::vector<Vector<Real, Dim>>& points) const;
  // True if a device performed the step and no particle is invalid or has left: the device counts them.
  [[nodiscard]] bool needs_no_host_check() const;

  // Adds the terms of a step to the budget (step_budget.cpp).
  void add_contact_energy();
  void add_bed_energy();
  void add_stress_work(const mpm::StressWork& work);
  void add_heat_gain(const band::HeatGain& gain);

  // The stages of a step, in order (simulation.cpp).
  [[nodiscard]] double time_after(double dt);
  void step_on_cpu(const terrain::StrengthLaw* strength);
  void post_step();
  // Assigns held bodies to separate layers of the grid (release_stages.cpp).
  void update_layers();
  // Time of the next release [s]; infinite if no body is held.
  [[nodiscard]] double next_release() const;
  void find_particles_cells();
  void update_ground() const;
  // Updates the heights of particles above the ground.
  void locate_particles() const;
  void momentum_to_grid();
  void average_band_on_grid(bool reads_mass);
  void press_on_ground(bool reads_mass);
  void resolve_contact(const terrain::StrengthLaw* strength);
  void move_particles();
  void update_stress_and_porosity();
  void conduct_heat();
  void drain_pore_pressure();
  void update_positions();
  void monitor();
  void stop_for_or_remove_particles();
  void mark_invalid_particles();
  void mark_left_particles();
  void remove_marked_particles();
  // Null without an erodible bed, and while the base is fixed.
  [[nodiscard]] const terrain::Bed<Dim>* bed_in_reach() const { return model_.contact.base_is_fixed ? nullptr : bed(); }
  const terrain::Bed<Dim>* bed_to_meet();
  void collect_bed();
  void entrain_bed();
  // Splits stretched particles (splitting.cpp).
  void split_stretched();
  void split(const std::vector<Split<Dim>>& due);
  [[nodiscard]] std::int64_t most_splits() const;
  [[nodiscard]] std::vector<Split<Dim>> splits_due() const;
  [[nodiscard]] std::optional<Split<Dim>> split_of(std::size_t particle) const;
  [[nodiscard]] Real energy_gained(const Split<Dim>& split) const;

  void seed();
  // Initializes everything that follows from positions and stress at t = 0.
  void begin();
  void start_monitor();
  [[nodiscard]] mpm::MonitorSums monitor_sums() const;
  void stop_if_energy_grows(const mpm::MonitorSums& seen);
  void update_rest(const mpm::MonitorSums& seen);
  void add_removed_particles();
  void correct_energy_for_removal();
  [[nodiscard]] band::StepExtremes extremes() const;
  [[nodiscard]] double adaptive_step() const;
  void stop_if_step_collapses(double dt) const;
  [[nodiscard]] std::size_t index_in_memory(std::int64_t id) const;
  [[nodiscard]] Vector<double, Dim> position_of(std::size_t particle) const;
  [[nodiscard]] std::string particle_text(std::size_t particle) const;
  [[nodiscard]] std::string fault_text(std::size_t particle) const;
  [[nodiscard]] bool is_too_soft(std::size_t particle) const;
  [[nodiscard]] std::string step_to_halve() const;
  [[nodiscard]] std::string cause_in_material(std::size_t particle) const;
  [[noreturn]] void stop_for_energy(double growth, double fraction) const;
  [[noreturn]] void stop_for_removed_mass(double fraction);
  [[nodiscard]] std::string likely_cause(std::size_t particle) const;
  [[nodiscard]] std::string terrain_ahead(std::size_t particle) const;
  void mark_band();
  void update_columns();
  void update_normal_load(std::size_t first = 0);
  void rescale_band();
  void start_band_columns();
  void band_columns_follow(const mpm::SparseGrid<Dim>& grid, const terrain::GroundOnGrid<Dim>& ground,
                           mpm::Nodes<Dim>& nodes);
  // Callbacks of a device for band columns (columns_of_device.cpp).
  [[nodiscard]] device::HostColumns host_columns();
  // Callbacks of a device for the erodible bed (bed_of_device.cpp).
  [[nodiscard]] device::HostBed<Dim> host_bed();
  void start_ledger();
  [[nodiscard]] std::vector<Vector<double, Dim - 1>> places_below_slide(
      const std::vector<typename terrain::Bed<Dim>::Column>& columns) const;
  [[nodiscard]] NewParticle<Dim> particle_of_bed(Vector<double, Dim - 1> point,
                                                 const terrain::LooseMaterial<Dim>& material,
                                                 std::int64_t number) const;
  void stop_if_invalid();
  [[nodiscard]] double band_thickness() const { return parameters_.band.thickness.at(time_); }

  config::Case parameters_;
  config::Site site_;
  Model<Dim> model_;
  // With a device, these are copies of the last synchronization, which does not change the logical state.
  mutable mpm::Particles<Dim> particles_;
  mutable mpm::SparseGrid<Dim> grid_;
  std::unique_ptr<terrain::GroundOnGrid<Dim>> ground_;
  mpm::Nodes<Dim> nodes_;
  device::SolverFactory<Dim> make_solver_;  // empty: steps on the CPU
  // Null if particles have changed on the host since, or the device has failed.
  mutable std::unique_ptr<device::Solver<Dim>> device_solver_;
  std::unique_ptr<device::StepSums<Dim>> device_sums_;  // of its last step
  terrain::ContactWork<Dim> contact_;
  Budget<Dim> budget_, budget_before_;             // current, and before the step
  std::unique_ptr<device::MapSample> map_sample_;  // of the last step
  std::string device_name_;
  band::FlowDepth<Dim> flow_depth_;
  std::unique_ptr<band::BasalSegments<Dim>> band_columns_;  // null unless the band consists of columns
  std::unique_ptr<GridOfDevice<Dim>> grid_of_device_;       // as band columns read it; null without band columns
  std::optional<terrain::Bed<Dim>> bed_;
  std::unique_ptr<BedOfDevice<Dim>> bed_of_device_;      // null without a bed below a device step
  std::unique_ptr<mpm::BodyContact<Dim>> body_contact_;  // null if all bodies share nodes
  RunMonitor monitor_;
  Removed removed_;
  mpm::InvalidParticle invalid_;
  std::vector<std::uint8_t> marks_;  // by particle: those to be removed
  std::vector<BodyAtStart> bodies_at_start_;
  Stopwatch stopwatch_;
  double time_ = 0.0, last_step_ = 0.0, current_band_thickness_ = -1.0,
         column_time_ = 0.0;  // since the last step of the band columns
  std::int64_t step_number_ = 0, next_id_ = 0, split_count_ = 0;
  // Clock of fixed steps of one size: that size, and the time and step number when the first of them began.
  struct FixedStepClock {
    double step = 0.0, from_time = 0.0;
    std::int64_t from_number = 0;
  } fixed_step_clock_;
  std::size_t particles_at_start_ = 0;
  int sorting_interval_ = 64;
  mutable bool host_particles_valid_ = true, host_grid_valid_ = true, device_has_failed_ = false;
  mutable bool are_particles_located_ = false;  // above the ground
  Real dt_ = 0, force_of_walls_ = 0;            // of the step; force along x [N]
};

}  // namespace thawslide::sim
