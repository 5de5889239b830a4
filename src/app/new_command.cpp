// thawslide new: a case folder from a terrain model and a release area.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/case_folder.hpp"
#include "app/commands.hpp"
#include "base/error.hpp"

#ifdef THAWSLIDE_WITH_GIS

#include "config/case_proposal.hpp"
#include "config/input_files.hpp"
#include "gis/point_window.hpp"
#include "gis/raster_file.hpp"
#include "io/atomic_file.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

namespace {

constexpr double many_particles = 1e6;

// The DEM as it is, cropped to the domain and some cells about it.
void write_cropped_dem(const fs::path& file, const Raster& ground, const config::Proposal& proposal) {
  const double margin = 3.0 * proposal.cell;
  const gis::Rectangle about =
      gis::Rectangle{proposal.min[0], proposal.min[1], proposal.max[0], proposal.max[1]}.widened(
          margin + 2.0 * ground.cell_x, margin + 2.0 * ground.cell_y);
  const Raster cropped = gis::part_of(ground, gis::points_in(ground, about));
  gis::write_geotiff(file.string(), cropped, {"m", "elevation"});
}

// As many cells along each axis as a case may have.
void require_resolvable(const config::Proposal& proposal) {
  constexpr double fewest = 2.0, most = 5e5;
  for (std::size_t a = 0; a < 3; ++a) {
    const double cells = (proposal.max[a] - proposal.min[a]) / proposal.cell;
    if (!(cells >= fewest && cells <= most)) {
      throw UserError(
          fmt::format("--thickness: a release {:.4g} m thick asks for cells of {:g} m, and the terrain about it would "
                      "have {:.4g} of them along {}; allowed: {:g} to {:g}. Is the thickness in metres?",
                      proposal.thickness, proposal.cell, std::max(0.0, std::round(cells)), "xyz"[a], fewest, most));
    }
  }
}

// With the files that belong to it.
void copy_release(const fs::path& folder, const config::Case& trial) {
  config::Case release_alone;
  release_alone.bodies = trial.bodies;
  for (const fs::path& file : config::input_files(release_alone)) {
    fs::copy_file(file, folder / file.filename());
  }
}

}  // namespace

int make_new_case(const NewOptions& options) {
  const config::Case trial = trial_case(options.folder, options.maps);
  const config::Site site = look_at_files(trial);
  const config::Proposal proposal =
      config::propose(*site.ground, site.releases.at(body_name).thickness, options.reach_angle);
  require_resolvable(proposal);
  config::ProposalInput input;
  input.title = title_of(options.folder);
  const std::string release_name = fs::path(options.maps.release).filename().string();
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

  const fs::path folder = options.folder;
  make_new_folder(folder);
  write_cropped_dem(folder / input.dem_file, *site.ground, proposal);
  copy_release(folder, trial);
  io::write_file_atomically(folder / "case.toml", config::case_text(input, proposal));

  fmt::print("{}: a release of {:.4g} m3, {:.3g} m thick, on {} m cells: about {:.3g} particles\n",
             (folder / "case.toml").string(), proposal.volume, proposal.thickness, proposal.cell, proposal.particles);
  if (proposal.particles > many_particles) {
    fmt::print("note: that will take long; a larger grid.cell in the case file is quicker and coarser\n");
  }
  fmt::print("look at it:  thawslide check {} --picture\nrun it:      ./run {}\n", folder.string(), folder.string());
  return static_cast<int>(ExitCode::done);
}

}  // namespace thawslide::app

#else

namespace thawslide::app {

int make_new_case(const NewOptions& options) { fail_without_gis(options.maps.dem); }

}  // namespace thawslide::app

#endif
