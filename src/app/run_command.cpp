// thawslide run.
#include "app/commands.hpp"
#include "app/device_choice.hpp"
#include "app/input_guard.hpp"
#include "app/map_files.hpp"
#include "app/print.hpp"
#include "app/run_loop.hpp"
#include "app/setup_warnings.hpp"
#include "app/signals.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "config/input_limits.hpp"
#include "config/read_case.hpp"
#include "io/run_folder.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

int run_case(const RunOptions& options) {
  survive_closed_pipes();
  use_threads(options.threads);
  const config::Case parameters = config::read_case(options.of_case.file, options.of_case.sets);
  const fs::path folder = options.output.empty() ? usual_run_folder(parameters) : fs::path(options.output);
  require_readable_inputs(parameters);
  require_no_input_in(folder, parameters);
  io::require_usable(folder, options.overwrite);
  return with_dimension(parameters.general.dimension, [&]<int Dim>(std::integral_constant<int, Dim> /*dimension*/) {
    Warnings warnings;
    sim::Simulation<Dim> simulation(parameters, read_map_files(parameters, warnings));
    {
      sim::RunRecords<Dim> records(simulation, simulation.site());  // throws before any file is written or removed
      records.start(simulation);
      add_setup_warnings(simulation, sim::body_figures(simulation),
                         disk_need(simulation, records.maps(), steps_to_end(simulation)), folder, warnings);
    }
    const std::string device = use_device<Dim>(options.device, simulation);
    const io::RunLock lock = io::make_run_folder(folder, options.overwrite);
    RunOutput<Dim> output(folder, simulation);
    print_text("{}: {} particles, {:g} s to simulate, on {} thread{}{}\n",
               config::shown(parameters.general.title.empty() ? parameters.name : parameters.general.title),
               simulation.particles().size(), parameters.time.end, thread_count(), thread_count() == 1 ? "" : "s",
               device.empty() ? "" : " and " + device);
    return start_and_run<Dim>(simulation, output, folder);
  });
}

}  // namespace thawslide::app
