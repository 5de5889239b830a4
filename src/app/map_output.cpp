#include "app/map_output.hpp"

#ifdef THAWSLIDE_WITH_GIS

#include <algorithm>
#include <cmath>

#include "gis/geopackage.hpp"
#include "gis/map_style.hpp"
#include "gis/raster_file.hpp"
#include "io/files.hpp"

namespace thawslide::app {

namespace fs = std::filesystem;

namespace {

constexpr gis::Color dark_red{178, 24, 43}, black{0, 0, 0}, blue{33, 102, 172};

void write_map(const fs::path& folder, const std::string& name, const Raster& map, const gis::BandText& text) {
  io::make_folder(folder / "maps");
  gis::write_geotiff((folder / "maps" / (name + ".tif")).string(), map, text);
}

// Colours span the values of the map; for signed quantities they are symmetric about 0.
void write_style(const fs::path& folder, const std::string& name, const Raster& map, const std::string& unit,
                 double nothing_below) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const double value : map.values) {
    if (std::isfinite(value)) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (low > high) {
    return;  // nothing to plot
  }
  high = high > low ? high : low + 1.0;
  const bool rises_and_falls = name == "elevation_change";
  const auto stops =
      rises_and_falls ? gis::diverging_stops(std::max(std::abs(low), std::abs(high))) : gis::even_stops(low, high);
  gis::write_raster_style((folder / "maps" / (name + ".qml")).string(), stops, unit, nothing_below);
}

// Area that the slide covered at any time.
gis::Polygons affected_area(const sim::FlowMaps& maps) {
  const Raster mask = maps.affected_cells().mask();
  return mask.empty() ? gis::Polygons{} : gis::areas_of_mask(mask);
}

// width: of lines, or the size of points [mm].
std::string style(gis::LayerKind kind, const gis::Color& color, double width, const std::string& label) {
  constexpr double fill = 0.25;
  return gis::vector_style({.kind = kind, .color = color, .width = width, .opacity = fill, .label = label});
}

gis::MapLayer front_layer(const std::vector<FrontAt>& fronts) {
  std::vector<std::array<double, 2>> places;
  std::vector<double> times;
  for (const FrontAt& front : fronts) {
    places.push_back(front.place);
    times.push_back(front.time);
  }
  return {"front", places, {{"time_s", times}}, style(gis::LayerKind::points, blue, 2.0, "time_s")};
}

void write_layers(const fs::path& folder, const sim::RunRecords<3>& records, const std::vector<FrontAt>& fronts,
                  const std::string& when) {
  const gis::Polygons area = affected_area(*records.maps());
  std::vector<gis::MapLayer> layers;
  layers.push_back({"affected_area",
                    std::vector<gis::Polygons>{area},
                    {{"area_m2", std::vector{gis::area_of(area)}}, {"state", std::vector<std::string>{when}}},
                    style(gis::LayerKind::polygons, dark_red, 0.5, "")});
  if (!records.path().empty()) {
    const std::string kind = records.path_given() ? "given" : "path of the centre of mass";
    layers.push_back({"path",
                      std::vector<config::Polyline2>{records.path().corners()},
                      {{"length_m", std::vector{records.path().length()}}, {"kind", std::vector<std::string>{kind}}},
                      style(gis::LayerKind::lines, black, 0.5, "")});
  }
  layers.push_back(front_layer(fronts));
  gis::write_geopackage((folder / "maps" / "results.gpkg").string(), layers, records.maps()->map_grid().crs);
}

}  // namespace

bool can_write_maps() { return true; }

void write_ground_maps(const fs::path& folder, const config::Site& site) {
  if (site.ground == nullptr) {
    return;
  }
  write_map(folder, terrain_map.name, *site.ground, {terrain_map.unit, terrain_map.description});
  Raster release = site.ground->filled(0.0);
  for (const auto& [name, body] : site.releases) {
    const Raster& thickness = body.thickness;
    const auto column = static_cast<int>(std::lround((thickness.x - release.x) / release.cell_x));
    const auto row = static_cast<int>(std::lround((thickness.y - release.y) / release.cell_y));
    for (int j = 0; j < thickness.rows; ++j) {
      for (int i = 0; i < thickness.columns; ++i) {
        const double value = thickness.at(i, j);
        release.values[release.index(column + i, row + j)] += std::isnan(value) ? 0.0 : value;
      }
    }
  }
  write_map(folder, release_map.name, release, {release_map.unit, release_map.description});
  write_style(folder, release_map.name, release, release_map.unit, 0.0);
}

void write_maps(const fs::path& folder, const sim::RunRecords<3>& records, const std::vector<FrontAt>& fronts,
                const std::string& when) {
  for (const sim::MapKind& kind : sim::map_kinds()) {
    const Raster map = records.maps()->raster(kind, sim::MapExtent::whole_grid);
    const std::string title = kind.of_last_state ? fmt::format("{}: {}", when, kind.description) : kind.description;
    write_map(folder, kind.name, map, {kind.unit, title});
    write_style(folder, kind.name, map, kind.unit, -HUGE_VAL);
  }
  write_layers(folder, records, fronts, when);
}

}  // namespace thawslide::app

#else

#include "base/error.hpp"

namespace thawslide::app {

bool can_write_maps() { return false; }

void write_ground_maps(const std::filesystem::path& /*folder*/, const config::Site& site) {
  THAWSLIDE_ASSERT(site.ground == nullptr, "a raster of {} columns in a build without maps", site.ground->columns);
}

void write_maps(const std::filesystem::path& folder, const sim::RunRecords<3>& /*records*/,
                const std::vector<FrontAt>& /*fronts*/, const std::string& /*when*/) {
  THAWSLIDE_ASSERT(false, "no maps can be written to {} without GDAL", folder.string());
}

}  // namespace thawslide::app

#endif
