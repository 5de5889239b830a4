#include "run/disk_need.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/rounding.hpp"
#include "io/checkpoint.hpp"
#include "io/run_folder.hpp"
#include "io/snapshot.hpp"
#include "run/input_files.hpp"
#include "run/map_output.hpp"
#include "sim/memory_need.hpp"
#include "sim/records/history.hpp"

namespace thawslide::run {

namespace fs = std::filesystem;

namespace {

constexpr double bytes_of_number = 19.0;      // in history.csv, including the comma: 16 digits, a point, an exponent
constexpr double columns_of_probe = 4.0;      // in probes.csv, for a section; a point has fewer
constexpr double bytes_besides_points = 1e4;  // of a snapshot, and of a checkpoint, which contains the case
constexpr double most_of_free = 0.9;          // fraction of the free disk that a run may use without a warning
constexpr double gigabyte = 1e9;

// Number of whole intervals until the end, plus one for the start. It is limited to the number of steps, unless steps
// are cut to the intervals. The last fixed step may end before the end of the run.
double count_of(const config::Time& time, double interval, double steps, bool cuts_steps) {
  const bool is_fixed = time.stepping == config::Stepping::fixed;
  const double last = is_fixed ? std::min(time.end, steps * time.step) : time.end;
  const double intervals = std::ceil(last / interval * (1.0 - 1e-12));
  return (cuts_steps ? intervals : std::min(intervals, steps)) + 1.0;
}

double bytes_of_files(const config::Case& parameters) {
  double bytes = 0.0;
  for (const fs::path& file : input_files(parameters)) {
    std::error_code unknown;
    const auto size = fs::file_size(file, unknown);
    bytes += unknown ? 0.0 : static_cast<double>(size);
  }
  return bytes;
}

// Maps at the end of the run; those of the ground are on the points of the DEM.
template <int Dim>
double bytes_of_maps(const sim::Simulation<Dim>& simulation, const sim::MapGrid& grid) {
  constexpr double ground_maps = 2.0;  // terrain and release
  const Raster* ground = simulation.site().ground.get();
  const double maps = static_cast<double>(sim::map_kinds().size()) + (simulation.model().ground ? 1.0 : 0.0);
  const double points = maps * grid.columns * grid.rows +
                        ground_maps * (ground == nullptr ? 0.0 : static_cast<double>(ground->values.size()));
  return points * sizeof(double);
}

}  // namespace

template <int Dim>
DiskNeed disk_need(const sim::Simulation<Dim>& simulation, const sim::FlowMaps* maps, double steps) {
  const config::Case& parameters = simulation.parameters();
  const config::Time& time = parameters.time;
  const double particles =
      static_cast<double>(simulation.particles().size()) * sim::splitting_factor(simulation.parameters());
  DiskNeed need;
  need.snapshots = count_of(time, time.output_interval, steps, time.stepping == config::Stepping::adaptive);
  need.snapshot = particles * static_cast<double>(io::snapshot_bytes_of_particle<Dim>(simulation.particles())) +
                  bytes_besides_points;
  // A checkpoint contains what is in memory: assume the same size.
  const sim::BodiesAtStart bodies = sim::bodies_at_start<Dim>(parameters, simulation.site());
  const sim::MemoryNeed memory = sim::memory_need<Dim>(parameters, simulation.site(), bodies);
  need.checkpoint = particles * static_cast<double>(io::checkpoint_bytes_of_particle<Dim>()) + bytes_besides_points +
                    memory.columns + memory.bed + memory.maps;
  need.history_rows = time.history_interval > 0.0 ? count_of(time, time.history_interval, steps, false) : steps + 1.0;
  const double columns = static_cast<double>(sim::history_row(simulation).size()) +
                         columns_of_probe * static_cast<double>(parameters.probes.size());
  need.history = need.history_rows * columns * bytes_of_number;
  need.inputs = bytes_of_files(parameters);
  need.maps = maps != nullptr && can_write_maps() ? bytes_of_maps(simulation, maps->map_grid()) : 0.0;
  return need;
}

double free_on_disk(const fs::path& folder) {
  std::error_code unknown;
  const fs::space_info space = fs::space(io::existing_part(folder), unknown);
  return unknown ? HUGE_VAL : static_cast<double>(space.available);
}

std::string warning_of_disk(const config::Case& parameters, const DiskNeed& need, double free, const fs::path& folder) {
  if (!(need.total() > most_of_free * free)) {
    return "";
  }
  const double of_snapshots = need.snapshots * need.snapshot;
  const bool is_history = need.history > of_snapshots;
  const std::string key = is_history ? "time.history_interval" : "time.output_interval";
  const double interval = is_history ? parameters.time.history_interval : parameters.time.output_interval;
  const std::string what = is_history
                               ? fmt::format("{} rows of history.csv, {} GB", rounded_text(need.history_rows),
                                             rounded_text(need.history / gigabyte))
                               : fmt::format("{} snapshots of {} MB, {} GB", count_text(need.snapshots),
                                             rounded_text(need.snapshot / 1e6), rounded_text(of_snapshots / gigabyte));
  return fmt::format(
      "{}: {} is {:g} s: that is {}; with all else {} GB, and {} GB are free where {} is. Make it larger, or write to "
      "another disk (--output).",
      config::location_of(parameters, key), key, interval, what, rounded_text(need.total() / gigabyte),
      rounded_text(free / gigabyte), folder.string());
}

template DiskNeed disk_need<2>(const sim::Simulation<2>&, const sim::FlowMaps*, double);
template DiskNeed disk_need<3>(const sim::Simulation<3>&, const sim::FlowMaps*, double);

}  // namespace thawslide::run
