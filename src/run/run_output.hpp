// Output files of a run, written during the run (docs/reference/outputs.md lists them).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "band/base_state.hpp"
#include "base/clocks.hpp"
#include "base/state_numbers.hpp"
#include "io/history_writer.hpp"
#include "io/provenance.hpp"
#include "io/run_lock.hpp"
#include "io/snapshot_series.hpp"
#include "run/map_output.hpp"
#include "sim/records/end_state.hpp"
#include "sim/records/run_records.hpp"
#include "sim/simulation.hpp"

namespace thawslide::run {

template <int Dim>
class RunOutput {
 public:
  using Simulation = sim::Simulation<Dim>;

  // Starts a run in an empty folder whose lock the process holds: writes inputs, case, run.json and ground. All writing
  // functions throw WriteError if the folder no longer belongs to this run.
  RunOutput(const std::filesystem::path& folder, const Simulation& simulation);
  // Restarts a run without a checkpoint; earlier: contents of run.json, with the part that begins; case_text: resolved.
  RunOutput(const std::filesystem::path& folder, const Simulation& simulation, io::Provenance earlier,
            std::string case_text);
  // Writes row and snapshot of the state before the first step.
  void write_first_state(const Simulation& simulation);
  // Writes the checkpoint before the first step; work is counted from here.
  void begin(const Simulation& simulation);
  // Resumes a run; blocks: contents of its checkpoint other than the particles. Records damaged files in run.json.
  static RunOutput resume(const std::filesystem::path& folder, const Simulation& simulation, const NamedNumbers& blocks,
                          io::Provenance earlier, std::string case_text);

  // Wall-clock time [s] since start_clock.
  void start_clock() { clock_start_ = wall_clock(); }
  [[nodiscard]] double wall_seconds() const { return wall_clock() - clock_start_; }
  // Counts the work; call before every step.
  void before_step(const Simulation& simulation);
  // Samples maps and probes; call after every step.
  void after_step(const Simulation& simulation);
  // Replaces after_step after a step that removed the last of the slide.
  void slide_left();
  // End state, and contents of run.json, as of the last call of write_provenance.
  [[nodiscard]] const sim::EndState& end_state() const { return end_state_; }
  [[nodiscard]] const io::Provenance& provenance() const { return provenance_; }
  // Throws WriteError if the run's folder was replaced by another one.
  void require_own_folder() const { own_.require(); }
  // Writes one row of history.csv, and of probes.csv if there are probes.
  void write_history(const Simulation& simulation);
  [[nodiscard]] sim::HistoryRow history_row(const Simulation& simulation) const {
    return records_.history_row(simulation);
  }
  // Writes maps/ in 3D, as recorded so far.
  void write_maps(const Simulation& simulation);
  // Position of the front [m]: along x in 2D, along the path in 3D, NaN while there is none.
  [[nodiscard]] double front_position(const Simulation& simulation) const;
  void write_snapshot(const Simulation& simulation);
  // Writes particles.vtkhdf over all snapshots so far.
  void write_index() {
    own_.require();
    stopwatch_.time("write_snapshot", [&] { snapshots_.write_index(); });
  }
  // Writes the state for `resume`, and the maps so far.
  void write_checkpoint(const Simulation& simulation);
  // Writes run.json; status: running, done, stopped or failed; wall_seconds: of this process.
  void write_provenance(const Simulation& simulation, const std::string& status, const std::string& message,
                        double wall_seconds);

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
  std::vector<FrontAt> fronts_;              // at the times of snapshots
  std::optional<io::HistoryWriter> probes_;  // none without probes
  io::Provenance provenance_;
  sim::EndState end_state_;
  bool slide_left_ = false;
  std::string case_text_;  // resolved, as in case.toml
  Stopwatch stopwatch_;
  double clock_start_ = 0.0;
  std::int64_t history_step_ = -1, snapshot_step_ = -1, checkpoint_step_ = -1;
};

// State of a simulation other than particles and scalars, by name, for checkpoints.
template <int Dim>
void add_state(const sim::Simulation<Dim>& simulation, NamedNumbers& blocks) {
  if (const auto* columns = simulation.band_columns()) {
    blocks["band_columns"] = band::numbers_of(*columns);
  }
  if (const auto* bed = simulation.bed()) {
    blocks["bed"] = bed->state();
  }
}

// Restores the state for particles already read from a checkpoint. Throws UserError for an impossible state.
template <int Dim>
void restore_state(sim::Simulation<Dim>& simulation, const std::vector<double>& scalars, const NamedNumbers& blocks) {
  simulation.restore(scalars);
  if (simulation.has_band_columns()) {
    simulation.restore_band_columns(block_of(blocks, "band_columns"));
  }
  if (simulation.bed() != nullptr) {
    simulation.restore_bed(block_of(blocks, "bed"));
  }
}

}  // namespace thawslide::run
