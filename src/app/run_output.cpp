#include "app/run_output.hpp"

#include <cmath>

#include "app/resolved_case.hpp"
#include "base/parallel.hpp"
#include "io/checkpoint.hpp"
#include "io/snapshot.hpp"
#include "io/terrain_csv.hpp"
#include "sim/history.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

Schedule::Schedule(double interval, double begin, double last_step, double end)
    : interval_(interval), end_(end), next_(interval > 0.0 ? std::min(interval, end) : end) {
  pass(begin, last_step);
}

void Schedule::pass(double time, double step) {
  while (next_ < end_ && next_ <= time + 0.5 * step) {
    next_ = std::min(static_cast<double>(++count_) * interval_, end_);
  }
}

bool Schedule::reached(double time, double step) {
  if (time < next_ - 0.5 * step) {
    return false;
  }
  pass(time, step);
  return true;
}

namespace {

template <int Dim>
void write_terrain(const fs::path& folder, const sim::Simulation<Dim, double>& simulation) {
  const auto& model = simulation.model();
  if (!model.profile) {
    return;
  }
  // The vertices inside the domain, and the ground at its two sides.
  const auto& line = *model.profile;
  const double extent = static_cast<double>(model.constraints.extent[0]);
  std::vector<double> x{0.0};
  for (const double vertex : line.x()) {
    if (vertex > 0.0 && vertex < extent) {
      x.push_back(vertex);
    }
  }
  x.push_back(extent);
  std::vector<double> height;
  for (double& place : x) {
    height.push_back(line.height(place) + model.origin[Dim - 1]);
    place += model.origin[0];
  }
  io::write_terrain_csv(folder / "terrain.csv", x, height);
}

template <int Dim>
io::Provenance start_provenance(const sim::Simulation<Dim, double>& simulation) {
  io::Provenance provenance = io::provenance_of_this_program();
  const auto& model = simulation.model();
  provenance.threads = thread_count();
  provenance.particles = simulation.particles().size();
  for (int a = 0; a < Dim; ++a) {
    provenance.origin.push_back(model.origin[a]);
    provenance.gravity.push_back(static_cast<double>(model.motion.gravity[a]));
  }
  return provenance;
}

}  // namespace

template <int Dim>
RunOutput<Dim>::RunOutput(const fs::path& folder, io::HistoryWriter history, io::SnapshotSeries snapshots)
    : folder_(folder), history_(std::move(history)), snapshots_(std::move(snapshots)) {}

template <int Dim>
RunOutput<Dim>::RunOutput(const fs::path& folder, const Simulation& simulation)
    : RunOutput(folder, io::HistoryWriter(folder / "history.csv"), io::SnapshotSeries(folder)) {
  provenance_ = start_provenance(simulation);
  provenance_.inputs = write_resolved_case(simulation.parameters(), folder);
  write_terrain(folder, simulation);
  write_provenance(simulation, "running", "", 0.0);
  write_history(simulation);
  write_snapshot(simulation);
  stopwatch_ = {};  // time counts from the first step on
}

template <int Dim>
RunOutput<Dim> RunOutput<Dim>::resume(const fs::path& folder, const Simulation& simulation) {
  RunOutput output(folder, io::HistoryWriter::continue_after(folder / "history.csv", simulation.time()),
                   io::SnapshotSeries::continue_after(folder, simulation.time()));
  output.provenance_ = start_provenance(simulation);
  output.provenance_.inputs = io::read_inputs(folder);
  output.history_step_ = output.snapshot_step_ = output.provenance_.steps_before = simulation.step_number();
  return output;
}

template <int Dim>
void RunOutput<Dim>::write_history(const Simulation& simulation) {
  if (history_step_ != simulation.step_number()) {
    history_step_ = simulation.step_number();
    stopwatch_.time("write_history", [&] { history_.add(sim::history_row(simulation)); });
  }
}

template <int Dim>
void RunOutput<Dim>::write_snapshot(const Simulation& simulation) {
  if (snapshot_step_ != simulation.step_number()) {
    snapshot_step_ = simulation.step_number();
    stopwatch_.time("write_snapshot", [&] {
      snapshots_.add(io::take_snapshot<Dim, double>(simulation.particles(), simulation.model().origin,
                                                    simulation.time(), simulation.step_number()));
    });
  }
}

template <int Dim>
void RunOutput<Dim>::write_checkpoint(const Simulation& simulation) {
  stopwatch_.time("write_checkpoint", [&] {
    snapshots_.finish_writing();  // a run that goes on from here must find all snapshots before
    io::write_checkpoint<Dim, double>(folder_ / "checkpoint.bin", simulation.particles(), simulation.scalars());
  });
}

template <int Dim>
Stopwatch::Seconds RunOutput<Dim>::seconds_per_stage(const Simulation& simulation) const {
  Stopwatch::Seconds seconds = simulation.stopwatch().seconds();
  seconds.insert(stopwatch_.seconds().begin(), stopwatch_.seconds().end());
  return seconds;
}

template <int Dim>
void RunOutput<Dim>::write_provenance(const Simulation& simulation, const std::string& status,
                                      const std::string& message, double wall_seconds) {
  provenance_.status = status;
  provenance_.message = message;
  provenance_.simulated_time = simulation.time();
  provenance_.steps = simulation.step_number();
  provenance_.wall_seconds = wall_seconds;
  provenance_.seconds_per_stage = seconds_per_stage(simulation);
  provenance_.seconds_beside = snapshots_.seconds_beside();
  io::write_provenance(folder_ / "run.json", provenance_);
}

template class RunOutput<2>;
template class RunOutput<3>;

}  // namespace thawslide::app
