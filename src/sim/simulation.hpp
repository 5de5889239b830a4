// Simulation in memory: a case, its solver, the monitor, and the budget.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/clocks.hpp"
#include "base/error.hpp"
#include "device/solver_factory.hpp"
#include "sim/between_steps/monitor.hpp"
#include "sim/between_steps/removed_particles.hpp"
#include "sim/between_steps/run_failure.hpp"
#include "sim/between_steps/splitting.hpp"
#include "sim/setup/release_body.hpp"
#include "sim/solver/base.hpp"
#include "sim/solver/budget.hpp"
#include "sim/solver/cpu_solver.hpp"
#include "sim/solver/time_step.hpp"

namespace thawslide::sim {

// Mass that counts for front, runout and travel distance: bodies of which a part has moved by more than
// time.moved_distance; while no more than 0.5 % of their mass has moved that far, all bodies that are not held, or all
// if all are held.
struct MovedMass {
  bool all = true;    // bodies are not restricted to a set
  double mass = 0.0;  // of the bodies [kg]
  mpm::BodySet bodies{};
  bool has_moved = false;

  [[nodiscard]] bool has(std::size_t body) const { return all || bodies.contains(body); }
};

// Body at t = 0 along the x axis [m].
struct BodyAtStart {
  double mass = 0.0;       // [kg]; 0 without particles
  double direction = 1.0;  // in which it leaves, 1 or -1
  double lower = HUGE_VAL, upper = -HUGE_VAL;

  // Calls visit(number) for each number in a checkpoint, in order.
  template <class Visit>
  void for_each(const Visit& visit) {
    for (double* number : {&mass, &direction, &lower, &upper}) {
      visit(*number);
    }
  }
};

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
  [[nodiscard]] bool needs_settling() const {
    return setup_.parameters.mechanics.enabled &&
           setup_.parameters.mechanics.initial_stress == config::InitialStress::settle;
  }
  // Settles the initial stress; afterwards everything but the stress is as at the start. Does nothing if the case does
  // not request it. may_continue: called before each step; if it returns false, settling is aborted, false is returned,
  // and the run cannot continue. Throws RunError if a particle becomes invalid.
  bool settle(const std::function<bool()>& may_continue = [] { return true; });

  // Performs one time step of dt [s]. Throws RunError if a particle becomes invalid; the state is then that of the
  // failed step. strength: replaces the basal laws of the case; if it throws, the particles are those before the step,
  // which can be repeated.
  void step(double dt, const terrain::StrengthLaw* strength = nullptr);

  // Message if the last step left no particle, and the case removes leaving particles: no step can follow. The state is
  // that of this step and still contains the particles that left last; they count in no left_* column of the history.
  [[nodiscard]] const std::string& left_text() const { return left_text_; }

  // Performs all further steps on a device. A step throws DeviceError if the device fails.
  void use_device(const std::string& device, device::SolverFactory<Dim> make);

  // Appends particles between two steps, with new ids. They are in no band until the next step.
  void append(const std::vector<NewParticle<Dim>>& joining);

  // Next step [s]: the fixed one, or the largest adaptive one, shortened to end at `until` and when a body is released.
  // Throws RunError if the adaptive step becomes too small (guards.smallest_step, guards.most_steps).
  [[nodiscard]] double next_step(double until);

  // True until the release time of a body, given by its number.
  [[nodiscard]] bool is_held(std::size_t body) const {
    return sim::is_held(setup_.model.release_times, clock_.time, body);
  }

  // True if the slide is at rest (sim/between_steps/monitor.hpp). Also the criterion as text, and the time since when
  // it is met [s].
  [[nodiscard]] bool is_at_rest() const { return sim::is_at_rest(setup_, clock_, monitor_); }
  [[nodiscard]] std::string rest_rule() const { return sim::rest_rule(setup_); }
  [[nodiscard]] double rest_since() const { return monitor_.rest_since; }
  // True if the run ends at rest: the case requests it, and the slide has moved before. Also the time since when, as
  // text.
  [[nodiscard]] bool ends_at_rest() const {
    return setup_.parameters.time.stop_at_rest > 0.0 && monitor_.has_moved > 0.0 && is_at_rest();
  }
  [[nodiscard]] std::string rest_text() const {
    return sim::rest_text(setup_.parameters.time, moved_mass().has_moved, monitor_);
  }
  // Restarts the period of time.rest_time for a slide at rest.
  void restart_rest_time() { monitor_.rest_since = -1.0; }
  // Warning of slow unexplained energy growth by more than guards.energy_growth; empty if there is none.
  [[nodiscard]] std::string energy_warning() const {
    return sim::energy_warning(setup_.parameters.guards, clock_.time, monitor_);
  }
  [[nodiscard]] const Removed& removed() const { return removed_; }
  // Warning that mechanics.split_limit prevents further splitting; empty if it does not.
  [[nodiscard]] std::string split_warning() const { return sim::split_warning(setup_, *slide_, clock_.time); }
  // Number of particles that splitting has added.
  [[nodiscard]] std::int64_t split_count() const { return slide_->split_count; }

  // True if particles are outdated and no step can continue from them.
  [[nodiscard]] bool device_has_failed() const { return solver().has_failed(); }
  // Device that performs the steps; empty for the CPU.
  [[nodiscard]] std::string device_name() const { return solver().name(); }

  [[nodiscard]] const config::Case& parameters() const { return setup_.parameters; }
  [[nodiscard]] const config::Site& site() const { return setup_.site; }
  [[nodiscard]] const Model<Dim>& model() const { return setup_.model; }
  [[nodiscard]] double time() const { return clock_.time; }
  [[nodiscard]] double last_step() const { return clock_.last_step; }
  [[nodiscard]] std::int64_t step_number() const { return clock_.step_number; }
  // Callers that modify particles must not keep the reference over a step on a device. Those that modify positions must
  // not keep it over any step.
  [[nodiscard]] mpm::Particles<Dim>& particles() {
    solver().release();
    slide_->are_located = false;
    return slide_->particles;
  }
  [[nodiscard]] const mpm::Particles<Dim>& particles() const {
    solver().copy_particles_back();
    return slide_->particles;
  }
  [[nodiscard]] const mpm::SparseGrid<Dim>& grid() const {
    solver().sync_to_host();
    return slide_->grid;
  }
  [[nodiscard]] std::size_t particle_count() const { return slide_->particles.size(); }
  // Sums over all particles, in host or device memory (device/reductions.hpp).
  template <class Reduction>
  [[nodiscard]] typename Reduction::Sums sum_over_particles(const Reduction& reduction) const {
    return solver().sum_over_particles(reduction);
  }
  [[nodiscard]] BodySums<Dim> sum_over_body() const { return sum_over_particles(sums_of_particle()); }
  // Mass that counts for front, runout and travel distance.
  [[nodiscard]] MovedMass moved_mass() const;
  // Particle at the front of a mass along a line, or along the x axis if the line has no segments. At least one
  // particle must exist.
  [[nodiscard]] mpm::PathSample front(const MovedMass& mass, const LineView& line = {}) const;
  // As Solver::sample_map.
  [[nodiscard]] const band::MapSample* sample_map(const mpm::MapCells& cells) const {
    return solver().sample_map(cells);
  }
  // Nodes of a step on the CPU.
  [[nodiscard]] const mpm::Nodes<Dim>& nodes() const {
    THAWSLIDE_ASSERT(device_ == nullptr, "nodes are asked for, which {} keeps", device_->name());
    return cpu_.nodes();
  }
  // Of the last step; empty before the first one, also after settling.
  [[nodiscard]] MomentumOfNodes momentum_of_nodes() const {
    return clock_.step_number > 0 ? solver().momentum_of_nodes() : MomentumOfNodes{};
  }
  // Null without terrain.
  [[nodiscard]] const terrain::GroundOnGrid<Dim>* ground() const {
    return setup_.model.ground ? &slide_->ground : nullptr;
  }
  [[nodiscard]] const Budget<Dim>& budget() const { return budget_; }
  [[nodiscard]] const terrain::ContactWork<Dim>& contact() const { return sums_.contact; }
  // Null unless the band consists of columns. Copies all segments from a device.
  [[nodiscard]] const band::BaseColumns<Dim>* band_columns() const {
    solver().copy_columns_back();
    return base_.columns.get();
  }
  // Sums over the columns, in host or device memory; requires them.
  [[nodiscard]] band::BaseTotals base_totals() const { return solver().base_totals(); }
  // Of a step on the CPU; empty without band columns.
  [[nodiscard]] std::vector<band::SegmentBelow> segments_below() const {
    return base_.columns ? base_.columns->summaries() : std::vector<band::SegmentBelow>();
  }
  [[nodiscard]] bool has_band_columns() const { return base_.columns != nullptr; }
  void restore_band_columns(const std::vector<double>& state) { restore_columns(setup_, state, base_); }
  // Null without an erodible bed.
  [[nodiscard]] const terrain::Bed<Dim>* bed() const { return base_.bed ? &*base_.bed : nullptr; }
  void restore_bed(const std::vector<double>& state) { base_.bed->restore(state); }
  [[nodiscard]] const Stopwatch& stopwatch() const { return stopwatch_; }
  [[nodiscard]] const std::vector<BodyAtStart>& bodies_at_start() const { return bodies_at_start_; }
  [[nodiscard]] std::size_t particles_at_start() const { return slide_->count_at_start; }
  [[nodiscard]] StepLimit step_limit() const;

  // Steps between two sortings of particles in memory; results do not depend on it. 0: only at the start.
  void set_sorting_interval(int steps) { slide_->sorting_interval = steps; }

  // State for a checkpoint beyond the particles' fields, as numbers.
  [[nodiscard]] std::vector<double> scalars() const;
  // Restores this state for particles read from a checkpoint. Like restore_band_columns and restore_bed, throws
  // UserError for an impossible state.
  void restore(const std::vector<double>& scalars);

 private:
  [[nodiscard]] Solver<Dim>& solver() { return device_ ? *device_ : cpu_; }
  [[nodiscard]] const Solver<Dim>& solver() const { return device_ ? static_cast<const Solver<Dim>&>(*device_) : cpu_; }
  [[nodiscard]] band::SumsOfParticle<Dim> sums_of_particle() const;
  [[nodiscard]] FailureText<Dim> failure_text() const { return {setup_, *slide_, sum_over_body()}; }
  void seed();
  // Initializes everything that follows from positions and stress at t = 0.
  void begin();
  void start_budget();
  void start_monitor();
  [[nodiscard]] double adaptive_step() const;
  void stop_if_step_collapses(double dt) const;

  // After a step: ends the run, or removes or adds particles, if necessary.
  void monitor();
  void stop_for_or_remove_particles();
  void stop_if_invalid() const;
  void remove_marked();
  void entrain_bed();
  void split_stretched();

  Setup<Dim> setup_;
  std::unique_ptr<Slide<Dim>> slide_;  // with a device, const functions update the copy in host memory
  Base<Dim> base_;
  Clock clock_;
  Stopwatch stopwatch_;
  CpuSolver<Dim> cpu_;
  std::unique_ptr<Solver<Dim>> device_;  // null unless a device performs the steps
  StepSums<Dim> sums_;                   // of the last step
  Budget<Dim> budget_, budget_before_;   // current, and before the step
  RunMonitor monitor_;
  Removed removed_;
  mpm::InvalidParticle invalid_;
  Marks marks_;  // of the particles to be removed after a step
  std::string left_text_;
  std::vector<BodyAtStart> bodies_at_start_;
};

}  // namespace thawslide::sim
