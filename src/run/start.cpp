#include "run/start.hpp"

#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "config/input_limits.hpp"
#include "config/notices.hpp"
#include "io/run_folder.hpp"
#include "run/device_choice.hpp"
#include "run/disk_need.hpp"
#include "run/input_files.hpp"
#include "run/run_cost.hpp"
#include "run/run_loop.hpp"
#include "run/setup.hpp"

namespace thawslide::run {

namespace fs = std::filesystem;

ExitCode start_run(const config::Case& parameters, const StartOptions& options, Observer& observer) {
  const fs::path folder = options.folder.empty() ? usual_run_folder(parameters) : options.folder;
  require_readable_inputs(parameters);
  require_no_input_in(folder, parameters);
  io::require_usable(folder, options.overwrite);
  return with_dimension(parameters.general.dimension, [&]<int Dim>(std::integral_constant<int, Dim> /*dimension*/) {
    Warnings warnings(&observer);
    sim::Simulation<Dim> simulation = config::with_unusual_numbers(
        parameters, [&] { return sim::Simulation<Dim>(parameters, read_map_files(parameters, warnings)); });
    {
      sim::RunRecords<Dim> records(simulation, simulation.site());  // throws before any file is written or removed
      records.start(simulation);
      add_setup_warnings(simulation, sim::body_figures(simulation), warnings);
      warnings.add(warning_of_disk(parameters, disk_need(simulation, records.maps(), steps_to_end(simulation)),
                                   free_on_disk(folder), folder));
    }
    const std::string device = use_device<Dim>(options.device, simulation);
    const io::RunLock lock = io::make_run_folder(folder, options.overwrite);
    RunOutput<Dim> output(folder, simulation);
    observer.line("{}: {} particles, {:g} s to simulate, on {} thread{}{}",
                  config::shown(parameters.general.title.empty() ? parameters.name : parameters.general.title),
                  count_text(static_cast<double>(simulation.particles().size())), parameters.time.end, thread_count(),
                  thread_count() == 1 ? "" : "s", device.empty() ? "" : " and " + device);
    return start_and_run<Dim>(simulation, output, folder, observer);
  });
}

}  // namespace thawslide::run
