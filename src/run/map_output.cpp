#include "run/map_output.hpp"

#ifdef THAWSLIDE_WITH_GIS

#include <cmath>
#include <numeric>
#include <utility>

#include "base/raster.hpp"
#include "gis/geopackage.hpp"
#include "gis/map_style.hpp"
#include "gis/polygons.hpp"
#include "gis/raster_file.hpp"
#include "io/files.hpp"

namespace thawslide::run {

namespace fs = std::filesystem;

namespace {

constexpr gis::Color dark_red{178, 24, 43}, black{0, 0, 0}, blue{33, 102, 172}, brown{140, 81, 10}, orange{230, 97, 1};

void write_map(const fs::path& folder, const std::string& name, const Raster& map, const gis::BandText& text) {
  io::make_folder(folder / "maps");
  gis::write_geotiff((folder / "maps" / (name + ".tif")).string(), map, text);
}

void write_styles(const fs::path& folder, const std::string& name) {
  gis::write_raster_style((folder / "maps" / (name + ".qml")).string(), gis::style_of_map(name));
  if (const gis::RasterStyle hazard = gis::hazard_style_of_map(name); !hazard.classes.empty()) {
    gis::write_raster_style((folder / "maps" / (name + ".hazard.qml")).string(), hazard);
  }
}

gis::Polygons areas_of(const sim::CoveredCells& cells) {
  const Raster mask = cells.mask();
  return mask.empty() ? gis::Polygons{} : gis::areas_of_mask(mask);
}

// width: of lines, or the size of points [mm].
std::string style(gis::LayerKind kind, const gis::Color& color, double width, const std::string& label) {
  constexpr double fill = 0.25;
  return gis::vector_style({.kind = kind, .color = color, .width = width, .opacity = fill, .label = label});
}

std::string fill_style(const gis::Color& color) { return style(gis::LayerKind::polygons, color, 0.5, ""); }

// Text columns that state which run wrote a layer of `count` features, and at which time.
std::vector<gis::Attribute> origin(const MapTexts& texts, std::size_t count) {
  return {{"run", std::vector<std::string>(count, texts.run)},
          {"state", std::vector<std::string>(count, texts.state)},
          {"time_s", std::vector<double>(count, texts.time)}};
}

gis::MapLayer layer_of(const char* name, decltype(gis::MapLayer::features) features,
                       std::vector<gis::Attribute> attributes, const std::vector<gis::Attribute>& more,
                       const std::string& qgis_style) {
  attributes.insert(attributes.end(), more.begin(), more.end());
  return {name, std::move(features), std::move(attributes), qgis_style};
}

gis::MapLayer affected_layer(const sim::FlowMaps& maps, const MapTexts& texts) {
  const gis::Polygons area = areas_of(maps.affected_cells(maps.arrival_thickness()));
  return layer_of(
      "affected_area", std::vector<gis::Polygons>{area},
      {{"area_m2", std::vector{gis::area_of(area)}}, {"threshold_m", std::vector{maps.arrival_thickness()}}},
      origin(texts, 1), fill_style(dark_red));
}

gis::MapLayer deposit_layer(const sim::FlowMaps& maps, const MapTexts& texts) {
  const gis::Polygons area = areas_of(maps.covered_cells(texts.area_thickness));
  return layer_of("deposit_area", std::vector<gis::Polygons>{area},
                  {{"area_m2", std::vector{gis::area_of(area)}},
                   {"volume_m3", std::vector{maps.covered_volume(texts.area_thickness)}},
                   {"threshold_m", std::vector{texts.area_thickness}}},
                  origin(texts, 1), fill_style(brown));
}

// One feature per body: its outlines, or the cells of its raster.
gis::MapLayer release_layer(const config::Site& site, const MapTexts& texts) {
  std::vector<gis::Polygons> areas;
  std::vector<std::string> names;
  std::vector<double> sizes, volumes, largest;
  for (const auto& [name, release] : site.releases) {
    const Raster& thickness = release.thickness;
    areas.push_back(release.outlines.empty() ? gis::areas_of_mask(thickness)
                                             : gis::polygons_of_rings(release.outlines));
    names.push_back(name);
    sizes.push_back(gis::area_of(areas.back()));
    volumes.push_back(volume_of(thickness));
    largest.push_back(std::accumulate(thickness.values.begin(), thickness.values.end(), 0.0,
                                      [](double most, double value) { return std::fmax(most, value); }));
  }
  const std::vector<std::string> runs(areas.size(), texts.run);
  return {"release_area",
          areas,
          {{"body", names}, {"area_m2", sizes}, {"volume_m3", volumes}, {"max_thickness_m", largest}, {"run", runs}},
          fill_style(orange)};
}

gis::MapLayer path_layer(const sim::RunRecords<3>& records, const MapTexts& texts) {
  const std::string kind = records.path_given() ? "given" : "path of the centre of mass";
  return layer_of("path", std::vector<config::Polyline2>{records.path().corners()},
                  {{"length_m", std::vector{records.path().length()}}, {"kind", std::vector<std::string>{kind}}},
                  {{"run", std::vector<std::string>{texts.run}}}, style(gis::LayerKind::lines, black, 0.5, ""));
}

gis::MapLayer front_layer(const std::vector<FrontAt>& fronts, const MapTexts& texts) {
  std::vector<std::array<double, 2>> points;
  std::vector<double> times;
  for (const FrontAt& front : fronts) {
    points.push_back(front.position);
    times.push_back(front.time);
  }
  return {"front",
          points,
          {{"time_s", times}, {"run", std::vector<std::string>(points.size(), texts.run)}},
          style(gis::LayerKind::points, blue, 2.0, "time_s")};
}

void write_layers(const fs::path& folder, const sim::RunRecords<3>& records, const config::Site& site,
                  const std::vector<FrontAt>& fronts, const MapTexts& texts) {
  const sim::FlowMaps& maps = *records.maps();
  std::vector<gis::MapLayer> layers{affected_layer(maps, texts), deposit_layer(maps, texts)};
  if (!site.releases.empty()) {
    layers.push_back(release_layer(site, texts));
  }
  if (!records.path().empty()) {
    layers.push_back(path_layer(records, texts));
  }
  layers.push_back(front_layer(fronts, texts));
  gis::write_geopackage((folder / "maps" / "results.gpkg").string(), layers, maps.map_grid().crs);
}

}  // namespace

bool can_write_maps() { return true; }

void write_ground_maps(const fs::path& folder, const sim::Simulation<3>& simulation) {
  const config::Site& site = simulation.site();
  if (simulation.model().ground) {
    write_map(folder, ground_map.name, sim::ground_of_cells(simulation.parameters(), site, simulation.model()),
              {ground_map.unit, ground_map.description});
  }
  if (site.ground == nullptr) {
    return;
  }
  write_map(folder, terrain_map.name, *site.ground, {terrain_map.unit, terrain_map.description});
  Raster release = site.ground->filled(0.0);
  for (const auto& [name, body] : site.releases) {
    const Raster& thickness = body.thickness;
    const auto column = static_cast<int>(std::lround((thickness.x - release.x) / release.cell_x));
    const auto row = static_cast<int>(std::lround((thickness.y - release.y) / release.cell_y));
    for_each_point(thickness, [&](int i, int j, double value) {
      release.values[release.index(column + i, row + j)] += std::isnan(value) ? 0.0 : value;
    });
  }
  write_map(folder, release_map.name, release, {release_map.unit, release_map.description});
  write_styles(folder, release_map.name);
}

void write_maps(const fs::path& folder, const sim::RunRecords<3>& records, const config::Site& site,
                const std::vector<FrontAt>& fronts, const MapTexts& texts) {
  for (const sim::MapKind& kind : sim::map_kinds()) {
    const Raster map = records.maps()->raster(kind, sim::MapExtent::whole_grid);
    const std::string title =
        kind.of_last_state ? fmt::format("{}: {}", texts.state, kind.description) : kind.description;
    write_map(folder, kind.name, map, {kind.unit, title});
    write_styles(folder, kind.name);
  }
  write_layers(folder, records, site, fronts, texts);
}

}  // namespace thawslide::run

#else

#include "base/error.hpp"

namespace thawslide::run {

bool can_write_maps() { return false; }

void write_ground_maps(const std::filesystem::path& /*folder*/, const sim::Simulation<3>& simulation) {
  THAWSLIDE_ASSERT(simulation.site().ground == nullptr, "a raster of {} columns in a build without maps",
                   simulation.site().ground->columns);
}

void write_maps(const std::filesystem::path& folder, const sim::RunRecords<3>& /*records*/,
                const config::Site& /*site*/, const std::vector<FrontAt>& /*fronts*/, const MapTexts& /*texts*/) {
  THAWSLIDE_ASSERT(false, "no maps can be written to {} without GDAL", folder.string());
}

}  // namespace thawslide::run

#endif
