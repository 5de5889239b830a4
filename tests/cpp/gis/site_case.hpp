// A case whose ground is a plane that falls to the east, 3 m over 4 m: points 5 m apart over 1000 m x 800 m, and bodies
// on it. Constructed without a case file.
#pragma once

#include "base/raster.hpp"
#include "gis/release.hpp"
#include "gis/site.hpp"
#include "map_files.hpp"

namespace thawslide::gis::site_case {

using namespace map_files;

inline constexpr double west = 400000.0, south = 300000.0;  // of the first point of the ground

inline double plane(double x, double) { return 2000.0 - 0.75 * (x - west); }

inline Raster ground(const std::string& crs = "EPSG:31287") {
  return raster_of(plane, west, south, 5.0, 201, 161, crs);
}

inline config::Case plain_case(const Raster& dem) {
  config::Case made;
  made.file = "case.toml";
  made.locations = {{"terrain.file", "case.toml:5:8"}, {"body.rock.release", "case.toml:9:11"}};
  made.terrain.kind = config::TerrainKind::dem;
  made.terrain.file = geotiff("dem.tif", dem);
  made.general.dimension = 3;
  made.grid.cell = 10.0;
  made.grid.min = {west + 100.0, south + 100.0, 1000.0};
  made.grid.max = {west + 900.0, south + 700.0, 2500.0};
  return made;
}

inline config::Body release_body(const std::string& file, double thickness) {
  config::Body body;
  body.shape = config::BodyShape::release;
  body.release = file;
  body.thickness.number = thickness;
  return body;
}

// Release without polygons: the area in which the raster has a thickness.
inline config::Body raster_body(const std::string& file) {
  config::Body body = release_body("", 0.0);
  body.thickness.from = config::MapValue::From::raster;
  body.thickness.source = file;
  return body;
}

// The same with the surface before the slide.
inline config::Body surface_body(const std::string& file) {
  config::Body body = raster_body(file);
  body.thickness.from = config::MapValue::From::surface;
  return body;
}

// Field of a body or bed from an attribute or a raster.
inline InitialField field_of(InitialField::Over over, const std::string& source) {
  InitialField field;
  field.over = over;
  field.source = source;
  return field;
}
inline InitialField raster_field(const std::string& file) { return field_of(InitialField::Over::raster, file); }

// Box in metres from the first point of the ground.
inline std::string box_at(double min_x, double min_y, double max_x, double max_y) {
  return box_json(west + min_x, south + min_y, west + max_x, south + max_y);
}

inline config::Case case_with_release(const std::vector<JsonFeature>& features, double thickness = 10.0) {
  config::Case made = plain_case(ground());
  made.bodies["rock"] = release_body(geojson("release.geojson", features), thickness);
  return made;
}

// The only body is the area in which a raster has a thickness.
inline config::Case case_with_raster(const Raster& thickness, const Raster& dem = ground()) {
  config::Case made = plain_case(dem);
  made.bodies["rock"] = raster_body(geotiff("thickness.tif", thickness));
  return made;
}

inline config::Release release_of(const config::Case& parameters) {
  return load_site(parameters).site.releases.at("rock");
}

inline double release_volume(const config::Case& parameters) { return volume_of(release_of(parameters).thickness); }

// Thickness at a position in metres from the first point of the ground; 0 beyond the raster.
inline double thickness_at(const config::Release& release, double x, double y) {
  const Raster& raster = release.thickness;
  const auto column = static_cast<int>(std::lround((west + x - raster.x) / raster.cell_x));
  const auto row = static_cast<int>(std::lround((south + y - raster.y) / raster.cell_y));
  const bool is_inside = column >= 0 && row >= 0 && column < raster.columns && row < raster.rows;
  return is_inside ? raster.at(column, row) : 0.0;
}

inline std::string error_of_site(const config::Case& parameters) {
  return error_of([&] { return load_site(parameters); });
}

}  // namespace thawslide::gis::site_case
