#include "app/case_folder.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "app/terminal.hpp"
#include "base/error.hpp"
#include "base/rounding.hpp"
#include "base/text.hpp"
#include "config/read_case.hpp"
#include "run/block_model.hpp"
#include "run/setup.hpp"

#ifdef THAWSLIDE_WITH_GIS
#include "gis/point_window.hpp"
#include "gis/raster_file.hpp"
#include "gis/site.hpp"
#include "sim/direction.hpp"
#endif

namespace thawslide::app {

namespace fs = std::filesystem;

void fail_without_gis(const std::string& file) {
  throw UserError(
      "{}: this build of thawslide cannot read maps: it was made without GDAL. Install libgdal-dev and build again "
      "(`./run --setup`).",
      file);
}

void require_utf8(const std::string& what, const std::string& name) {
  try {
    (void)nlohmann::json(name).dump();  // throws for anything but UTF-8
  } catch (const nlohmann::json::type_error&) {
    throw UserError("{}: '{}' is not UTF-8, as required for names in a case file. Rename it.", what, name);
  }
}

#ifdef THAWSLIDE_WITH_GIS

namespace {

gis::Rectangle span_of_dem(const std::string& dem) {
  try {
    return gis::span_of_points(gis::RasterFile(dem, gis::Quantity::length).layout());
  } catch (const UserError& error) {
    throw UserError("--dem: {}", error.what());
  }
}

}  // namespace

std::optional<config::ProposedBase> base_by_block(const fs::path& folder) {
  try {
    return run::propose_base(config::read_case(folder));
  } catch (const UserError&) {
    return {};
  }
}

std::string base_text(const config::ProposedBase& base) {
  std::string text =
      fmt::format("base:        a band of {:.1f} m, which a rigid block without pore pressure heats to {:.0f} C",
                  base.thickness, base.temperature);
  if (base.missing_cohesion > 0.0) {
    text +=
        fmt::format("\n             safety factor {:.2g} at the start: {} Pa of cohesion would have held the release",
                    base.safety_factor, rounded_text(base.missing_cohesion, 2));
  }
  text += "\n";
  if (base.temperature > config::ProposedBase::limit) {
    text += fmt::format(
        "warning: band.thickness: friction heats the base of the rigid block above {:g} C, which is not credible "
        "(found {:.0f} C with {:g} m). Set a lower basal.friction_angle or a larger band.thickness; "
        "docs/choosing-the-base.md\n",
        config::ProposedBase::limit, base.temperature, base.thickness);
  }
  return text;
}

config::Case trial_case(const std::string& folder, const MapOptions& maps) {
  if (!maps.release.empty() && gis::is_raster_file(maps.release) && fs::is_regular_file(maps.dem) &&
      !gis::is_raster_file(maps.dem)) {
    throw UserError(
        "--dem: {} is not a raster, and {} is one: the DEM and the release are swapped. Give --dem {} --release {}.",
        maps.dem, maps.release, maps.release, maps.dem);
  }
  const gis::Rectangle span = span_of_dem(maps.dem);
  config::Case trial;
  trial.name = trial.file = folder;
  trial.general.dimension = 3;
  trial.terrain.kind = config::TerrainKind::dem;
  trial.terrain.file = maps.dem;
  trial.terrain.crs = maps.crs;
  trial.terrain.smooth = {};
  trial.grid.cell = 1.0;
  trial.grid.min = {span.min_x, span.min_y, 0.0};
  trial.grid.max = {span.max_x, span.max_y, 1.0};
  trial.locations["terrain.file"] = "--dem";
  trial.locations["terrain.crs"] = "--crs";
  if (maps.release.empty()) {
    return trial;
  }
  config::Body body;
  body.shape = config::BodyShape::release;
  if (gis::is_raster_file(maps.release)) {
    if (maps.thickness > 0.0) {
      throw UserError(
          "--thickness: {} is a raster, whose values are the thickness in metres; leave --thickness out, or give "
          "polygons to --release.",
          maps.release);
    }
    body.thickness = {config::MapValue::From::raster, 0.0, maps.release};
  } else {
    body.release = maps.release;
    body.thickness.from = maps.thickness > 0.0 ? config::MapValue::From::number : config::MapValue::From::attribute;
    body.thickness.number = maps.thickness;
    body.thickness.source = "thickness";
  }
  if (maps.largest_volume > 0.0) {
    body.largest_volume = maps.largest_volume;
  }
  trial.bodies[body_name] = body;
  trial.locations["body.slide.release"] = "--release";
  trial.locations["body.slide.thickness"] = maps.thickness > 0.0 ? "--thickness" : "--release";
  return trial;
}

namespace {

// Replaces keys of a case by options in a message, for a user who has no case yet.
std::string as_option_names(std::string message) {
  const std::vector<std::pair<std::string, std::string>> words{
      {"which body.slide.thickness asks for; ", "which contains the thickness if --thickness is not given; "},
      {". Correct the name, or add the attribute.", ". Give the thickness with --thickness, or add the attribute."},
      {"terrain.crs = ", "--crs "},
      {"body.slide.largest_volume", "--largest-volume"},
      {"body.slide.thickness", "--thickness"},
      {"body.slide.release", "--release"},
      {"terrain.crs", "--crs"},
      {"terrain.file", "--dem"},
      {"maps.path", "--line"},
  };
  for (const auto& [key, option] : words) {
    for (std::size_t at = message.find(key); at != std::string::npos; at = message.find(key, at + option.size())) {
      message.replace(at, key.size(), option);
    }
  }
  return message;
}

gis::SiteAndWarnings read_files(const config::Case& trial) {
  try {
    gis::SiteAndWarnings read = gis::load_site(trial);
    if (const std::string warning = sim::orient_lines(trial, read.site); !warning.empty()) {
      read.warnings.push_back(warning);
    }
    return read;
  } catch (const UserError& error) {
    throw UserError(as_option_names(error.what()));
  }
}

}  // namespace

config::Site open_site(const config::Case& trial) {
  gis::SiteAndWarnings read = read_files(trial);
  for (const std::string& warning : read.warnings) {
    print_text("{}\n", run::warning_line(as_option_names(warning)));
  }
  return std::move(read.site);
}

config::Site reopen_site(const config::Case& trial) { return read_files(trial).site; }

config::EdgeTaper taper_edges(config::Case& trial, const config::Site& site) {
  const config::EdgeTaper taper = config::propose_taper(*site.ground, site.releases.at(body_name).thickness);
  if (taper.is_cramped()) {
    const auto degrees = [](double rise) { return std::atan(rise) * 180.0 / std::numbers::pi; };
    fmt::print(
        "warning: --cut: the edges of the cut are too narrow, because the release is narrow or near the edge of the "
        "known terrain (found {1:g} m; needed {0:g} m). They rise by up to {2:.0f} degrees against the terrain, which "
        "falls by {3:.0f} degrees, and may stop the slide. Use --on-top, which has no such edges\n",
        taper.wanted, taper.width, degrees(taper.steepest), degrees(taper.slope));
  }
  trial.bodies.at(body_name).taper = taper.width;
  return taper;
}

#endif

std::string title_of(const fs::path& folder) {
  return (folder.has_filename() ? folder : folder.parent_path()).filename().string();
}

void make_new_folder(const fs::path& folder) {
  if (fs::exists(folder) && (!fs::is_directory(folder) || !fs::is_empty(folder))) {
    throw UserError("{}: it exists and is not an empty folder. Choose another name.", folder.string());
  }
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) {
    throw UserError("{}: the folder cannot be created ({}).", folder.string(), failed.message());
  }
}

void print_next_commands(const std::string& program, const fs::path& folder) {
  const std::string called = shell_quote(program), made = shell_quote(folder.string());
  fmt::print("preview:  {0} check {1} --picture\nblock:    {0} block {1}\nrun:      {0} run {1}\n", called, made);
}

}  // namespace thawslide::app
