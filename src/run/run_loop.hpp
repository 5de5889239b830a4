// Time loop of a run from its present time to its end, with output at its times and reports to an observer.
#pragma once

#include "base/error.hpp"
#include "config/case.hpp"
#include "run/observer.hpp"
#include "run/run_output.hpp"

namespace thawslide::run {

// Settles a new run if requested, writes its first state and runs it; otherwise as run_to_end.
template <int Dim>
ExitCode start_and_run(sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder,
                       Observer& observer);

// Returns why the run ended, after writing all results so far. Throws RunError if the run failed.
template <int Dim>
ExitCode run_to_end(sim::Simulation<Dim>& simulation, RunOutput<Dim>& output, const std::filesystem::path& folder,
                    Observer& observer);

// Calls work(dimension constant) for the case's dimension.
template <class Work>
auto with_dimension(int dimension, const Work& work) {
  return dimension == 2 ? work(std::integral_constant<int, 2>{}) : work(std::integral_constant<int, 3>{});
}

// Default output folder.
[[nodiscard]] std::filesystem::path usual_run_folder(const config::Case& parameters);

// Output times: every multiple of an interval, and the end.
class Schedule {
 public:
  // Begins at `begin`, reached by a step of `last_step` (0: none). early: fraction of a step by which it may end before
  // a time and still reach it; for the end it is 0.5.
  Schedule(double interval, double begin, double last_step, double end, double early = 0.5);
  [[nodiscard]] double next() const { return next_; }
  // Returns whether the next time is reached, and if so advances to the following one.
  bool reached(double time, double step);

 private:
  void pass(double time, double step);

  double interval_, end_, early_, next_;
  double count_ = 1.0;  // intervals up to the next time
};

// True if the last step has reached the end, to half a step: fixed steps may end that much early.
[[nodiscard]] bool has_reached_end(double time, double last_step, double end);

// Schedules from the time of the last step on. A row follows the first adaptive step that reaches its time, or the
// nearest fixed step. Adaptive steps end at snapshots, so each can have a row of the same time.
[[nodiscard]] Schedule history_schedule(const config::Time& times, double time, double last_step);
[[nodiscard]] Schedule snapshot_schedule(const config::Time& times, double time, double last_step);

}  // namespace thawslide::run
