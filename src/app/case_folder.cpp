#include "app/case_folder.hpp"

#include "base/error.hpp"

#ifdef THAWSLIDE_WITH_GIS
#include "gis/point_window.hpp"
#include "gis/raster_file.hpp"
#endif

namespace thawslide::app {

namespace fs = std::filesystem;

void fail_without_gis(const std::string& file) {
  throw UserError(
      fmt::format("{}: this build of thawslide cannot read maps: it was made without GDAL. Install libgdal-dev and "
                  "build again (`./run --setup`).",
                  file));
}

#ifdef THAWSLIDE_WITH_GIS

config::Case trial_case(const std::string& folder, const MapOptions& maps) {
  const gis::Rectangle span = gis::span_of_points(gis::RasterFile(maps.dem).layout());
  config::Case trial;
  trial.name = trial.file = folder;
  trial.general.dimension = 3;
  trial.terrain.kind = config::TerrainKind::dem;
  trial.terrain.file = maps.dem;
  trial.terrain.crs = maps.crs;
  trial.grid.cell = 1.0;
  trial.grid.min = {span.min_x, span.min_y, 0.0};
  trial.grid.max = {span.max_x, span.max_y, 1.0};
  trial.places["terrain.file"] = "--dem";
  trial.places["terrain.crs"] = "--crs";
  if (maps.release.empty()) {
    return trial;
  }
  config::Body body;
  body.shape = config::BodyShape::release;
  body.release = maps.release;
  body.thickness.from = maps.thickness > 0.0 ? config::MapValue::From::number : config::MapValue::From::attribute;
  body.thickness.number = maps.thickness;
  body.thickness.source = "thickness";
  trial.bodies[body_name] = body;
  trial.places["body.slide.release"] = "--release";
  trial.places["body.slide.thickness"] = maps.thickness > 0.0 ? "--thickness" : "--release";
  return trial;
}

#endif

std::string title_of(const fs::path& folder) {
  return (folder.has_filename() ? folder : folder.parent_path()).filename().string();
}

void make_new_folder(const fs::path& folder) {
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

}  // namespace thawslide::app
