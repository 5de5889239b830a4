#include "gis/site.hpp"

#include <algorithm>
#include <memory>
#include <set>

#include "gis/case_inputs.hpp"
#include "gis/dem.hpp"
#include "gis/point_window.hpp"
#include "gis/polygons.hpp"
#include "gis/reference_system.hpp"
#include "gis/release.hpp"
#include "gis/substrates.hpp"
#include "gis/touching.hpp"
#include "gis/vector_file.hpp"

namespace thawslide::gis {

namespace {

// Reads the only line of a file, a part of which must lie in the domain.
config::Polyline2 load_line(const config::Case& parameters, const std::string& key, const std::string& file,
                            const std::string& crs, std::vector<std::string>& warnings) {
  return with_error_location(parameters, key, [&] {
    const VectorLayer layer = read_lines(file, crs);
    warnings.insert(warnings.end(), layer.warnings.begin(), layer.warnings.end());
    if (layer.features.size() != 1 || layer.features.front().lines.size() != 1) {
      std::size_t lines = 0;
      for (const Feature& feature : layer.features) {
        lines += feature.lines.size();
      }
      throw UserError("{}: the file has {} lines; allowed: one. Join them, or delete the others.", file, lines);
    }
    const config::Polyline2& line = layer.features.front().lines.front();
    if (line.size() < 2) {
      throw UserError("{}: the line has {} corner; needed: at least 2.", file, line.size());
    }
    const Rectangle extent = extent_of(line);
    const Rectangle domain = domain_of(parameters);
    if (!extent.touches(domain)) {
      throw UserError(
          "{}: the line ({}) lies outside the domain ({}). Check that both have the same place and reference system.",
          file, format_range(extent), format_range(domain));
    }
    return line;
  });
}

// Lowers the ground where bodies are excavated.
Raster without_cut_bodies(const config::Case& parameters, const std::map<std::string, config::Release>& releases,
                          Raster ground) {
  for (const auto& [name, release] : releases) {
    if (parameters.bodies.at(name).placement != config::Placement::cut) {
      continue;
    }
    const Raster& thickness = release.thickness;
    const PointWindow window = points_of(thickness, ground);
    for_each_point(thickness, [&](int column, int row, double cut) {
      if (cut > 0.0) {
        ground.values[ground.index(window.first_column + column, window.first_row + row)] -= cut;
      }
    });
  }
  return ground;
}

}  // namespace

SiteAndWarnings load_site(const config::Case& parameters) {
  SiteAndWarnings loaded;
  config::Site& site = loaded.site;
  Dem dem;
  if (parameters.terrain.kind == config::TerrainKind::dem) {
    dem = load_dem(parameters, loaded.warnings);
    site.roughness = dem.roughness;
    site.crs = dem.raster.crs;
    site.heights = dem.heights;
    site.crs_name = name_of(site.crs);
  }
  std::map<std::string, LoadedRelease> releases;
  for (const auto& [name, body] : parameters.bodies) {
    if (body.shape != config::BodyShape::release) {
      continue;
    }
    if (dem.raster.empty()) {
      fail_at(parameters, fmt::format("body.{}.shape", name),
              "a release lies on a DEM. Set terrain.type = \"dem\" and terrain.file.");
    }
    releases[name] = load_release(parameters, name, dem, loaded.warnings);
  }
  check_overlaps(parameters, releases);
  join_touching(parameters, releases);
  for (auto& [name, release] : releases) {
    site.releases[name] = std::move(release.release);
  }
  if (!dem.raster.empty()) {
    site.substrates = load_substrates(parameters, dem, loaded.warnings);
    site.bed_depth = load_bed_depth(parameters, dem, loaded.warnings);
    site.bed_in_columns = load_bed_in_columns(parameters, dem, loaded.warnings);
    site.terrain_model = {{{dem.span.min_x, dem.span.min_y}, {dem.span.max_x, dem.span.max_y}}};
    if (!dem.before_smoothing.empty()) {
      site.before_smoothing = std::make_shared<const Raster>(std::move(dem.before_smoothing));
    }
    site.ground = std::make_shared<const Raster>(without_cut_bodies(parameters, site.releases, std::move(dem.raster)));
  }
  if (!parameters.maps.path.empty()) {
    site.path = load_line(parameters, "maps.path", parameters.maps.path, site.crs, loaded.warnings);
  }
  for (const auto& [name, probe] : parameters.probes) {
    site.probes[name] = probe.line.empty() ? config::Polyline2{{probe.point[0], probe.point[1]}}
                                           : load_line(parameters, fmt::format("probe.{}.line", name), probe.line,
                                                       site.crs, loaded.warnings);
  }
  // Bodies from one file share warnings, which are kept once.
  std::set<std::string> known;
  std::erase_if(loaded.warnings, [&](const std::string& warning) { return !known.insert(warning).second; });
  return loaded;
}

}  // namespace thawslide::gis
