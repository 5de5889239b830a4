// thawslide new: a case folder from a terrain model and a release area.
#include <filesystem>

#include "app/commands.hpp"
#include "base/error.hpp"

#ifdef THAWSLIDE_WITH_GIS

#include "config/case_proposal.hpp"
#include "config/input_files.hpp"
#include "gis/point_window.hpp"
#include "gis/raster_file.hpp"
#include "gis/site.hpp"
#include "io/atomic_file.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* dem_name = "dem.tif";
constexpr const char* body_name = "slide";
constexpr double many_particles = 1e6;

// A case over the whole DEM, to look at what the files hold.
config::Case trial_case(const NewOptions& options) {
  const gis::Rectangle span = gis::span_of_points(gis::RasterFile(options.dem).layout());
  config::Case trial;
  trial.name = trial.file = options.folder;
  trial.general.dimension = 3;
  trial.terrain.kind = config::TerrainKind::dem;
  trial.terrain.file = options.dem;
  trial.terrain.crs = options.crs;
  trial.grid.cell = 1.0;
  trial.grid.min = {span.min_x, span.min_y, 0.0};
  trial.grid.max = {span.max_x, span.max_y, 1.0};
  config::Body body;
  body.shape = config::BodyShape::release;
  body.release = options.release;
  body.thickness.from = options.thickness > 0.0 ? config::MapValue::From::number : config::MapValue::From::attribute;
  body.thickness.number = options.thickness;
  body.thickness.source = "thickness";
  if (options.largest_volume > 0.0) {
    body.largest_volume = options.largest_volume;
  }
  trial.bodies[body_name] = body;
  trial.places["terrain.file"] = "--dem";
  trial.places["terrain.crs"] = "--crs";
  trial.places["body.slide.release"] = "--release";
  trial.places["body.slide.thickness"] = options.thickness > 0.0 ? "--thickness" : "--release";
  return trial;
}

void require_new_folder(const fs::path& folder) {
  if (fs::exists(folder) && (!fs::is_directory(folder) || !fs::is_empty(folder))) {
    throw UserError(
        fmt::format("{}: there is something already; give the name of a folder that is not there yet, or an "
                    "empty one.",
                    folder.string()));
  }
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) {
    throw UserError(fmt::format("{}: the folder cannot be made ({}).", folder.string(), failed.message()));
  }
}

// The DEM as it is, cropped to the domain and some cells about it.
void write_cropped_dem(const fs::path& folder, const Raster& ground, const config::Proposal& proposal) {
  const double margin = 3.0 * proposal.cell;
  const gis::Rectangle about =
      gis::Rectangle{proposal.min[0], proposal.min[1], proposal.max[0], proposal.max[1]}.widened(
          margin + 2.0 * ground.cell_x, margin + 2.0 * ground.cell_y);
  const Raster cropped = gis::part_of(ground, gis::points_in(ground, about));
  gis::write_geotiff((folder / dem_name).string(), cropped, {"m", "elevation"});
}

void copy_release(const fs::path& folder, const config::Case& trial) {
  for (const fs::path& file : config::input_files(trial)) {
    if (file.stem() == fs::path(trial.bodies.at(body_name).release).stem()) {
      fs::copy_file(file, folder / file.filename());
    }
  }
}

// A message that names keys of a case, for a user who has not got one yet.
std::string in_words_of_options(std::string message) {
  const std::vector<std::pair<std::string, std::string>> words{
      {"--dem: terrain.file: ", "--dem: "},
      {"--release: body.slide.release: ", "--release: "},
      {"terrain.crs = \"EPSG:...\"", "--crs EPSG:..."},
      {"body.slide.largest_volume", "--largest-volume"},
      {"body.slide.thickness", "--thickness"},
      {"body.slide.release", "--release"},
      {"terrain.crs", "--crs"},
      {"terrain.file", "--dem"},
  };
  for (const auto& [key, option] : words) {
    for (std::size_t at = message.find(key); at != std::string::npos; at = message.find(key, at + option.size())) {
      message.replace(at, key.size(), option);
    }
  }
  return message;
}

gis::SiteAndNotes look_at_files(const config::Case& trial) {
  try {
    return gis::load_site(trial);
  } catch (const UserError& error) {
    throw UserError(in_words_of_options(error.what()));
  }
}

}  // namespace

int make_new_case(const NewOptions& options) {
  const config::Case trial = trial_case(options);
  const gis::SiteAndNotes read = look_at_files(trial);
  for (const std::string& note : read.notes) {
    fmt::print("note: {}\n", note);
  }
  const config::Proposal proposal =
      config::propose(*read.site.ground, read.site.releases.at(body_name).thickness, options.reach_angle);
  config::ProposalInput input;
  input.title = fs::path(options.folder).filename().string();
  input.dem_file = dem_name;
  input.release_file = fs::path(options.release).filename().string();
  input.thickness = trial.bodies.at(body_name).thickness;
  input.placement = options.cut ? config::Placement::cut : config::Placement::on_top;
  input.reach_angle = options.reach_angle;
  input.largest_volume = options.largest_volume;

  const fs::path folder = options.folder;
  require_new_folder(folder);
  write_cropped_dem(folder, *read.site.ground, proposal);
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

int make_new_case(const NewOptions& options) {
  throw UserError(
      fmt::format("{}: this build of thawslide cannot read maps: it was made without GDAL. Install libgdal-dev and "
                  "build again (`./run --setup`).",
                  options.dem));
}

}  // namespace thawslide::app

#endif
