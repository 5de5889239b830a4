// thawslide run, thawslide resume.
#include "app/commands.hpp"
#include "app/map_files.hpp"
#include "app/progress.hpp"
#include "app/run_loop.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/state_numbers.hpp"
#include "config/read_case.hpp"
#include "io/checkpoint.hpp"
#include "io/run_folder.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

namespace {

// Settles a case that asks for it; a body that goes bad on the way leaves its files as any other run does.
template <int Dim>
void settle(sim::Simulation<Dim, double>& simulation, const fs::path& folder) {
  if (!simulation.needs_settling()) {
    return;
  }
  fmt::print("settling under gravity for {:g} s\n", simulation.parameters().mechanics.settle_time);
  try {
    simulation.settle();
  } catch (const RunError& error) {
    RunOutput<Dim> output(folder, simulation);
    output.write_index();
    output.write_provenance(simulation, "failed", error.what(), 0.0);
    throw;
  }
}

}  // namespace

int run_case(const RunOptions& options) {
  use_threads(options.threads);
  const config::Case parameters = config::read_case(options.of_case.file, options.of_case.sets);
  const fs::path folder = options.output.empty() ? fs::path("runs") / parameters.name : fs::path(options.output);
  io::require_usable(folder, options.overwrite);
  return with_dimension(parameters.general.dimension, [&]<int Dim>(std::integral_constant<int, Dim> /*dimension*/) {
    sim::Simulation<Dim, double> simulation(parameters, read_map_files(parameters));
    const sim::RunRecords<Dim> records(simulation, simulation.site());  // refused before anything is written
    print_map_note(parameters, simulation.site());
    print_notices(parameters);
    io::make_run_folder(folder, options.overwrite);
    fmt::print("{}: {} particles, {:g} s to simulate, on {} thread{}\n",
               parameters.general.title.empty() ? parameters.name : parameters.general.title,
               simulation.particles().size(), parameters.time.end, thread_count(), thread_count() == 1 ? "" : "s");
    settle<Dim>(simulation, folder);
    RunOutput<Dim> output(folder, simulation);
    output.begin(simulation);
    return run_to_end<Dim>(simulation, output, folder);
  });
}

int resume_run(const ResumeOptions& options) {
  use_threads(options.threads);
  const fs::path folder = options.folder;
  const io::WholeCheckpoint checkpoint = io::newest_checkpoint(folder);
  const config::Case parameters = config::read_case(folder);
  return with_dimension(parameters.general.dimension, [&]<int Dim>(std::integral_constant<int, Dim> /*dimension*/) {
    sim::Simulation<Dim, double> simulation(parameters, read_map_files(parameters));
    std::vector<double> scalars;
    const NamedNumbers blocks = io::read_checkpoint<Dim, double>(checkpoint, simulation.particles(), scalars);
    simulation.restore(scalars);
    if (simulation.band_columns() != nullptr) {
      simulation.restore_band_columns(block_of(blocks, "band_columns"));
    }
    if (simulation.bed() != nullptr) {
      simulation.restore_bed(block_of(blocks, "bed"));
    }
    if (simulation.time() >= parameters.time.end - 0.5 * simulation.last_step()) {
      fmt::print("{} has reached its end at {:g} s; nothing to do\n", folder.string(), simulation.time());
      return static_cast<int>(ExitCode::done);
    }
    if (!checkpoint.note.empty()) {
      fmt::print("note: {}; going on from the checkpoint before\n", checkpoint.note);
    }
    fmt::print("going on from t = {:g} s\n", simulation.time());
    RunOutput<Dim> output = RunOutput<Dim>::resume(folder, simulation, blocks);
    return run_to_end<Dim>(simulation, output, folder);
  });
}

}  // namespace thawslide::app
