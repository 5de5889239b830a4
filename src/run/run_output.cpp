#include "run/run_output.hpp"

#include <array>

#include "base/atomic_file.hpp"
#include "base/parallel.hpp"
#include "config/describe.hpp"
#include "io/checkpoint.hpp"
#include "io/snapshot.hpp"
#include "run/input_files.hpp"
#include "sim/records/history.hpp"

namespace thawslide::run {

namespace fs = std::filesystem;

namespace {

// The ground of a profile at the columns of nodes, and at the two sides of the domain.
template <int Dim>
void write_terrain(const fs::path& folder, const sim::Simulation<Dim>& simulation) {
  const auto& model = simulation.model();
  if (!model.profile) {
    return;
  }
  const double extent = model.constraints.extent[0], cell = simulation.parameters().grid.cell;
  const long columns = std::lround(extent / cell);
  std::vector<double> x, height;
  for (long k = 0; k <= columns; ++k) {
    typename terrain::Surface<Dim>::Point point = terrain::Surface<Dim>::Point::Zero();
    point[0] = k < columns ? static_cast<double>(k) * cell : extent;
    height.push_back(model.ground->height(point) + model.origin[Dim - 1]);
    x.push_back(point[0] + model.origin[0]);
  }
  io::write_profile_csv(folder / "terrain.csv", {std::move(x), std::move(height), {}});
}

// Fills in the data of this process; `provenance` contains that of earlier ones, and the part that begins.
template <int Dim>
void complete(io::Provenance& provenance, const sim::Simulation<Dim>& simulation) {
  const auto& model = simulation.model();
  provenance.parts.back().threads = thread_count();
  provenance.parts.back().device = simulation.device_name();
  provenance.parts.back().from_time = simulation.time();
  provenance.particles = simulation.particles_at_start();
  provenance.crs = simulation.site().crs_name;
  if (simulation.site().roughness) {
    provenance.roughness = config::named(*simulation.site().roughness);
  }
  for (int a = 0; a < Dim; ++a) {
    provenance.origin.push_back(model.origin[a]);
    provenance.gravity.push_back(model.motion.gravity[a]);
  }
}

// Writes inputs and resolved case of a new run to its folder; returns the provenance with its first part.
io::Provenance first_part(const config::Case& parameters, const fs::path& folder) {
  io::Provenance provenance;
  std::map<fs::path, std::string> texts;
  for (const config::CaseFile& each : parameters.case_files) {
    texts[each.file] = each.text;
  }
  provenance.inputs = io::copy_inputs(folder, input_files(parameters), texts);
  write_file_atomically(folder / "case.toml", config::resolved_toml(parameters, "inputs"));
  provenance.parts.push_back(io::part_of_this_process());
  provenance.parts.back().case_sha256 = io::sha256_of_file(folder / "case.toml");
  return provenance;
}

// Fronts as numbers of a checkpoint: time, x, y.
std::vector<double> numbers_of(const std::vector<FrontAt>& fronts) {
  std::vector<double> numbers;
  for (const FrontAt& front : fronts) {
    numbers.insert(numbers.end(), {front.time, front.position[0], front.position[1]});
  }
  return numbers;
}

std::vector<FrontAt> fronts_of(const std::vector<double>& numbers) {
  std::vector<FrontAt> fronts;
  for (std::size_t k = 0; k + 2 < numbers.size(); k += 3) {
    fronts.push_back({numbers[k], {numbers[k + 1], numbers[k + 2]}});
  }
  return fronts;
}

constexpr const char* fronts_block = "fronts";
constexpr const char* files_block = "files";  // extents of history and probes
constexpr const char* snapshots_block = "snapshots";

std::vector<double> numbers_of(const io::HistoryExtent& history, const io::HistoryExtent& probes) {
  std::vector<double> numbers;
  for (const io::HistoryExtent& each : {history, probes}) {
    numbers.insert(numbers.end(), {static_cast<double>(each.rows), static_cast<double>(each.bytes), each.last_time});
  }
  return numbers;
}

std::array<io::HistoryExtent, 2> extents_of(const std::vector<double>& numbers) {
  StateNumbers state(numbers, "files");
  std::array<io::HistoryExtent, 2> extents;
  for (io::HistoryExtent& each : extents) {
    each.rows = static_cast<std::size_t>(state.whole(largest_whole));
    each.bytes = static_cast<std::size_t>(state.whole(largest_whole));
    each.last_time = state.next_finite();
  }
  state.expect_end();
  return extents;
}

}  // namespace

template <int Dim>
RunOutput<Dim>::RunOutput(const fs::path& folder, sim::RunRecords<Dim> records, io::HistoryWriter history,
                          io::SnapshotSeries snapshots)
    : folder_(folder),
      own_(folder),
      history_(std::move(history)),
      snapshots_(std::move(snapshots)),
      records_(std::move(records)) {}

template <int Dim>
RunOutput<Dim>::RunOutput(const fs::path& folder, const Simulation& simulation)
    : RunOutput(folder, simulation, first_part(simulation.parameters(), folder),
                config::resolved_toml(simulation.parameters(), "inputs")) {}

template <int Dim>
RunOutput<Dim>::RunOutput(const fs::path& folder, const Simulation& simulation, io::Provenance earlier,
                          std::string case_text)
    : RunOutput(folder, sim::RunRecords<Dim>(simulation, simulation.site()),
                io::HistoryWriter::start_in_run(folder / "history.csv"), io::SnapshotSeries(folder)) {
  provenance_ = std::move(earlier);
  case_text_ = std::move(case_text);
  complete(provenance_, simulation);
  write_provenance(simulation, "running", "", 0.0);
  write_terrain(folder, simulation);
  if constexpr (Dim == 3) {
    write_ground_maps(folder, simulation);
  }
}

template <int Dim>
void RunOutput<Dim>::write_first_state(const Simulation& simulation) {
  records_.start(simulation);
  if (records_.has_probes()) {
    probes_.emplace(io::HistoryWriter::start_in_run(folder_ / "probes.csv"));
  }
  write_history(simulation);
  write_snapshot(simulation);
}

template <int Dim>
void RunOutput<Dim>::begin(const Simulation& simulation) {
  write_first_state(simulation);
  write_state(simulation);
  stopwatch_ = {};
}

template <int Dim>
RunOutput<Dim> RunOutput<Dim>::resume(const fs::path& folder, const Simulation& simulation, const NamedNumbers& blocks,
                                      io::Provenance earlier, std::string case_text) {
  sim::RunRecords<Dim> records(simulation, simulation.site());
  records.restore(blocks);
  const auto [history_then, probes_then] = extents_of(block_of(blocks, files_block));
  std::vector<std::string>& warnings = earlier.parts.back().warnings;
  const auto continued = [&](const char* name, const io::HistoryWriter::Row& row, const io::HistoryExtent& extent) {
    return io::HistoryWriter::continue_after(folder / name, io::header_of(row), extent, warnings);
  };
  io::HistoryWriter history = continued("history.csv", records.history_row(simulation), history_then);
  io::SnapshotSeries snapshots = io::SnapshotSeries::continue_after(
      folder, block_of(blocks, snapshots_block), io::snapshot_fields(simulation.particles()), warnings);
  RunOutput output(folder, std::move(records), std::move(history), std::move(snapshots));
  if (output.records_.has_probes()) {
    output.probes_.emplace(continued("probes.csv", output.records_.probe_row(simulation), probes_then));
  }
  output.provenance_ = std::move(earlier);
  output.case_text_ = std::move(case_text);
  complete(output.provenance_, simulation);
  if (const auto fronts = blocks.find(fronts_block); fronts != blocks.end()) {
    output.fronts_ = fronts_of(fronts->second);
  }
  output.history_step_ = output.snapshot_step_ = output.checkpoint_step_ = simulation.step_number();
  output.write_provenance(simulation, "running", "", 0.0);
  return output;
}

template <int Dim>
void RunOutput<Dim>::write_history(const Simulation& simulation) {
  if (history_step_ != simulation.step_number()) {
    history_step_ = simulation.step_number();
    stopwatch_.time("write_history", [&] {
      history_.add(records_.history_row(simulation));
      if (probes_) {
        probes_->add(records_.probe_row(simulation));
      }
    });
  }
}

template <int Dim>
void RunOutput<Dim>::before_step(const Simulation& simulation) {
  provenance_.parts.back().particle_steps += static_cast<double>(simulation.particle_count());
}

template <int Dim>
void RunOutput<Dim>::after_step(const Simulation& simulation) {
  if constexpr (Dim == 3) {
    stopwatch_.time("gather_maps", [&] { records_.after_step(simulation); });
  }
}

template <int Dim>
void RunOutput<Dim>::slide_left() {
  slide_left_ = true;
  records_.slide_left();
}

template <int Dim>
double RunOutput<Dim>::front_position(const Simulation& simulation) const {
  if constexpr (Dim == 3) {
    const auto front = records_.front(simulation);
    return front ? front->along : std::nan("");
  } else {
    return sim::front_position(simulation);
  }
}

template <int Dim>
void RunOutput<Dim>::write_maps(const Simulation& simulation) {
  if constexpr (Dim == 3) {
    if (can_write_maps()) {
      own_.require();
      const std::string state = sim::when_text(sim::end_state(simulation, slide_left_));
      const MapTexts texts{(fs::absolute(folder_) / ".").lexically_normal().parent_path().filename().string(), state,
                           simulation.time(), simulation.parameters().maps.area_thickness};
      stopwatch_.time("write_maps", [&] { run::write_maps(folder_, records_, simulation.site(), fronts_, texts); });
    }
  }
}

// Key figures of the run so far, for run.json.
template <int Dim>
void RunOutput<Dim>::add_figures(const Simulation& simulation) {
  end_state_ = sim::end_state(simulation, slide_left_);
  provenance_.at_rest = end_state_.is_known ? std::optional(end_state_.at_rest) : std::nullopt;
  provenance_.warnings = sim::warnings_of(end_state_, provenance_.status == "done");
  provenance_.figures = sim::named(end_state_);
  if (const auto figures = records_.figures(simulation, sim::ground_height_of(simulation))) {
    const auto of_maps = sim::named(*figures);
    provenance_.figures.insert(provenance_.figures.end(), of_maps.begin(), of_maps.end());
  }
}

template <int Dim>
void RunOutput<Dim>::write_snapshot(const Simulation& simulation) {
  if (snapshot_step_ != simulation.step_number()) {
    own_.require();
    snapshot_step_ = simulation.step_number();
    if (const auto front = records_.front(simulation)) {
      fronts_.push_back({simulation.time(), front->position});
    }
    stopwatch_.time("write_snapshot", [&] {
      io::Snapshot snapshot = io::make_snapshot<Dim>(simulation.particles(), simulation.model().origin,
                                                     simulation.time(), simulation.step_number());
      snapshot.base = sim::base_table(simulation);
      snapshots_.add(std::move(snapshot));
    });
  }
}

template <int Dim>
void RunOutput<Dim>::write_state(const Simulation& simulation) {
  if (checkpoint_step_ == simulation.step_number()) {
    return;
  }
  own_.require();
  checkpoint_step_ = simulation.step_number();
  stopwatch_.time("write_checkpoint", [&] {
    // Flush all earlier output, because a resumed run depends on it.
    snapshots_.finish_writing();
    history_.synchronize();
    if (probes_) {
      probes_->synchronize();
    }
    NamedNumbers blocks = records_.state();
    blocks[files_block] = numbers_of(history_.extent(), probes_ ? probes_->extent() : io::HistoryExtent());
    blocks[snapshots_block] = snapshots_.state();
    if constexpr (Dim == 3) {
      blocks[fronts_block] = numbers_of(fronts_);
    }
    add_state<Dim>(simulation, blocks);
    io::write_checkpoint<Dim>(folder_, simulation.particles(), simulation.particles_at_start(), simulation.scalars(),
                              blocks, case_text_);
  });
}

template <int Dim>
void RunOutput<Dim>::write_checkpoint(const Simulation& simulation) {
  write_state(simulation);
  write_maps(simulation);
}

template <int Dim>
void RunOutput<Dim>::write_provenance(const Simulation& simulation, const std::string& status,
                                      const std::string& message, double wall_seconds) {
  own_.require();
  provenance_.status = status;
  provenance_.message = message;
  add_figures(simulation);
  provenance_.simulated_time = simulation.time();
  provenance_.steps = simulation.step_number();
  const sim::Removed& removed = simulation.removed();
  provenance_.removed = {{"left", removed.left}, {"not_finite", removed.not_finite}, {"volume", removed.volume}};
  provenance_.parts.back().wall_seconds = wall_seconds;
  provenance_.seconds_per_stage = simulation.stopwatch().seconds();
  provenance_.seconds_per_stage.insert(stopwatch_.seconds().begin(), stopwatch_.seconds().end());
  provenance_.writer_seconds = snapshots_.writer_seconds();
  io::write_provenance(folder_ / "run.json", provenance_);
}

template class RunOutput<2>;
template class RunOutput<3>;

}  // namespace thawslide::run
