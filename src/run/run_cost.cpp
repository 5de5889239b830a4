#include "run/run_cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/clocks.hpp"
#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "device/gpu.hpp"
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

constexpr double enough_seconds = 0.5;
constexpr int enough_steps = 200;

// Cost of a run over that of its first steps: a slide that spreads touches more nodes and columns. Measured on whole
// runs: 1.2 to 2.3 (plane, Lamplugh, entrainment), and with band columns 3.0 to 3.3 (slope of the Alps, Lamplugh).
double spreading_factor(const config::Case& parameters) {
  const double of_splitting = std::min(sim::usual_cost_of_splitting, sim::splitting_factor(parameters));
  return of_splitting * (config::has_band_columns(parameters) ? 3.1 : 1.7);
}

// Calls step() for up to `enough_seconds` of a clock; returns the number of calls.
template <class Step, class Clock>
int repeat(const Step& step, const Clock& clock) {
  const double start = clock();
  int steps = 0;
  while (steps < enough_steps && clock() - start < enough_seconds && step()) {
    ++steps;
  }
  return std::max(steps, 1);
}

// Performs a step unless the run has ended, or all particles have left.
template <int Dim>
bool advance(sim::Simulation<Dim>& simulation) {
  const double end = simulation.parameters().time.end;
  if (simulation.time() >= end || !simulation.left_text().empty()) {
    return false;
  }
  simulation.step(simulation.next_step(end));
  return true;
}

constexpr double bytes_of_number = 19.0;      // in history.csv, including the comma: 16 digits, a point, an exponent
constexpr double columns_of_probe = 4.0;      // in probes.csv, for a section; a point has fewer
constexpr double bytes_besides_points = 1e4;  // of a snapshot, and of a checkpoint, which contains the case
constexpr double most_of_free = 0.9;          // fraction of the free disk that a run may use without a warning
constexpr double gigabyte = 1e9;

// Number of intervals until the last step ends, plus one; at most that of steps, unless these are cut to intervals.
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
double steps_to_end(sim::Simulation<Dim>& simulation) {
  const config::Time& time = simulation.parameters().time;
  const double steps = time.end / simulation.next_step(time.end) * (1.0 - 1e-12);
  // Fixed steps may end the run up to half a step early; adaptive steps are cut to end exactly.
  return time.stepping == config::Stepping::fixed ? std::max(1.0, std::ceil(steps - 0.5)) : std::ceil(steps);
}

template <int Dim>
RunCost cost_on_cpu(sim::Simulation<Dim>& simulation, double steps) {
  const ThreadScope one_thread(1);
  const double wall = wall_clock(), processor = thread_clock();
  const int performed = repeat([&] { return advance(simulation); }, thread_clock);
  const double seconds = thread_clock() - processor;
  const double slowdown = (wall_clock() - wall) / seconds;
  return {steps, seconds / performed * steps * spreading_factor(simulation.parameters()), slowdown};
}

template <int Dim>
RunCost cost_on_device(sim::Simulation<Dim>& simulation, double steps) {
  const double wall = wall_clock();
  const int performed = repeat([&] { return advance(simulation); }, wall_clock);
  return {steps, (wall_clock() - wall) / performed * steps};
}

std::string text_of(const RunCost& cost) {
  constexpr double busy = 1.25;
  return fmt::format("{} of processor time{}", duration_text(cost.processor),
                     cost.slowdown < busy ? ""
                                          : fmt::format(" (this machine is busy: {} of wall-clock time on one thread)",
                                                        duration_text(cost.slowdown * cost.processor)));
}

GpuFacts detect_gpu() {
  const device::Gpu gpu = device::find_gpu();
  return {gpu.name, gpu.unavailable_reason, gpu.free, 0.0, 0.0};
}

template <int Dim>
std::string use_device(const std::string& device, sim::Simulation<Dim>& simulation) {
  if (device == "cpu") {
    return "";
  }
  if (device != "gpu" && device != "auto") {
    throw UserError("device is '{}'; allowed: cpu, gpu, auto.", device);
  }
  const device::Gpu gpu = device::find_gpu();
  if (!gpu.is_usable && device == "auto") {
    return "";
  }
  if (!gpu.is_usable) {
    throw UserError("--device gpu: {}. Run the case on the CPU: --device cpu", gpu.unavailable_reason);
  }
  simulation.use_device(gpu.name, device::on_gpu<Dim>());
  return gpu.name;
}

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

#define THAWSLIDE_INSTANTIATE(Dim)                                                             \
  template DiskNeed disk_need<Dim>(const sim::Simulation<Dim>&, const sim::FlowMaps*, double); \
  template double steps_to_end<Dim>(sim::Simulation<Dim>&);                                    \
  template RunCost cost_on_cpu<Dim>(sim::Simulation<Dim>&, double);                            \
  template RunCost cost_on_device<Dim>(sim::Simulation<Dim>&, double);                         \
  template std::string use_device<Dim>(const std::string&, sim::Simulation<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::run
