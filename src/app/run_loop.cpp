#include "app/run_loop.hpp"

#include <algorithm>
#include <cmath>

#include "app/boiling_note.hpp"
#include "app/progress.hpp"
#include "app/say.hpp"
#include "app/signals.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/thread_choice.hpp"
#include "sim/history.hpp"
#include "sim/slide_left.hpp"

namespace thawslide::app {

namespace {

// What the progress line tells of the front.
class FrontWatch {
 public:
  // front: how far it has come [m].
  template <int Dim>
  ProgressState state(const sim::Simulation<Dim, double>& simulation, double front, std::int64_t steps) {
    const double elapsed = simulation.time() - time_;
    const double speed = elapsed > 0.0 ? (front - front_) / elapsed : std::nan("");
    front_ = front;
    time_ = simulation.time();
    return {simulation.time(), simulation.parameters().time.end, steps, front, speed};
  }

 private:
  double front_ = std::nan(""), time_ = 0.0;
};

// Tells once that guards remove particles.
class RemovalWatch {
 public:
  explicit RemovalWatch(const sim::Removed& before) : told_(before.by_guards() > 0) {}

  // Empty while there is nothing new to tell.
  template <int Dim>
  std::string note(const sim::Simulation<Dim, double>& simulation) {
    if (told_ || simulation.removed().by_guards() == 0) {
      return "";
    }
    told_ = true;
    return fmt::format(
        "note: at t = {:.6g} s guards have removed {}; history.csv has their mass, run.json their number",
        simulation.time(), sim::text_of(simulation.removed()));
  }

 private:
  bool told_;
};

// Where the slide's front is at the end, in words.
std::string front_text(double front, double runout) {
  return std::isfinite(front) ? fmt::format("front at {:.0f} m, runout {:.0f} m", front, runout)
                              : "no front: maps.path is not given, and the slide has hardly moved, so there is no path "
                                "to measure along";
}

template <int Dim>
void print_summary(const sim::Simulation<Dim, double>& simulation, const RunOutput<Dim>& output, std::int64_t steps,
                   double wall, const std::filesystem::path& folder) {
  const std::size_t at_start = output.particles_at_start(), at_end = simulation.particles().size();
  say("{} particles{}, {} steps in {}: {:.3g} million particle-steps per second on {}{} thread{}\n", at_start,
      at_end == at_start ? "" : fmt::format(", {} of them at the end", at_end), steps, duration_text(wall),
      output.particle_steps() / wall / 1e6, thread_count() == 1 ? "" : "at most ", thread_count(),
      thread_count() == 1 ? "" : "s");
  std::vector<std::pair<double, std::string>> stages;
  for (const auto& [name, seconds] : output.seconds_per_stage(simulation)) {
    stages.emplace_back(seconds, name);
  }
  std::sort(stages.rbegin(), stages.rend());
  for (const auto& [seconds, name] : stages) {
    say("  {:<28}{:8.2f} s {:5.1f} %\n", name, seconds, 100.0 * seconds / wall);
  }
  const sim::HistoryRow row = output.history_row(simulation);
  const auto value = [&](const std::string& name) {
    return std::find_if(row.begin(), row.end(), [&](const auto& entry) { return entry.first == name; })->second;
  };
  say("at {:g} s: mean velocity {:.2f} m/s, mean displacement {:.0f} m, {}\n", simulation.time(),
      value("mean_velocity_m_s"), value("mean_displacement_m"),
      front_text(value("front_position_m"), value("runout_m")));
  for (const auto& [name, number] : output.figures()) {
    if (std::isfinite(number)) {
      say("  {:<28}{:12.6g}\n", name, number);
    }
  }
  if (simulation.removed().by_guards() > 0) {
    say("guards have removed {}\n", sim::text_of(simulation.removed()));
  }
  say("results in {}\n", folder.string());
}

// Settles a case that asks for it; a body that goes bad on the way leaves its files as any other run does.
template <int Dim>
void settle(sim::Simulation<Dim, double>& simulation, RunOutput<Dim>& output) {
  if (!simulation.needs_settling()) {
    return;
  }
  say("settling under gravity for {:g} s\n", simulation.parameters().mechanics.settle_time);
  try {
    simulation.settle();
  } catch (const RunError& error) {
    output.write_first_state(simulation);
    output.write_index();
    output.write_provenance(simulation, "failed", error.what(), 0.0);
    throw;
  }
}

// A file could not be written: what stands is whole, and the run can go on from its last checkpoint.
template <int Dim>
int end_unwritten(const sim::Simulation<Dim, double>& simulation, RunOutput<Dim>& output, const WriteError& error,
                  const std::filesystem::path& folder) {
  try {
    output.write_provenance(simulation, "stopped", error.what(), output.wall_seconds());
  } catch (const WriteError&) {  // NOLINT(bugprone-empty-catch): it is told below what could not be written first
  }
  say_error(
      "error: {}\nstopped at t = {:g} s; what stands is whole, and `thawslide resume {}` goes on from the last "
      "checkpoint\n",
      error.what(), simulation.time(), folder.string());
  return static_cast<int>(ExitCode::not_written);
}

template <int Dim>
int take_steps(sim::Simulation<Dim, double>& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder) {
  const config::Time& times = simulation.parameters().time;
  const double begin = simulation.time();
  const std::int64_t first_step = simulation.step_number();
  const double last_step = simulation.last_step();
  Schedule history(times.history_interval, begin, last_step, times.end);
  Schedule snapshots(times.output_interval, begin, last_step, times.end);
  const double checkpoint_interval = simulation.parameters().checkpoint.interval;
  const double wall_between_checkpoints = simulation.parameters().checkpoint.wall_interval;
  Schedule checkpoints(checkpoint_interval > 0.0 ? checkpoint_interval : times.end, begin, last_step, times.end);
  Progress progress(begin);
  FrontWatch front;
  BoilingWatch boiling;
  RemovalWatch removal(simulation.removed());
  output.start_clock();
  const auto wall = [&] { return output.wall_seconds(); };
  const int most_threads = thread_count();
  ThreadChoice choice(most_threads, 0.0);
  double seconds_in_steps = 0.0, wall_of_checkpoint = 0.0;
  const auto step = [&](double until) {
    const double before = wall();
    output.before_step(simulation);
    simulation.step(simulation.next_step(until));
    seconds_in_steps += wall() - before;
    set_thread_count(choice.after_step(seconds_in_steps));
  };
  const auto close = [&](const std::string& status, const std::string& message) {
    set_thread_count(most_threads);
    output.write_index();
    const double wall_seconds = wall();
    output.write_provenance(simulation, status, message, wall_seconds);
    progress.finish();
    print_summary(simulation, output, simulation.step_number() - first_step, wall_seconds, folder);
  };
  // Of a run that ends before its time; nothing can go on from there.
  const auto write_state_at_end = [&] {
    output.write_history(simulation);
    output.write_snapshot(simulation);
    output.write_maps(simulation);
  };
  catch_signals();
  try {
    while (simulation.time() < times.end - 0.5 * simulation.last_step() && !simulation.is_at_rest() &&
           caught_signal() == 0) {
      const double next_event = std::min(
          {snapshots.next(), checkpoints.next(), times.history_interval > 0.0 ? history.next() : times.end, times.end});
      step(next_event);
      const double dt = simulation.last_step();
      if (const std::string note = removal.note(simulation); !note.empty()) {
        progress.note(note);
      }
      output.after_step(simulation);
      if (times.history_interval <= 0.0 || history.reached(simulation.time(), dt)) {
        output.write_history(simulation);
      }
      if (snapshots.reached(simulation.time(), dt)) {
        output.write_snapshot(simulation);
        if (const std::string note = boiling.note<Dim>(simulation); !note.empty()) {
          progress.note(note);
        }
      }
      const bool is_old = wall_between_checkpoints > 0.0 && wall() - wall_of_checkpoint > wall_between_checkpoints;
      if (checkpoints.reached(simulation.time(), dt) || is_old) {
        output.write_checkpoint(simulation);
        wall_of_checkpoint = wall();
        output.write_provenance(simulation, "running", "", wall_of_checkpoint);
      }
      if (progress.due(simulation.time(), times.end)) {
        progress.show(
            front.state(simulation, output.front_position(simulation), simulation.step_number() - first_step));
      }
    }
  } catch (const sim::SlideLeft& end) {
    output.slide_left();
    write_state_at_end();
    close("done", end.what());
    say("{}\n", end.what());
    return static_cast<int>(ExitCode::done);
  } catch (const RunError& error) {
    write_state_at_end();
    close("failed", error.what());
    throw;
  }
  if (caught_signal() != 0) {
    // The checkpoint holds this moment. A row or a snapshot of it would not be there had the run gone on.
    output.write_checkpoint(simulation);
    close("stopped", fmt::format("signal {}", caught_signal()));
    say_error("stopped by signal {} at t = {:g} s; `thawslide resume {}` goes on from here\n", caught_signal(),
              simulation.time(), folder.string());
    return static_cast<int>(ExitCode::stopped_by_signal);
  }
  const std::string rest = simulation.is_at_rest() ? simulation.rest_text() : "";
  if (!rest.empty()) {
    output.write_history(simulation);
    output.write_snapshot(simulation);
  }
  output.write_checkpoint(simulation);
  close("done", rest);
  if (!rest.empty()) {
    say("{}\n", rest);
  }
  return static_cast<int>(ExitCode::done);
}

}  // namespace

std::filesystem::path usual_run_folder(const config::Case& parameters) {
  return std::filesystem::path("runs") / parameters.name;
}

void use_threads(int threads) { set_thread_count(threads > 0 ? threads : available_cores()); }

template <int Dim>
int start_and_run(sim::Simulation<Dim, double>& simulation, RunOutput<Dim>& output,
                  const std::filesystem::path& folder) {
  output.start_clock();
  try {
    settle<Dim>(simulation, output);
    output.begin(simulation);
  } catch (const WriteError& error) {
    return end_unwritten<Dim>(simulation, output, error, folder);
  }
  return run_to_end<Dim>(simulation, output, folder);
}

template <int Dim>
int run_to_end(sim::Simulation<Dim, double>& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder) {
  try {
    return take_steps<Dim>(simulation, output, folder);
  } catch (const WriteError& error) {
    return end_unwritten<Dim>(simulation, output, error, folder);
  }
}

template int start_and_run<2>(sim::Simulation<2, double>&, RunOutput<2>&, const std::filesystem::path&);
template int start_and_run<3>(sim::Simulation<3, double>&, RunOutput<3>&, const std::filesystem::path&);
template int run_to_end<2>(sim::Simulation<2, double>&, RunOutput<2>&, const std::filesystem::path&);
template int run_to_end<3>(sim::Simulation<3, double>&, RunOutput<3>&, const std::filesystem::path&);

}  // namespace thawslide::app
