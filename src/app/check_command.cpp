// thawslide check: what a run of the case will take, and its picture before it starts.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/map_files.hpp"
#include "app/map_output.hpp"
#include "app/progress.hpp"
#include "app/run_loop.hpp"
#include "app/setup_json.hpp"
#include "app/substrate_list.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "config/case_proposal.hpp"
#include "config/read_case.hpp"
#include "io/atomic_file.hpp"
#include "io/snapshot.hpp"
#include "sim/release_body.hpp"
#include "sim/run_records.hpp"

namespace thawslide::app {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr double trial_seconds = 0.5;  // of wall time, to measure the step
constexpr int trial_steps = 200;

void draw(const Json& setup, const std::string& picture) {
  const fs::path file = fs::temp_directory_path() / fmt::format("thawslide-setup-{}.json", getpid());
  io::write_file_atomically(file, setup.dump());
  std::fflush(stdout);  // what was said so far stands before what the child says
  const pid_t child = fork();
  if (child == 0) {
    execlp("thawslide-report", "thawslide-report", "--setup", file.c_str(), "--picture", picture.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  fs::remove(file);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw UserError(
        fmt::format("the picture was not drawn: thawslide-report {}. It is part of the Python package: "
                    "`./run --setup` installs it into .venv; put .venv/bin on PATH.",
                    WIFEXITED(status) && WEXITSTATUS(status) == 127 ? "is not on PATH" : "failed"));
  }
}

// setup.png, of a variant its name before it: several case files may share a folder.
std::string picture_beside(const fs::path& case_file) {
  const std::string variant = case_file.stem() == "case" ? "" : case_file.stem().string() + "-";
  return (case_file.parent_path() / (variant + "setup.png")).string();
}

// Seconds one step takes now, measured on the first steps.
template <int Dim>
double measured_step_seconds(sim::Simulation<Dim, double>& simulation) {
  const auto start = std::chrono::steady_clock::now();
  double elapsed = 0.0;
  int steps = 0;
  while (steps < trial_steps && elapsed < trial_seconds && simulation.time() < simulation.parameters().time.end) {
    simulation.step(simulation.next_step(simulation.parameters().time.end));
    ++steps;
    elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return elapsed / steps;
}

// What each release comes to.
void print_releases(const config::Case& parameters, const config::Site& site) {
  for (const auto& [name, release] : site.releases) {
    const double volume = volume_of(release.thickness);
    double covered = 0.0, thickest = 0.0;
    for (const double thickness : release.thickness.values) {
      covered += thickness > 0.0 ? 1.0 : 0.0;
      thickest = std::max(thickest, std::isnan(thickness) ? 0.0 : thickness);
    }
    covered *= release.thickness.cell_x * release.thickness.cell_y;
    const double area = release.area > 0.0 ? release.area : covered;  // a raster of thickness has no outline
    const double median = config::median_thickness(release.thickness), cell = parameters.grid.cell;
    const int per_axis = parameters.bodies.at(name).particles_per_axis;
    fmt::print(
        "  release     {}: {:.4g} m3 over {:.4g} m2, {:.3g} m thick in the median and {:.3g} m at most (vertical)\n"
        "              {:.2g} particles across in the median and {:.2g} at most\n",
        name, volume, area, median, thickest, median * per_axis / cell, thickest * per_axis / cell);
    if (const std::string note = config::resolution_note(name, median, cell, per_axis); !note.empty()) {
      fmt::print("note: {}\n", note);
    }
  }
}

// What maps take in memory, and what they would if the slide passed all of them.
void print_maps(const sim::FlowMaps& maps, const std::string& reason) {
  const sim::MapGrid& grid = maps.map_grid();
  const double cells = static_cast<double>(grid.columns) * grid.rows;
  fmt::print("  maps        {} x {} cells of {:g} x {:g} m ({}); memory {:.1f} MB for the release, at most {:.1f} MB\n",
             grid.columns, grid.rows, grid.cell_x, grid.cell_y, reason, static_cast<double>(maps.bytes()) / 1e6,
             cells * static_cast<double>(sim::FlowMaps::bytes_of_cell() + sizeof(double)) / 1e6);
}

constexpr double ground_map_count = 2;  // terrain and release, on the DEM's points

// Bytes of the snapshots and of the maps, as if none of these could be compressed; the other files are small.
template <int Dim>
void print_disk(const sim::Simulation<Dim, double>& simulation, const sim::FlowMaps* maps) {
  const config::Time& time = simulation.parameters().time;
  const double count = std::ceil(time.end / time.output_interval * (1.0 - 1e-12)) + 1.0;
  const auto bytes = static_cast<double>(
      io::snapshot_bytes(io::take_snapshot<Dim, double>(simulation.particles(), simulation.model().origin, 0.0, 0))
          .size());
  std::string of_maps;
  double map_bytes = 0.0;
  if (maps != nullptr && can_write_maps()) {
    const auto kinds = static_cast<double>(sim::map_kinds().size());
    const double one = static_cast<double>(maps->map_grid().columns) * maps->map_grid().rows * sizeof(double);
    const Raster* ground = simulation.site().ground.get();
    const double of_ground = ground == nullptr ? 0.0 : ground_map_count;
    const double one_of_ground = ground == nullptr ? 0.0 : static_cast<double>(ground->values.size()) * sizeof(double);
    map_bytes = kinds * one + of_ground * one_of_ground;
    const std::string sizes = ground == nullptr ? fmt::format("of {:.1f} MB", one / 1e6)
                                                : fmt::format("({:.0f} of {:.1f} MB, {:.0f} of {:.1f} MB)", kinds,
                                                              one / 1e6, of_ground, one_of_ground / 1e6);
    of_maps = fmt::format(", {:.0f} maps {} before they are compressed", kinds + of_ground, sizes);
  }
  fmt::print("  disk        {} {:.0f} MB: {:.0f} snapshots of {:.1f} MB{}\n", of_maps.empty() ? "about" : "at most",
             (count * bytes + map_bytes) / 1e6, count, bytes / 1e6, of_maps);
}

double peak_memory_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace

int check_case(const CheckOptions& options) {
  use_threads(options.threads);
  const config::Case parameters = config::read_case(options.of_case.file, options.of_case.sets);
  return with_dimension(parameters.general.dimension, [&]<int Dim>(std::integral_constant<int, Dim> /*dimension*/) {
    sim::Simulation<Dim, double> simulation(parameters, read_map_files(parameters));
    sim::RunRecords<Dim> records(simulation, simulation.site());  // maps, path and probes can be gathered
    records.start(simulation);
    print_map_note(parameters, simulation.site());
    print_notices(parameters);
    const Json setup = options.draws ? setup_json<Dim>(simulation) : Json();
    const auto limit = simulation.step_limit();
    const double dt = simulation.next_step(parameters.time.end);
    const double steps = std::ceil(parameters.time.end / dt * (1.0 - 1e-12));
    double cells = 1.0;
    for (std::size_t a = 0; a < Dim; ++a) {
      cells *= (parameters.grid.max[a] - parameters.grid.min[a]) / parameters.grid.cell;
    }
    fmt::print("{}: the case is sound\n", parameters.file);
    print_releases(parameters, simulation.site());
    print_substrates(parameters, simulation.site());
    fmt::print("  particles   {}\n", simulation.particles().size());
    fmt::print("  cells       {:.0f} in the domain; blocks of {} nodes held: {}\n", cells, mpm::Tile<Dim>::nodes,
               simulation.grid().blocks().size());
    fmt::print("  step        {:g} s{}; the limit is {:.4g} s, set by {}\n", dt,
               parameters.time.stepping == config::Stepping::fixed ? "" : " at the start (adaptive)", limit.step,
               limit.what);
    fmt::print("  steps       {:.0f}\n", steps);
    const double seconds = measured_step_seconds<Dim>(simulation);
    fmt::print("  memory      {:.0f} MB\n", peak_memory_megabytes());
    if (records.maps() != nullptr) {
      print_maps(*records.maps(), sim::reason_for_map_cell(parameters, simulation.site()));
    }
    print_disk(simulation, records.maps());
    fmt::print("  time        about {} on {} thread{} (measured on the first steps)\n", duration_text(seconds * steps),
               thread_count(), thread_count() == 1 ? "" : "s");
    if (options.draws) {
      const std::string picture = options.picture.empty() ? picture_beside(parameters.file) : options.picture;
      draw(setup, picture);
      fmt::print("  picture     {}\n", picture);
    }
    return static_cast<int>(ExitCode::done);
  });
}

}  // namespace thawslide::app
