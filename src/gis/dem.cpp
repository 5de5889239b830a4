#include "gis/dem.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/rounding.hpp"
#include "base/shell_quote.hpp"
#include "base/text.hpp"
#include "config/input_limits.hpp"
#include "gis/case_inputs.hpp"
#include "gis/dem_warnings.hpp"
#include "gis/features.hpp"
#include "gis/filters.hpp"
#include "gis/polygons.hpp"
#include "gis/raster_file.hpp"
#include "gis/reference_system.hpp"
#include "gis/roughness.hpp"

namespace thawslide::gis {

namespace {

// `given`: as terrain.crs.
std::string system_of(const RasterFile& file, const std::string& given, std::vector<std::string>& warnings) {
  const Raster& layout = file.layout();
  const Located located{file.file(), file.extent(), layout.cell_x, layout.cell_y};
  const std::string system = metric_system(located, layout.crs, given);
  add_warning(location_warning(located, system), warnings);
  add_warning(distortion_note(located, system, !given.empty()), warnings);
  if (!given.empty() && name_of(system) != name_of(layout.crs)) {
    warnings.push_back(fmt::format("note: {} is read as {}, as set by terrain.crs; the file specifies {}",
                                   name_of_file(file.file()), name_of(system),
                                   layout.crs.empty() ? "nothing" : name_of(layout.crs)));
  }
  return system;
}

// Detects undeclared no-data values, which would act as pits.
void check_elevations(const std::string& file, const Raster& raster) {
  constexpr double deepest = -11000.0, highest = 9000.0;  // m, on Earth
  for_each_point(raster, [&](int column, int row, double z) {
    const bool is_elevation = z >= deepest && z <= highest && z != -9999.0;
    if (!std::isnan(z) && !is_elevation) {
      throw UserError(
          "{}: the elevation at {}, {} is {:g} m, which is impossible on Earth. If it represents missing data, "
          "declare it in the file: gdal_translate -a_nodata {:.9g} {} with-nodata.tif",
          file, coordinate_text(raster.x_of(column)), coordinate_text(raster.y_of(row)), z, z, shell_quote(file));
    }
  });
}

// Domain reduced by the grid cells that extend outside the DEM; empty if none remain.
std::string domain_within(const config::Case& parameters, const Rectangle& span) {
  const config::Grid& grid = parameters.grid;
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

void check_domain(const config::Case& parameters, const std::string& file, const Rectangle& span) {
  const Rectangle domain = domain_of(parameters);
  const std::string beyond = describe_overhang(domain, span);
  if (beyond.empty()) {
    return;
  }
  const bool low = domain.min_x < span.min_x || domain.min_y < span.min_y;
  const std::string within = domain_within(parameters, span);
  const double resample = parameters.terrain.resample;
  fail_at(parameters, low ? "grid.min" : "grid.max",
          "the domain {} {}{}, by {}; allowed: {}. Set {}, or take a larger DEM.",
          domain.touches(span) ? "reaches beyond the outermost points of" : "lies outside", file,
          resample > 0.0 ? fmt::format(", taken to points {:g} m apart", resample) : "", beyond, format_range(span),
          within.empty() ? "grid.min and grid.max so" : within);
}

// Margin around the domain: nodes of the surrounding grid cells read the ground, and gradients there need neighbours.
Rectangle area_to_read(const config::Case& parameters, const Raster& layout) {
  const double grid_cells = 3.0 * parameters.grid.cell;
  return domain_of(parameters).widened(grid_cells + 2.0 * layout.cell_x, grid_cells + 2.0 * layout.cell_y);
}

// Points of the whole DEM are numbered before those of the domain are read.
void check_distance(const config::Case& parameters, const RasterFile& file) {
  const Raster& layout = file.layout();
  const double length = std::max((layout.columns - 1) * layout.cell_x, (layout.rows - 1) * layout.cell_y);
  const double distance = parameters.terrain.resample;
  if (distance > 0.0 && length / distance > config::most_raster_points) {
    fail_at(parameters, "terrain.resample",

            "points {:g} m apart along the {:.6g} m of {} would be {:.2g}; allowed: {:g}. Give a larger distance.",
            distance, length, file.file(), length / distance, config::most_raster_points);
  }
}

Raster read_and_resample(const config::Case& parameters, const RasterFile& file, const Raster& layout,
                         const Rectangle& area, std::vector<std::string>& warnings) {
  const bool as_it_is = &layout == &file.layout();
  const Raster target = layout_of(layout, points_in(layout, area));
  Raster raster = with_error_location(parameters, "terrain.file", [&] {
    Raster read = file.read(as_it_is ? area : needed_for(target));
    check_elevations(file.file(), read);
    return read;
  });
  add_warning(pits_warning(file.file(), raster), warnings);
  add_warning(thickness_warning(file.file(), raster), warnings);
  if (as_it_is) {
    return raster;
  }
  with_error_location(parameters, "terrain.resample",
                      [&] { require_readable(file.file(), target.columns, target.rows); });
  return resampled(raster, target);
}

// Rectangles around the polygons of releases and around boxes. Unreadable files are reported when the release is
// loaded.
std::vector<Rectangle> places_of_bodies(const config::Case& parameters, const std::string& crs) {
  std::vector<Rectangle> extents;
  for (const auto& [name, body] : parameters.bodies) {
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

// Points interpolated between those of the file have no noise themselves.
config::Roughness roughness_of_file(const config::Case& parameters, const RasterFile& file, const Raster& raster,
                                    const std::string& crs) {
  const bool interpolated = raster.cell_x * raster.cell_y < file.layout().cell_x * file.layout().cell_y;
  return roughness_of(interpolated ? file.read(area_to_read(parameters, file.layout())) : raster, domain_of(parameters),
                      parameters.grid.cell, parameters.terrain.smooth, places_of_bodies(parameters, crs));
}

}  // namespace

Raster read_dem(const std::string& file, const std::string& crs, std::vector<std::string>& warnings) {
  const RasterFile opened(file, Quantity::length);
  const std::string system = system_of(opened, crs, warnings);
  add_warning(opened.conversion().warning, warnings);
  Raster raster = opened.read();
  check_elevations(file, raster);
  add_warning(thickness_warning(file, raster), warnings);
  raster.crs = system;
  return raster;
}

Dem load_dem(const config::Case& parameters, std::vector<std::string>& warnings) {
  const config::Terrain& terrain = parameters.terrain;
  const auto opened = with_error_location(parameters, "terrain.file",
                                          [&] { return std::make_unique<RasterFile>(terrain.file, Quantity::length); });
  const RasterFile& file = *opened;
  const std::string system = with_error_location(parameters, terrain.crs.empty() ? "terrain.file" : "terrain.crs",
                                                 [&] { return system_of(file, terrain.crs, warnings); });
  add_warning(file.conversion().warning, warnings);
  check_distance(parameters, file);
  const Raster made = terrain.resample > 0.0 ? resampled_layout(file.layout(), terrain.resample) : Raster{};
  const Raster& layout = terrain.resample > 0.0 ? made : file.layout();
  if (layout.columns < 2 || layout.rows < 2) {
    fail_at(parameters, terrain.resample > 0.0 ? "terrain.resample" : "terrain.file",

            "{} has {} x {} points {:.6g} m apart; needed: at least 2 x 2. Use a larger DEM, or a smaller distance.",
            file.file(), layout.columns, layout.rows, layout.cell_x);
  }
  Dem dem;
  dem.span = span_of_points(layout);
  check_domain(parameters, file.file(), dem.span);
  const Rectangle area = area_to_read(parameters, layout);
  std::vector<std::string> of_reading;
  dem.raster = read_and_resample(parameters, file, layout, area, of_reading);
  dem.roughness = roughness_of_file(parameters, file, dem.raster, system);
  const double width = dem.roughness.width;
  if (width > 0.0) {
    // Reach of the filter, plus the points that a window includes beyond its sides.
    const double reach = smoothing_reach * width + 2.0 * std::max(layout.cell_x, layout.cell_y);
    dem.before_smoothing = std::move(dem.raster);
    of_reading.clear();
    dem.raster = smoothed(read_and_resample(parameters, file, layout, area.widened(reach, reach), of_reading), width);
    dem.raster = part_of(dem.raster, points_of(dem.before_smoothing, dem.raster));
    THAWSLIDE_ASSERT(dem.raster.values.size() == dem.before_smoothing.values.size(), "{} smoothed points of {}",
                     dem.raster.values.size(), dem.before_smoothing.values.size());
  }
  warnings.insert(warnings.end(), of_reading.begin(), of_reading.end());
  const std::string name = name_of_file(file.file());
  if (terrain.resample > 0.0) {
    warnings.push_back(fmt::format("note: {} was resampled from points {:g} m x {:g} m apart to points {:g} m apart",
                                   name, file.layout().cell_x, file.layout().cell_y, terrain.resample));
  }
  if (width > 0.0) {
    warnings.push_back(fmt::format(
        "note: {} was smoothed with a standard deviation of {:g} m{}", name, width,
        terrain.smooth.is_auto
            ? fmt::format(
                  ", as it has noise of {:.2g} m rms and bumps with an rms slope of {:.2g} (terrain.smooth = \"auto\")",
                  dem.roughness.noise, dem.roughness.bump_slope)
            : ""));
  }
  dem.raster.crs = dem.before_smoothing.crs = system;
  const std::string of_key = terrain.crs.empty() ? "" : height_system_of(reference_system_named(terrain.crs));
  dem.heights = of_key.empty() ? height_system_of(file.layout().crs) : of_key;
  return dem;
}

}  // namespace thawslide::gis
