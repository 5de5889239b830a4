#include "app/run_loop.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include "app/boiling_warning.hpp"
#include "app/print.hpp"
#include "app/progress.hpp"
#include "app/run_summary.hpp"
#include "app/signals.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/shell_quote.hpp"
#include "base/thread_choice.hpp"
#include "io/checkpoint.hpp"
#include "sim/direction.hpp"
#include "sim/history.hpp"
#include "sim/slide_left.hpp"

namespace thawslide::app {

namespace {

// Position and speed of the front for the progress line.
class FrontWatch {
 public:
  // front: distance travelled [m].
  template <int Dim>
  ProgressState state(const sim::Simulation<Dim>& simulation, double front, std::int64_t steps) {
    const double elapsed = simulation.time() - time_;
    const double speed = elapsed > 0.0 ? sim::direction_along_x(simulation) * (front - front_) / elapsed : std::nan("");
    front_ = front;
    time_ = simulation.time();
    return {simulation.time(), simulation.parameters().time.end, steps, front, speed};
  }

 private:
  double front_ = std::nan(""), time_ = 0.0;
};

// Reports once that guards remove particles.
class RemovalWatch {
 public:
  explicit RemovalWatch(const sim::Removed& before) : told_(before.by_guards() > 0) {}

  // Empty if there is nothing new to report.
  template <int Dim>
  std::string warning(const sim::Simulation<Dim>& simulation) {
    if (told_ || simulation.removed().by_guards() == 0) {
      return "";
    }
    told_ = true;
    return fmt::format(
        "warning: at t = {:.6g} s guards have removed {}; history.csv has their mass, run.json their number",
        simulation.time(), sim::text_of(simulation.removed()));
  }

 private:
  bool told_;
};

// Settles the body if the case requires it. If this fails, files are written as for any other failed run. Returns false
// if a signal interrupted it.
template <int Dim>
bool settle(sim::Simulation<Dim>& simulation, RunOutput<Dim>& output) {
  if (!simulation.needs_settling()) {
    return true;
  }
  print_text("settling under gravity for {:g} s\n", simulation.parameters().mechanics.settle_time);
  try {
    return simulation.settle([] { return caught_signal() == 0; });
  } catch (const RunError& error) {
    output.write_first_state(simulation);
    output.write_index();
    output.write_provenance(simulation, "failed", error.what(), 0.0);
    throw;
  }
}

// Ends a run after a failed write or a GPU error: all files are intact, and the run can resume from its last
// checkpoint.
template <int Dim>
int end_at_once(const sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, const std::exception& error,
                ExitCode code, const std::filesystem::path& folder) {
  try {
    output.require_own_folder();
  } catch (const WriteError& lost) {
    print_error("error: {}\nstopped at t = {:g} s\n", lost.what(), simulation.time());
    return static_cast<int>(code);
  }
  try {
    output.write_provenance(simulation, "stopped", error.what(), output.wall_seconds());
  } catch (const WriteError&) {  // NOLINT(bugprone-empty-catch): it is told below what could not be written first
  }
  print_error("error: {}\nstopped at t = {:g} s. All files are intact: `thawslide resume {}` {}\n", error.what(),
              simulation.time(), shell_quote(folder.string()),
              io::has_checkpoint(folder) ? "continues from the last checkpoint" : "starts it again");
  return static_cast<int>(code);
}

UserError out_of_memory() {
  return UserError("the memory of this machine, or its limit (ulimit -v), was exhausted during the run");
}

// Time loop of one process, with its output.
template <int Dim>
class Loop {
 public:
  using Simulation = sim::Simulation<Dim>;

  Loop(Simulation& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder)
      : simulation_(simulation),
        output_(output),
        folder_(folder),
        times_(simulation.parameters().time),
        first_step_(simulation.step_number()),
        history_(schedule(times_.history_interval, times_.stepping == config::Stepping::adaptive ? round_off : 0.5)),
        snapshots_(schedule(times_.output_interval)),
        checkpoints_(schedule(simulation.parameters().checkpoint.interval > 0.0
                                  ? simulation.parameters().checkpoint.interval
                                  : times_.end)),
        progress_(simulation.time()),
        removal_(simulation.removed()),
        most_threads_(thread_count()),
        threads_(most_threads_, 0.0) {
    output_.start_clock();
  }

  // Returns the exit code; throws RunError if the run failed. In both cases, all results so far have been written.
  int run() {
    catch_signals();
    try {
      while (must_continue()) {
        step();
        write_what_is_due();
        if (progress_.due(simulation_.time(), times_.end)) {
          progress_.show(front_.state(simulation_, output_.front_position(simulation_), steps()));
        }
      }
    } catch (const sim::SlideLeft& end) {
      output_.slide_left();
      write_last_state();
      close("done", end.what());
      print_text("{}\n", end.what());
      return static_cast<int>(ExitCode::done);
    } catch (const RunError& error) {
      write_last_state();
      close("failed", error.what());
      throw;
    }
    return caught_signal() != 0 ? end_by_signal() : end_in_time();
  }

 private:
  // A row follows the first adaptive step that reaches its time, within round-off. Adaptive steps end at snapshots, so
  // each snapshot can have a row of the same time. With fixed steps, a row follows the nearest step.
  static constexpr double round_off = 1e-6;  // of a step

  [[nodiscard]] Schedule schedule(double interval, double early = 0.5) const {
    return {interval, simulation_.time(), simulation_.last_step(), times_.end, early};
  }
  [[nodiscard]] std::int64_t steps() const { return simulation_.step_number() - first_step_; }
  [[nodiscard]] bool must_continue() const {
    return simulation_.time() < times_.end - 0.5 * simulation_.last_step() && !simulation_.ends_at_rest() &&
           caught_signal() == 0;
  }

  void step() {
    const double before = output_.wall_seconds();
    output_.before_step(simulation_);
    // Rows and checkpoints follow a step near their time and change no step.
    simulation_.step(simulation_.next_step(std::min(snapshots_.next(), times_.end)));
    seconds_in_steps_ += output_.wall_seconds() - before;
    set_thread_count(threads_.after_step(seconds_in_steps_));
    report_line(removal_.warning(simulation_));
    warn_of_energy();
    output_.after_step(simulation_);
  }

  // A run at rest ends. Its last row and snapshot are written before a checkpoint records that.
  void write_what_is_due() {
    const double time = simulation_.time(), dt = simulation_.last_step();
    const bool rests = simulation_.ends_at_rest();
    if (rests || times_.history_interval <= 0.0 || history_.reached(time, dt)) {
      output_.write_history(simulation_);
    }
    if (rests || snapshots_.reached(time, dt)) {
      output_.write_snapshot(simulation_);
      report_line(boiling_.warning<Dim>(simulation_));
    }
    const double wall_interval = simulation_.parameters().checkpoint.wall_interval;
    const bool is_old = wall_interval > 0.0 && output_.wall_seconds() - wall_of_checkpoint_ > wall_interval;
    if (checkpoints_.reached(time, dt) || is_old) {
      output_.write_checkpoint(simulation_);
      wall_of_checkpoint_ = output_.wall_seconds();
      output_.write_provenance(simulation_, "running", "", wall_of_checkpoint_);
    }
  }

  // Prints the warning once.
  void warn_of_energy() {
    if (!has_warned_of_energy_) {
      const std::string warning = simulation_.energy_warning();
      has_warned_of_energy_ = !warning.empty();
      report_line(warning);
    }
  }

  void report_line(const std::string& warning) {
    if (!warning.empty()) {
      progress_.warning(warning);
    }
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
    progress_.finish();
    print_summary(simulation_, output_, steps(), wall, folder_);
  }

  int end_by_signal() {
    // The checkpoint stores this state. A row or a snapshot is omitted, because an uninterrupted run would not have
    // written it.
    output_.write_checkpoint(simulation_);
    close("stopped", fmt::format("signal {}", caught_signal()));
    print_error("interrupted by signal {} at t = {:g} s. To continue: thawslide resume {}\n", caught_signal(),
                simulation_.time(), shell_quote(folder_.string()));
    return static_cast<int>(ExitCode::stopped_by_signal);
  }

  int end_in_time() {
    const std::string rest = simulation_.ends_at_rest() ? simulation_.rest_text() : "";
    output_.write_checkpoint(simulation_);
    close("done", rest);
    if (!rest.empty()) {
      print_text("{}\n", rest);
    }
    return static_cast<int>(ExitCode::done);
  }

  Simulation& simulation_;
  RunOutput<Dim>& output_;
  const std::filesystem::path& folder_;
  const config::Time& times_;
  std::int64_t first_step_;
  Schedule history_, snapshots_, checkpoints_;
  Progress progress_;
  FrontWatch front_;
  BoilingWatch boiling_;
  RemovalWatch removal_;
  int most_threads_;
  ThreadChoice threads_;
  double seconds_in_steps_ = 0.0, wall_of_checkpoint_ = 0.0;
  bool has_warned_of_energy_ = false;
};

}  // namespace

std::filesystem::path usual_run_folder(const config::Case& parameters) {
  return std::filesystem::path("runs") / parameters.name;
}

void use_threads(int threads) { set_thread_count(threads > 0 ? threads : available_cores()); }

template <int Dim>
int start_and_run(sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder) {
  output.start_clock();
  catch_signals();
  try {
    if (!settle<Dim>(simulation, output)) {
      output.write_provenance(simulation, "stopped", fmt::format("signal {}", caught_signal()), 0.0);
      print_error("interrupted by signal {} while the body settled. To start again: thawslide resume {}\n",
                  caught_signal(), shell_quote(folder.string()));
      return static_cast<int>(ExitCode::stopped_by_signal);
    }
    output.begin(simulation);
  } catch (const WriteError& error) {
    return end_at_once<Dim>(simulation, output, error, ExitCode::not_written, folder);
  } catch (const DeviceError& error) {
    return end_at_once<Dim>(simulation, output, error, ExitCode::device_failed, folder);
  } catch (const std::bad_alloc&) {
    return end_at_once<Dim>(simulation, output, out_of_memory(), ExitCode::user_mistake, folder);
  }
  return run_to_end<Dim>(simulation, output, folder);
}

template <int Dim>
int run_to_end(sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder) {
  try {
    return Loop<Dim>(simulation, output, folder).run();
  } catch (const WriteError& error) {
    return end_at_once<Dim>(simulation, output, error, ExitCode::not_written, folder);
  } catch (const DeviceError& error) {
    return end_at_once<Dim>(simulation, output, error, ExitCode::device_failed, folder);
  } catch (const std::bad_alloc&) {
    return end_at_once<Dim>(simulation, output, out_of_memory(), ExitCode::user_mistake, folder);
  }
}

template int start_and_run<2>(sim::Simulation<2>&, RunOutput<2>&, const std::filesystem::path&);
template int start_and_run<3>(sim::Simulation<3>&, RunOutput<3>&, const std::filesystem::path&);
template int run_to_end<2>(sim::Simulation<2>&, RunOutput<2>&, const std::filesystem::path&);
template int run_to_end<3>(sim::Simulation<3>&, RunOutput<3>&, const std::filesystem::path&);

}  // namespace thawslide::app
