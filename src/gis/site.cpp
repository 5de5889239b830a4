#include "gis/site.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "gis/case_inputs.hpp"
#include "gis/point_window.hpp"
#include "gis/polygons.hpp"
#include "gis/reference_system.hpp"
#include "gis/release.hpp"
#include "gis/vector_file.hpp"

namespace thawslide::gis {

namespace {

// Domain reduced by the grid cells that extend outside the DEM; empty if none remain.
std::string domain_within(const config::Grid& grid, const Rectangle& span) {
  const auto cells_beyond = [&](double distance) { return std::max(0.0, std::ceil(distance / grid.cell - 1e-9)); };
  const double west = grid.min[0] + cells_beyond(span.min_x - grid.min[0]) * grid.cell;
  const double south = grid.min[1] + cells_beyond(span.min_y - grid.min[1]) * grid.cell;
  const double east = grid.max[0] - cells_beyond(grid.max[0] - span.max_x) * grid.cell;
  const double north = grid.max[1] - cells_beyond(grid.max[1] - span.max_y) * grid.cell;
  if (!(west < east && south < north)) {
    return "";
  }
  return fmt::format("grid.min = [{:.12g}, {:.12g}, {:.12g}] and grid.max = [{:.12g}, {:.12g}, {:.12g}]", west, south,
                     grid.min[2], east, north, grid.max[2]);
}

void check_domain(const config::Case& parameters, const Rectangle& domain, const Raster& points) {
  const config::Terrain& terrain = parameters.terrain;
  if (points.columns < 2 || points.rows < 2) {
    throw UserError(
        "{}: {} has {} x {} points {:.6g} m apart; needed: at least 2 x 2. Use a larger DEM, or a smaller distance.",
        place_of(parameters, terrain.resample > 0.0 ? "terrain.resample" : "terrain.file"), terrain.file,
        points.columns, points.rows, points.cell_x);
  }
  const Rectangle span = span_of_points(points);
  const std::string beyond = describe_overhang(domain, span);
  if (beyond.empty()) {
    return;
  }
  const bool low = domain.min_x < span.min_x || domain.min_y < span.min_y;
  const std::string within = domain_within(parameters.grid, span);
  throw UserError("{}: the domain {} {}{}, by {}; allowed: {}. Set {}, or take a larger DEM.",
                  place_of(parameters, low ? "grid.min" : "grid.max"),
                  domain.touches(span) ? "reaches beyond the outermost points of" : "lies outside", terrain.file,
                  terrain.resample > 0.0 ? fmt::format(", taken to points {:g} m apart", terrain.resample) : "", beyond,
                  format_range(span), within.empty() ? "grid.min and grid.max so" : within);
}

// Rectangles around polygons of releases and boxes. Unreadable files are reported when the release is loaded.
std::vector<Rectangle> places_of_bodies(const std::map<std::string, config::Body>& bodies, const std::string& crs) {
  std::vector<Rectangle> extents;
  for (const auto& [name, body] : bodies) {
    if (body.shape == config::BodyShape::box) {
      extents.push_back({body.min[0], body.min[1], body.max[0], body.max[1]});
    } else if (!body.release.empty()) {
      try {
        for (const Feature& feature :
             features_named(read_polygons(body.release, crs), body.polygons, body.name_attribute)) {
          extents.push_back(extent_of(feature.polygons));
        }
      } catch (const UserError&) {
        return {};
      }
    }
  }
  return extents;
}

Dem dem_of(const config::Case& parameters, const Rectangle& domain, std::vector<std::string>& warnings) {
  const config::Terrain& terrain = parameters.terrain;
  const DemFile file(located(parameters, "terrain.file", terrain.file), located(parameters, "terrain.crs", terrain.crs),
                     located(parameters, "terrain.resample", terrain.resample), warnings);
  check_domain(parameters, domain, file.points());
  return load_dem(file, domain, parameters.grid.cell, terrain.smooth,
                  places_of_bodies(parameters.bodies, file.points().crs), warnings);
}

// Reads the only line of a file, a part of which must lie in the domain.
config::Polyline2 load_line(const Located<std::string>& file, const Rectangle& domain, const std::string& crs,
                            std::vector<std::string>& warnings) {
  return at_place(file.place, [&] {
    const VectorLayer layer = read_lines(file.value, crs);
    warnings.insert(warnings.end(), layer.warnings.begin(), layer.warnings.end());
    if (layer.features.size() != 1 || layer.features.front().lines.size() != 1) {
      std::size_t lines = 0;
      for (const Feature& feature : layer.features) {
        lines += feature.lines.size();
      }
      throw UserError("{}: the file has {} lines; allowed: one. Join them, or delete the others.", file.value, lines);
    }
    const config::Polyline2& line = layer.features.front().lines.front();
    if (line.size() < 2) {
      throw UserError("{}: the line has {} corner; needed: at least 2.", file.value, line.size());
    }
    const Rectangle extent = extent_of(line);
    if (!extent.touches(domain)) {
      throw UserError(
          "{}: the line ({}) lies outside the domain ({}). Check that both have the same place and reference system.",
          file.value, format_range(extent), format_range(domain));
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
  const Rectangle domain = domain_of(parameters.grid);
  Dem dem;
  if (parameters.terrain.kind == config::TerrainKind::dem) {
    dem = dem_of(parameters, domain, loaded.warnings);
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
    const auto place = [&parameters, name = name](const std::string& key) {
      return place_of(parameters, fmt::format("body.{}.{}", name, key));
    };
    releases[name] =
        load_release({name, body, place, dem, domain, parameters.terrain.file, parameters.time.end, loaded.warnings});
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
    site.path = load_line(located(parameters, "maps.path", parameters.maps.path), domain, site.crs, loaded.warnings);
  }
  for (const auto& [name, probe] : parameters.probes) {
    site.probes[name] = probe.line.empty()
                            ? config::Polyline2{{probe.point[0], probe.point[1]}}
                            : load_line(located(parameters, fmt::format("probe.{}.line", name), probe.line), domain,
                                        site.crs, loaded.warnings);
  }
  // Bodies from one file share warnings, which are kept once.
  std::set<std::string> known;
  std::erase_if(loaded.warnings, [&](const std::string& warning) { return !known.insert(warning).second; });
  return loaded;
}

}  // namespace thawslide::gis
