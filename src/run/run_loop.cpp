#include "run/run_loop.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "base/text.hpp"
#include "base/thread_choice.hpp"
#include "io/checkpoint.hpp"
#include "run/block_model.hpp"
#include "run/step_warnings.hpp"
#include "sim/direction.hpp"
#include "sim/records/history.hpp"

namespace thawslide::run {

namespace {

// Settles the body if required. If this fails, files are written as for any failed run. False if it was interrupted.
template <int Dim>
bool settle(sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, Observer& observer) {
  if (!simulation.needs_settling()) {
    return true;
  }
  observer.line("settling under gravity for {:g} s", simulation.parameters().mechanics.settle_time);
  try {
    return simulation.settle([&] { return observer.interruption().empty(); });
  } catch (const RunError& error) {
    output.write_first_state(simulation);
    output.write_index();
    output.write_provenance(simulation, "failed", error.what(), 0.0);
    throw;
  }
}

// Ends a run after a failed write or a GPU error: all files are intact, and it can resume from its last checkpoint.
template <int Dim>
ExitCode end_at_once(const sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, const std::exception& error,
                     ExitCode code, const std::filesystem::path& folder, Observer& observer) {
  try {
    output.require_own_folder();
  } catch (const WriteError& lost) {
    observer.error_line("error: {}\nstopped at t = {:g} s", lost.what(), simulation.time());
    return code;
  }
  try {
    output.write_provenance(simulation, "stopped", error.what(), output.wall_seconds());
  } catch (const WriteError&) {  // NOLINT(bugprone-empty-catch): the first error is reported below
  }
  observer.error_line("error: {}\nstopped at t = {:g} s. All files are intact: `thawslide resume {}` {}", error.what(),
                      simulation.time(), shell_quote(folder.string()),
                      io::has_checkpoint(folder) ? "continues from the last checkpoint" : "starts it again");
  return code;
}

// Returns the result of work(), or ends the run after an error that leaves its files intact.
template <int Dim, class Work>
ExitCode with_errors_reported(const sim::Simulation<Dim>& simulation, RunOutput<Dim>& output,
                              const std::filesystem::path& folder, Observer& observer, const Work& work) {
  const auto end = [&](const std::exception& error, ExitCode code) {
    return end_at_once<Dim>(simulation, output, error, code, folder, observer);
  };
  try {
    return work();
  } catch (const WriteError& error) {
    return end(error, ExitCode::not_written);
  } catch (const DeviceError& error) {
    return end(error, ExitCode::device_failed);
  } catch (const std::bad_alloc&) {
    return end(UserError("the memory of this machine, or its limit (ulimit -v), was exhausted during the run"),
               ExitCode::user_mistake);
  }
}

// Key figure of run.json in the summary; per metre of width in 2D without case.width if it is extensive.
struct ShownFigure {
  const char* name;  // in run.json
  const char* label;
  const char* unit;
  double factor = 1.0;
  bool is_extensive = false;
};
constexpr ShownFigure shown_figures[] = {
    {.name = "rest_since_s", .label = "at rest since", .unit = "s"},
    {.name = "dilation_volume_m3", .label = "volume change by dilation", .unit = "m3", .is_extensive = true},
    {.name = "dilation_fraction", .label = "relative volume change", .unit = "%", .factor = 100.0},
    {.name = "left_mass_kg", .label = "mass of removed particles", .unit = "kg", .is_extensive = true},
    {.name = "covered_volume_m3", .label = "covered volume", .unit = "m3"},
    {.name = "covered_area_m2", .label = "covered area", .unit = "m2"},
    {.name = "affected_area_m2", .label = "affected area", .unit = "m2"},
    {.name = "deposit_area_m2", .label = "deposit area", .unit = "m2"},
    {.name = "inundated_area_m2", .label = "inundated area", .unit = "m2"},
    {.name = "front_distance_m", .label = "front position along the path", .unit = "m"},
    {.name = "travel_distance_m", .label = "travel distance", .unit = "m"},
    {.name = "drop_height_m", .label = "drop height", .unit = "m"},
    {.name = "reach_angle_degrees", .label = "reach angle", .unit = "degrees"}};

// Final position of the front as text.
std::string front_text(double front, double runout) {
  return std::isfinite(front) ? fmt::format("front at {:.0f} m, runout {:.0f} m", front, runout)
                              : "no front: maps.path is not set, and the slide has barely moved";
}

// Reports throughput, position of the slide, key figures and warnings; steps, wall [s]: of this process.
template <int Dim>
void report_summary(const sim::Simulation<Dim>& simulation, const RunOutput<Dim>& output, std::int64_t steps,
                    double wall, const std::filesystem::path& folder, Observer& observer) {
  const std::size_t at_start = output.provenance().particles, at_end = simulation.particles().size();
  observer.line("{} particles{}, {} steps in {}: {:.3g} million particle-steps per second on {}{} thread{}",
                count_text(static_cast<double>(at_start)),
                at_end == at_start ? "" : fmt::format(", {} at the end", count_text(static_cast<double>(at_end))),
                count_text(static_cast<double>(steps)), duration_text(wall),
                output.provenance().parts.back().particle_steps / wall / 1e6, thread_count() == 1 ? "" : "at most ",
                thread_count(), thread_count() == 1 ? "" : "s");
  const sim::HistoryRow row = output.history_row(simulation);
  const auto value = [&](const std::string& name) { return value_of(row, name); };
  observer.line("{}: mean velocity {:.2f} m/s, mean displacement {:.0f} m, {}", sim::when_text(output.end_state()),
                value("mean_velocity_m_s"), value("mean_displacement_m"),
                front_text(value("front_position_m"), value("runout_m")));
  const bool is_per_metre = Dim == 2 && !(simulation.parameters().general.width.reference() > 0.0);
  for (const auto& figure : output.provenance().figures) {
    const auto* const shown = std::find_if(std::begin(shown_figures), std::end(shown_figures),
                                           [&](const ShownFigure& each) { return figure.first == each.name; });
    if (shown != std::end(shown_figures) && std::isfinite(figure.second)) {
      observer.line("  {:<30}{:>12} {}{}", shown->label, rounded_text(shown->factor * figure.second, 3), shown->unit,
                    is_per_metre && shown->is_extensive ? " per metre of width" : "");
    }
  }
  if (simulation.removed().by_guards() > 0) {
    observer.line("guards have removed {}", sim::text_of(simulation.removed()));
  }
  observer.texts("warning: ", output.provenance().warnings);
  observer.line("results in {}", folder.string());
}

// Time loop of one process, with its output.
template <int Dim>
class Loop {
 public:
  using Simulation = sim::Simulation<Dim>;

  Loop(Simulation& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder, Observer& observer)
      : simulation_(simulation),
        output_(output),
        folder_(folder),
        observer_(observer),
        times_(simulation.parameters().time),
        first_step_(simulation.step_number()),
        history_(history_schedule(times_, simulation.time(), simulation.last_step())),
        snapshots_(snapshot_schedule(times_, simulation.time(), simulation.last_step())),
        checkpoints_(simulation.parameters().checkpoint.interval > 0.0 ? simulation.parameters().checkpoint.interval
                                                                       : times_.end,
                     simulation.time(), simulation.last_step(), times_.end),
        warnings_(simulation),
        most_threads_(thread_count()),
        threads_(most_threads_, 0.0) {
    output_.start_clock();
  }

  // Throws RunError if the run failed. All results so far have been written then, too.
  ExitCode run() {
    observer_.start(simulation_.time());
    try {
      while (must_continue()) {
        step();
        if (!simulation_.left_text().empty()) {
          return end_without_particles();
        }
        write_due_output();
        if (observer_.wants_progress(simulation_.time(), times_.end)) {
          report_progress();
        }
      }
    } catch (const RunError& error) {
      write_last_state();
      close("failed", error.what());
      throw;
    }
    const std::string interruption = observer_.interruption();
    return interruption.empty() ? end_in_time() : end_interrupted(interruption);
  }

 private:
  [[nodiscard]] std::int64_t steps() const { return simulation_.step_number() - first_step_; }
  [[nodiscard]] bool must_continue() const {
    return !has_reached_end(simulation_.time(), simulation_.last_step(), times_.end) && !simulation_.ends_at_rest() &&
           observer_.interruption().empty();
  }

  void step() {
    const double before = output_.wall_seconds();
    output_.before_step(simulation_);
    // Rows and checkpoints follow a step near their time and change no step.
    simulation_.step(simulation_.next_step(std::min(snapshots_.next(), times_.end)));
    seconds_in_steps_ += output_.wall_seconds() - before;
    set_thread_count(threads_.after_step(seconds_in_steps_));
    if (!simulation_.left_text().empty()) {
      return;
    }
    observer_.texts("", warnings_.after_step(simulation_));
    output_.after_step(simulation_);
  }

  ExitCode end_without_particles() {
    output_.slide_left();
    write_last_state();
    close("done", simulation_.left_text());
    observer_.text(simulation_.left_text());
    return ExitCode::done;
  }

  // A run at rest ends. Its last row and snapshot are written before a checkpoint records that.
  void write_due_output() {
    const double time = simulation_.time(), dt = simulation_.last_step();
    const bool rests = simulation_.ends_at_rest();
    if (rests || times_.history_interval <= 0.0 || history_.reached(time, dt)) {
      output_.write_history(simulation_);
    }
    if (rests || snapshots_.reached(time, dt)) {
      output_.write_snapshot(simulation_);
      observer_.texts("", warnings_.after_snapshot(simulation_));
    }
    const double wall_interval = simulation_.parameters().checkpoint.wall_interval;
    const bool is_old = wall_interval > 0.0 && output_.wall_seconds() - wall_of_checkpoint_ > wall_interval;
    if (checkpoints_.reached(time, dt) || is_old) {
      output_.write_checkpoint(simulation_);
      wall_of_checkpoint_ = output_.wall_seconds();
      output_.write_provenance(simulation_, "running", "", wall_of_checkpoint_);
    }
  }

  void report_progress() {
    const double time = simulation_.time(), front = output_.front_position(simulation_), elapsed = time - front_time_;
    const double speed =
        elapsed > 0.0 ? sim::front_along_x(simulation_).direction * (front - front_position_) / elapsed : std::nan("");
    front_position_ = front;
    front_time_ = time;
    observer_.progress({time, times_.end, steps(), front, speed});
  }

  // Writes the last state of a run that ends early and cannot be continued.
  void write_last_state() {
    output_.write_history(simulation_);
    output_.write_snapshot(simulation_);
    output_.write_maps(simulation_);
  }

  void close(const std::string& status, const std::string& message) {
    set_thread_count(most_threads_);
    output_.write_index();
    const double wall = output_.wall_seconds();
    output_.write_provenance(simulation_, status, message, wall);
    observer_.end_progress();
    report_summary(simulation_, output_, steps(), wall, folder_, observer_);
  }

  ExitCode end_interrupted(const std::string& interruption) {
    // The checkpoint stores this state, without a row or a snapshot, which an uninterrupted run would not have written.
    output_.write_checkpoint(simulation_);
    close("stopped", interruption);
    observer_.error_line("interrupted by {} at t = {:g} s. To continue: thawslide resume {}", interruption,
                         simulation_.time(), shell_quote(folder_.string()));
    return ExitCode::stopped_by_signal;
  }

  ExitCode end_in_time() {
    const std::string rest = simulation_.ends_at_rest() ? simulation_.rest_text() : "";
    output_.write_checkpoint(simulation_);
    close("done", rest);
    if (!rest.empty()) {
      observer_.text(rest);
    }
    return ExitCode::done;
  }

  Simulation& simulation_;
  RunOutput<Dim>& output_;
  const std::filesystem::path& folder_;
  Observer& observer_;
  const config::Time& times_;
  std::int64_t first_step_;
  Schedule history_, snapshots_, checkpoints_;
  double front_position_ = std::nan(""), front_time_ = 0.0;  // of the last progress line
  StepWarnings warnings_;
  int most_threads_;
  ThreadChoice threads_;
  double seconds_in_steps_ = 0.0, wall_of_checkpoint_ = 0.0;
};

}  // namespace

std::filesystem::path usual_run_folder(const config::Case& parameters) {
  return std::filesystem::path("runs") / parameters.name;
}

template <int Dim>
ExitCode start_and_run(sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder,
                       Observer& observer) {
  output.start_clock();
  observer.start(simulation.time());
  return with_errors_reported<Dim>(simulation, output, folder, observer, [&] {
    if (!settle<Dim>(simulation, output, observer)) {
      const std::string interruption = observer.interruption();
      output.write_provenance(simulation, "stopped", interruption, 0.0);
      observer.error_line("interrupted by {} while the body settled. To start again: thawslide resume {}", interruption,
                          shell_quote(folder.string()));
      return ExitCode::stopped_by_signal;
    }
    output.begin(simulation);
    return Loop<Dim>(simulation, output, folder, observer).run();
  });
}

template <int Dim>
ExitCode run_to_end(sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder,
                    Observer& observer) {
  return with_errors_reported<Dim>(simulation, output, folder, observer,
                                   [&] { return Loop<Dim>(simulation, output, folder, observer).run(); });
}

template ExitCode start_and_run<2>(sim::Simulation<2>&, RunOutput<2>&, const std::filesystem::path&, Observer&);
template ExitCode start_and_run<3>(sim::Simulation<3>&, RunOutput<3>&, const std::filesystem::path&, Observer&);
template ExitCode run_to_end<2>(sim::Simulation<2>&, RunOutput<2>&, const std::filesystem::path&, Observer&);
template ExitCode run_to_end<3>(sim::Simulation<3>&, RunOutput<3>&, const std::filesystem::path&, Observer&);

Schedule::Schedule(double interval, double begin, double last_step, double end, double early)
    : interval_(interval), end_(end), early_(early), next_(interval > 0.0 ? std::min(interval, end) : end) {
  pass(begin, last_step);
}

void Schedule::pass(double time, double step) {
  if (interval_ <= 0.0) {
    return;
  }
  // First multiple after the time, computed directly for tiny intervals. Rounding may make the floor too small by two.
  const double beyond = time + early_ * step;
  count_ = std::max(count_, std::floor(beyond / interval_));
  for (int k = 0; k < 2 && count_ * interval_ <= beyond; ++k) {
    ++count_;
  }
  next_ = std::min(count_ * interval_, end_);
}

bool Schedule::reached(double time, double step) {
  if (time < next_ - (next_ < end_ ? early_ : 0.5) * step) {
    return false;
  }
  pass(time, step);
  return true;
}

bool has_reached_end(double time, double last_step, double end) { return time >= end - 0.5 * last_step; }

Schedule history_schedule(const config::Time& times, double time, double last_step) {
  constexpr double round_off = 1e-6;  // of a step
  return {times.history_interval, time, last_step, times.end,
          times.stepping == config::Stepping::adaptive ? round_off : 0.5};
}

Schedule snapshot_schedule(const config::Time& times, double time, double last_step) {
  return {times.output_interval, time, last_step, times.end};
}

}  // namespace thawslide::run
