// thawslide check: resources and warnings of a case, and a figure of its setup, before a run.
#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "app/commands.hpp"
#include "app/setup_facts.hpp"
#include "app/terminal.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "config/notices.hpp"
#include "config/read_case.hpp"
#include "run/input_files.hpp"
#include "run/run_cost.hpp"
#include "run/run_loop.hpp"
#include "run/setup.hpp"
#include "sim/records/run_records.hpp"

namespace thawslide::app {

namespace {

// Speed and memory of the run on a GPU, tested from the state that the trial on the CPU has reached.
template <int Dim>
run::GpuFacts gpu_facts(sim::Simulation<Dim>& simulation, sim::RunRecords<Dim>& records, double steps) {
  run::GpuFacts facts = run::detect_gpu();
  if (!facts.unavailable_reason.empty()) {
    return facts;
  }
  const double end = simulation.parameters().time.end;
  try {
    run::use_device<Dim>("gpu", simulation);
    if (simulation.time() < end) {
      simulation.step(simulation.next_step(end));  // copies particles to the GPU
      records.after_step(simulation);
      static_cast<void>(records.history_row(simulation));  // allocates memory on the GPU as well
      static_cast<void>(simulation.front(simulation.moved_mass()));
    }
    if (!(simulation.time() < end)) {
      facts.unavailable_reason = "the run ends before a step on it could be timed";
      return facts;
    }
    facts.seconds = run::cost_on_device<Dim>(simulation, steps).processor;
    facts.used = facts.free - run::detect_gpu().free;
  } catch (const std::runtime_error& error) {  // the CPU results remain valid
    facts.unavailable_reason = error.what();
  }
  return facts;
}

std::vector<MapFacts> map_facts(const config::Case& parameters, const config::Site& site, const sim::FlowMaps* maps) {
  if (maps == nullptr) {
    return {};
  }
  const sim::MapGrid& grid = maps->map_grid();
  const double cells = static_cast<double>(grid.columns) * grid.rows;
  return {{grid.columns, grid.rows, grid.cell_x, grid.cell_y, sim::reason_for_map_cell(parameters, site),
           static_cast<double>(maps->bytes()),
           cells * static_cast<double>(sim::FlowMaps::bytes_of_cell() + sizeof(double))}};
}

// Facts known before the first step.
template <int Dim>
SetupFacts facts_of(sim::Simulation<Dim>& simulation, const sim::RunRecords<Dim>& records) {
  const config::Case& parameters = simulation.parameters();
  SetupFacts facts;
  facts.file = parameters.file;
  facts.dimension = Dim;
  if (parameters.general.width.varies()) {
    facts.width_varies_from = parameters.general.width.table.abscissa.front();
  }
  facts.bodies = sim::body_figures(simulation);
  facts.substrates = substrate_facts(parameters, simulation.site());
  if (const auto* bed = simulation.bed()) {
    facts.bed_volume = bed->sums().initial / bed->material().density;
  }
  facts.roughness = simulation.site().roughness;
  facts.particles = simulation.particles().size();
  facts.cells = 1.0;
  for (std::size_t a = 0; a < Dim; ++a) {
    facts.cells *= (parameters.grid.max[a] - parameters.grid.min[a]) / parameters.grid.cell;
  }
  for (const sim::BodyFigures& body : facts.bodies) {
    const double across = Dim == 3 && simulation.model().ground ? body.median_thickness / parameters.grid.cell : 0.0;
    facts.cells_across = facts.cells_across > 0.0 ? std::min(facts.cells_across, across) : across;
  }
  facts.resolution = config::resolution_with(facts.cells_across);
  facts.blocks = simulation.grid().blocks().size();
  facts.nodes_of_block = mpm::Tile<Dim>::nodes;
  facts.step = simulation.next_step(parameters.time.end);
  facts.is_adaptive = parameters.time.stepping == config::Stepping::adaptive;
  facts.limit = simulation.step_limit();
  facts.steps = run::steps_to_end(simulation);
  double area = 0.0;
  for (const sim::BodyFigures& body : facts.bodies) {
    area += body.area;
  }
  facts.memory = sim::memory_need<Dim>(parameters, simulation.site(), {static_cast<double>(facts.particles), area});
  facts.available = available_memory();
  facts.maps = map_facts(parameters, simulation.site(), records.maps());
  facts.disk = run::disk_need(simulation, records.maps(), facts.steps);
  const std::filesystem::path folder = run::usual_run_folder(parameters);
  facts.disk_folder = folder.string();
  facts.free_disk = run::free_on_disk(folder);
  facts.threads = thread_count();
  return facts;
}

}  // namespace

int check_case(const CheckOptions& options) {
  use_threads(options.threads);
  const config::Case parameters = config::read_case(options.of_case.file, options.of_case.sets);
  return run::with_dimension(parameters.general.dimension, [&]<int Dim>(
                                                               std::integral_constant<int, Dim> /*dimension*/) {
    Terminal terminal;
    run::Warnings warnings(options.json ? nullptr : &terminal);
    sim::Simulation<Dim> simulation = config::with_unusual_numbers(
        parameters, [&] { return sim::Simulation<Dim>(parameters, run::read_map_files(parameters, warnings)); });
    sim::RunRecords<Dim> records(simulation, simulation.site());  // checks that maps, path and probes can be recorded
    records.start(simulation);
    SetupFacts facts = facts_of<Dim>(simulation, records);
    run::add_setup_warnings(simulation, facts.bodies, warnings);
    warnings.add(run::warning_of_disk(parameters, facts.disk, facts.free_disk, facts.disk_folder));
    facts.warnings = warnings.all();
    nlohmann::ordered_json setup;  // of the initial state, which the trial steps change
    if (options.draws) {
      facts.picture = options.picture.empty() ? picture_path(parameters.file) : options.picture;
      run::require_no_input_at(facts.picture, "--picture", parameters);
      setup = setup_json<Dim>(simulation);
    }
    const auto report = [&] {
      fmt::print("{}", options.json ? json_of(facts) : text_of(facts));
      if (options.draws) {
        draw_setup(setup, facts.picture);
      }
    };
    try {
      facts.cost = run::cost_on_cpu<Dim>(simulation, facts.steps);
      facts.gpu = gpu_facts<Dim>(simulation, records, facts.steps);
    } catch (const RunError& error) {  // earlier facts remain valid
      facts.error = error.what();
      report();
      throw;
    }
    report();
    return static_cast<int>(ExitCode::done);
  });
}

}  // namespace thawslide::app
