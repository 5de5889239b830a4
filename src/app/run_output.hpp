// The files of a run, written as it goes (ARCHITECTURE.md lists them).
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/map_output.hpp"
#include "base/stopwatch.hpp"
#include "io/history_writer.hpp"
#include "io/provenance.hpp"
#include "io/run_lock.hpp"
#include "io/snapshot_series.hpp"
#include "sim/end_state.hpp"
#include "sim/run_records.hpp"
#include "sim/simulation.hpp"

namespace thawslide::app {

// Moments at which something is written: every multiple of an interval, and the end.
class Schedule {
 public:
  // Goes on from `begin`, reached by a step of `last_step` (0: nothing has run yet), as if it had run up to there.
  // early: fraction of a step by which a step may end before a time and still reach it; for the end it is 0.5.
  Schedule(double interval, double begin, double last_step, double end, double early = 0.5);
  [[nodiscard]] double next() const { return next_; }
  // Returns whether the next time is reached, and then advances to the following one.
  bool reached(double time, double step);

 private:
  void pass(double time, double step);

  double interval_, end_, early_, next_;
  double count_ = 1.0;  // of intervals up to the next moment
};

template <int Dim>
class RunOutput {
 public:
  using Simulation = sim::Simulation<Dim, double>;

  // A new run in a folder that is there and empty, and whose lock the process holds: writes the inputs, the resolved
  // case, run.json and the ground. What writes throws WriteError where the folder is not its own any more.
  RunOutput(const std::filesystem::path& folder, const Simulation& simulation);
  // The same of a run that was cut off before its first checkpoint: inputs and case stand; earlier: what run.json
  // tells, with the part that begins; case_text: resolved.
  RunOutput(const std::filesystem::path& folder, const Simulation& simulation, io::Provenance earlier,
            std::string case_text);
  // Row and snapshot of the state that the first step begins with.
  void write_first_state(const Simulation& simulation);
  // The checkpoint before the first step; from here on time counts.
  void begin(const Simulation& simulation);
  // Goes on with a run at the simulation's time; blocks: what its checkpoint holds beside the particles; the others as
  // above. Tells what it finds damaged, as run.json does.
  static RunOutput resume(const std::filesystem::path& folder, const Simulation& simulation, const NamedNumbers& blocks,
                          io::Provenance earlier, std::string case_text);

  // Wall-clock time [s] since start_clock.
  void start_clock() { clock_start_ = std::chrono::steady_clock::now(); }
  [[nodiscard]] double wall_seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - clock_start_).count();
  }
  // Counts the work; before every step.
  void before_step(const Simulation& simulation);
  // Gathers what maps and probes tell; after every step.
  void after_step(const Simulation& simulation);
  // In place of it, after a step that none of the slide stayed on (SlideLeft).
  void slide_left();
  // As run.json has it; of the last call of write_provenance.
  [[nodiscard]] const sim::EndState& end_state() const { return end_state_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return provenance_.warnings; }
  // Throws WriteError where the run's folder is not the one any more that it began in.
  void require_own_folder() const { own_.require(); }
  // One row of history.csv, and of probes.csv where there are probes.
  void write_history(const Simulation& simulation);
  [[nodiscard]] sim::HistoryRow history_row(const Simulation& simulation) const {
    return records_.history_row(simulation);
  }
  // maps/ in 3D, of what was gathered so far.
  void write_maps(const Simulation& simulation);
  // How far the front has come [m]: along x in 2D, along the path in 3D, NaN while there is none.
  [[nodiscard]] double front_position(const Simulation& simulation) const;
  void write_snapshot(const Simulation& simulation);
  // particles.vtkhdf over all snapshots so far.
  void write_index() {
    own_.require();
    stopwatch_.time("write_snapshot", [&] { snapshots_.write_index(); });
  }
  // What `resume` goes on from, and the maps so far.
  void write_checkpoint(const Simulation& simulation);
  // run.json; status as architecture's words: running, done, stopped, failed; wall_seconds: of this process.
  void write_provenance(const Simulation& simulation, const std::string& status, const std::string& message,
                        double wall_seconds);
  // What run.json tells the run came to, by name, in 3D.
  [[nodiscard]] const std::vector<std::pair<std::string, double>>& figures() const { return provenance_.figures; }
  // What run.json tells of the work: particles at the start, and the sum over this process's steps of those that were
  // there.
  [[nodiscard]] std::size_t particles_at_start() const { return provenance_.particles; }
  [[nodiscard]] double particle_steps() const { return provenance_.parts.back().particle_steps; }
  // Wall-clock time [s] of the step's stages and of writing.
  [[nodiscard]] Stopwatch::Seconds seconds_per_stage(const Simulation& simulation) const;

 private:
  RunOutput(const std::filesystem::path& folder, sim::RunRecords<Dim> records, io::HistoryWriter history,
            io::SnapshotSeries snapshots);
  void add_figures(const Simulation& simulation);
  void write_state(const Simulation& simulation);

  std::filesystem::path folder_;
  io::OwnFolder own_;
  io::HistoryWriter history_;
  io::SnapshotSeries snapshots_;
  sim::RunRecords<Dim> records_;
  std::vector<FrontAt> fronts_;              // at the moments of snapshots
  std::optional<io::HistoryWriter> probes_;  // none without probes
  io::Provenance provenance_;
  sim::EndState end_state_;
  bool slide_left_ = false;
  std::string case_text_;  // resolved, as case.toml has it
  Stopwatch stopwatch_;
  std::chrono::steady_clock::time_point clock_start_;
  std::int64_t history_step_ = -1, snapshot_step_ = -1, checkpoint_step_ = -1;
};

}  // namespace thawslide::app
