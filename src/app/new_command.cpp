// thawslide new: creates a case folder from a DEM and a release area.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>

#include "app/case_folder.hpp"
#include "app/commands.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "base/text.hpp"
#include "run/input_files.hpp"
#include "run/run_cost.hpp"
#include "run/run_loop.hpp"

#ifdef THAWSLIDE_WITH_GIS

#include "base/atomic_file.hpp"
#include "config/case_proposal.hpp"
#include "config/read_case.hpp"
#include "config/resolution.hpp"
#include "gis/point_window.hpp"
#include "gis/raster_file.hpp"
#include "gis/site.hpp"
#include "sim/memory_need.hpp"
#include "sim/records/run_records.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

namespace {

constexpr double many_particles = 1e6;

// Writes the original DEM, cropped to the domain with a margin of some cells.
void write_cropped_dem(const fs::path& file, const config::Site& site, const config::Proposal& proposal,
                       const std::optional<config::Proposal>& quick) {
  const Raster& ground = *site.ground;
  const config::Proposal& coarser = quick ? *quick : proposal;
  const double margin = 3.0 * coarser.cell;
  const gis::Rectangle about =
      gis::Rectangle{std::min(proposal.min[0], coarser.min[0]), std::min(proposal.min[1], coarser.min[1]),
                     std::max(proposal.max[0], coarser.max[0]), std::max(proposal.max[1], coarser.max[1])}
          .widened(margin + 2.0 * ground.cell_x, margin + 2.0 * ground.cell_y);
  const Raster cropped = gis::part_of(ground, gis::points_in(ground, about));
  gis::write_geotiff(file.string(), cropped, {"m", "elevation", site.heights});
}

// A release extends one cell of the DEM beyond its last points. At the DEM's last points, there is no ground below it.
void require_ground_about(const std::string& file, const Raster& ground, const Raster& thickness) {
  std::array<bool, 4> reached{};  // west, east, south, north
  constexpr std::array<const char*, 4> sides{"west", "east", "south", "north"};
  const gis::PointWindow window = gis::points_of(thickness, ground);
  for_each_point(thickness, [&](int column, int row, double value) {
    if (value > 0.0) {
      const int i = window.first_column + column, j = window.first_row + row;
      reached[0] = reached[0] || i == 0;
      reached[1] = reached[1] || i == ground.columns - 1;
      reached[2] = reached[2] || j == 0;
      reached[3] = reached[3] || j == ground.rows - 1;
    }
  });
  for (std::size_t k = 0; k < sides.size(); ++k) {
    if (reached[k]) {
      throw UserError(
          "--release: {}: the release reaches the outermost points of the DEM in the {} (needed: at least {:g} m, one "
          "cell, beyond the release). Use a DEM that covers the flow path too.",
          file, sides[k], k < 2 ? ground.cell_x : ground.cell_y);
    }
  }
}

// Width of the filter of the DEM [m]: that against noise and bumps in the domain, at least the cell of `quick`.
double filter_of(config::Case trial, const config::Proposal& proposal) {
  trial.grid.min = proposal.min;
  trial.grid.max = proposal.max;
  trial.grid.cell = config::cell_of(config::Resolution::quick, proposal);  // so that all cells have the same ground
  trial.terrain.smooth.is_auto = true;
  return std::max(trial.grid.cell, reopen_site(trial).roughness->width);
}

std::string reason_for_cell(const config::Proposal& proposal, const NewOptions& options) {
  if (options.cell > 0.0) {
    return fmt::format("--cell: a release {} m thick with cells of {:g} m", rounded_text(proposal.thickness, 3),
                       proposal.cell);
  }
  return fmt::format("{}: a release {} m thick requires cells of {:g} m",
                     options.resolution.empty() ? "--thickness" : "--resolution " + options.resolution,
                     rounded_text(proposal.thickness, 3), proposal.cell);
}

// Limits the number of cells along each axis to that of a valid case.
void require_resolvable(const config::Proposal& proposal, const NewOptions& options) {
  constexpr double fewest = 2.0, most = 5e5;
  for (std::size_t a = 0; a < 3; ++a) {
    const double cells = (proposal.max[a] - proposal.min[a]) / proposal.cell;
    if (!(cells >= fewest && cells <= most)) {
      throw UserError("{}, and the terrain about it would have {} of them along {}; allowed: {} to {}. {}",
                      reason_for_cell(proposal, options), count_text(std::max(0.0, std::round(cells))), "xyz"[a],
                      count_text(fewest), count_text(most),
                      options.cell > 0.0 ? "Give another --cell." : "Is the thickness in metres?");
    }
  }
}

// Checks memory before any file is written, with a message for a user who has no case yet.
void require_memory(const config::Proposal& proposal, const NewOptions& options) {
  const sim::MemoryNeed need = sim::memory_of_particles<3>(proposal.particles);
  const AvailableMemory available = available_memory();
  if (need.total() > available.bytes) {
    throw UserError(
        "{} and {} particles; they need about {} GB of memory, and {} GB {}. Set --cell {:g} or more, which is "
        "coarser{}.{}",
        reason_for_cell(proposal, options), rounded_text(proposal.particles), rounded_text(need.total() / 1e9),
        rounded_text(available.bytes / 1e9), available.bound,
        sim::smallest_cell<3>(need, proposal.cell, available.bytes),
        options.resolution.empty() ? "" : ", instead of --resolution",
        options.cell > 0.0 ? "" : " Is the thickness in metres?");
  }
}

// Refuses a proposal that would run for days, because the release is thin for its area.
void require_affordable(const config::Proposal& proposal, const NewOptions& options) {
  constexpr double most = 5e6;
  if (options.cell > 0.0 || proposal.particles <= most) {
    return;
  }
  throw UserError(
      "{} and {} particles; allowed without --cell: {}. Is the thickness in metres? If it is, set --cell {:g} or more, "
      "which is coarser, or use a depth-averaged program for so thin a release.",
      reason_for_cell(proposal, options), rounded_text(proposal.particles), rounded_text(most),
      rounded_up(proposal.cell * std::cbrt(proposal.particles / most), 2));
}

// Copies the release and the outlines of substrates, with the files that belong to them.
void copy_polygons(const fs::path& folder, const config::Case& trial) {
  config::Case polygons_alone;
  polygons_alone.bodies = trial.bodies;
  polygons_alone.substrates = trial.substrates;
  for (const fs::path& file : run::input_files(polygons_alone)) {
    fs::copy_file(file, folder / file.filename());
  }
}

// Calls work() in a new folder, which is removed if it throws; of an empty one that existed, only the contents.
template <class Work>
void in_new_folder(const fs::path& folder, const Work& work) {
  const bool was_there = fs::exists(folder);
  make_new_folder(folder);
  try {
    work();
  } catch (...) {
    std::error_code ignored;
    for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end; entry.increment(ignored)) {
      fs::remove_all(entry->path(), ignored);
    }
    if (!was_there) {
      fs::remove(folder, ignored);
    }
    throw;
  }
}

// Removes file locations such as "case.toml:28:15: " from a message, because the file is not kept.
std::string without_places(std::string message, const std::string& file) {
  for (std::size_t at = message.find(file); at != std::string::npos; at = message.find(file, at)) {
    const std::size_t end = message.find_first_not_of(":0123456789", at + file.size());
    const bool is_location = end != std::string::npos && end > at + file.size() && message[end] == ' ';
    message.replace(at, is_location ? end + 1 - at : file.size(), is_location ? "" : "the case");
  }
  return message;
}

// States the proposed cell and its cost, and the named resolutions except `chosen` (empty: the user specified the
// cell), with their times unless so few particles run that they take none.
std::string resolution_text(const config::Proposal& proposal, const std::string& chosen, const run::RunCost& cost) {
  constexpr double fewest_timed_particles = 1000.0;
  std::string errors, others;
  for (const config::ResolutionFacts& each : config::resolutions) {
    if (chosen == each.name) {
      errors = fmt::format("; {}", each.errors);
      continue;
    }
    const double cell = config::cell_of(each.resolution, proposal);
    const double seconds = cost.processor * config::run_time_factor(proposal.cell, cell, 3);
    const bool is_timed = proposal.particles >= fewest_timed_particles;
    others +=
        fmt::format("             --resolution {}: cells of {:g} m{}; {}\n", each.name, cell,
                    is_timed ? fmt::format(", about {} of processor time", duration_text(seconds)) : "", each.errors);
  }
  return fmt::format(
      "resolution:  {}cells of {:g} m{}\n             about {} particles, {} steps to time.end, and {}\n{}",
      chosen.empty() ? "" : chosen + ", ", proposal.cell, errors, rounded_text(proposal.particles),
      rounded_text(cost.steps), run::text_of(cost), others);
}

// Cost of a run by its first steps, or nothing if these fail. Throws errors that refuse the case before its first step.
std::optional<run::RunCost> cost_of_run(const fs::path& folder) {
  try {
    const config::Case made = config::read_case(folder);
    sim::Simulation<3> simulation(made, gis::load_site(made).site);
    sim::RunRecords<3> records(simulation, simulation.site());
    records.start(simulation);
    const double steps = run::steps_to_end(simulation);
    return run::cost_on_cpu(simulation, steps);
  } catch (const RunError&) {
    return {};  // the case is kept; `check` and `run` report the reason
  } catch (const UserError& error) {
    throw UserError("no case was created, because it would not run: {}",
                    without_places(error.what(), (folder / "case.toml").string()));
  }
}

}  // namespace

int make_new_case(const NewOptions& options) {
  use_threads(0);
  const std::string release_name = name_of_file(options.maps.release);
  require_utf8("the folder to make", title_of(options.folder));
  require_utf8("--release", release_name);
  config::Case trial = trial_case(options.folder, options.maps);
  config::ProposalInput input;
  for (const config::ProposedSubstrate& each : config::proposed_substrates) {
    if (const std::string& file = options.outlines.at(each.name); !file.empty()) {
      trial.substrates[each.name].outline = file;
      trial.locations[fmt::format("substrate.{}.outline", each.name)] = each.option;
      input.outlines[each.name] = name_of_file(file);
      require_utf8(each.option, input.outlines[each.name]);
    }
  }
  config::Site site = open_site(trial);
  require_ground_about(options.maps.release, *site.ground, site.releases.at(body_name).thickness);
  if (options.maps.cut) {
    input.taper = taper_edges(trial, site);
    site = reopen_site(trial);
  }
  const std::string resolution = options.cell > 0.0 ? "" : options.resolution.empty() ? "quick" : options.resolution;
  const config::Proposal proposal =
      config::propose(*site.ground, site.releases.at(body_name).thickness, options.reach_angle, options.cell,
                      resolution.empty() ? config::Resolution::quick : config::resolution_named(resolution));
  require_resolvable(proposal, options);
  require_affordable(proposal, options);
  require_memory(proposal, options);
  input.title = title_of(options.folder);
  input.dem_file = release_name == "dem.tif" ? "terrain.tif" : "dem.tif";
  input.thickness = trial.bodies.at(body_name).thickness;
  if (input.thickness.from == config::MapValue::From::raster) {
    input.thickness.source = release_name;
  } else {
    input.release_file = release_name;
  }
  input.placement = options.maps.cut ? config::Placement::cut : config::Placement::on_top;
  input.reach_angle = options.reach_angle;
  input.largest_volume = options.maps.largest_volume;
  input.filter = filter_of(trial, proposal);

  const Raster &ground = *site.ground, &thickness = site.releases.at(body_name).thickness;
  std::optional<config::Proposal> quick;  // of the members of a forecast, if the case has smaller cells
  if (proposal.cell < config::cell_of(config::Resolution::quick, proposal)) {
    quick = config::propose(ground, thickness, options.reach_angle);
  }

  const fs::path folder = options.folder;
  std::optional<run::RunCost> cost;
  in_new_folder(folder, [&] {
    write_cropped_dem(folder / input.dem_file, site, proposal, quick);
    copy_polygons(folder, trial);
    write_file_atomically(folder / "case.toml", config::case_text(input, proposal));
    input.base = base_by_block(folder);
    write_file_atomically(folder / "case.toml", config::case_text(input, proposal));
    config::ProposedBase base = input.base.value_or(config::ProposedBase());
    if (!input.base) {
      base.friction = std::atan(config::slope_below(ground, thickness)) * 180.0 / std::numbers::pi;
    }
    write_file_atomically(folder / "sweep.toml", config::sweep_text(proposal.thickness, base, quick, input.outlines));
    cost = cost_of_run(folder);
  });

  fmt::print("{}: a release of {} m3, {} m thick, on {} m cells\n", (folder / "case.toml").string(),
             rounded_text(proposal.volume, 3), rounded_text(proposal.thickness, 3), proposal.cell);
  if (cost) {
    fmt::print("{}", resolution_text(proposal, resolution, *cost));
  } else {
    fmt::print("warning: {}: the run fails in its first steps. `thawslide check` gives the reason\n",
               (folder / "case.toml").string());
  }
  if (input.base) {
    fmt::print("{}", base_text(*input.base));
  }
  const config::BodyOnCells body{.name = body_name,
                                 .thickness = proposal.median_thickness,
                                 .cell = proposal.cell,
                                 .particles_per_axis = proposal.particles_per_axis,
                                 .has_maps = resolution.empty() || !cost};  // otherwise stated above
  if (const std::string warning = config::resolution_warning(body, "--cell"); !warning.empty()) {
    fmt::print("warning: {}\n", warning);
  }
  if (const std::string warning = config::edge_warning(proposal); !warning.empty()) {
    fmt::print("warning: {}\n", warning);
  }
  if (proposal.particles > many_particles) {
    fmt::print(
        "warning: grid.cell: the run takes long, with {} particles. Set a larger --cell for a coarser, shorter run\n",
        with_commas(proposal.particles, 2));
  }
  if (input.outlines.empty()) {
    fmt::print("path:        [basal] everywhere. Polygons of other ground: --glacier, --snow, --valley-floor\n");
  }
  print_next_commands(options.program, folder);
  fmt::print("forecast: {} forecast {}\n", shell_quote(options.program), shell_quote(folder.string()));
  return static_cast<int>(ExitCode::done);
}

}  // namespace thawslide::app

#else

namespace thawslide::app {

int make_new_case(const NewOptions& options) { fail_without_gis(options.maps.dem); }

}  // namespace thawslide::app

#endif
