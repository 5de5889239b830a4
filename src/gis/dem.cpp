#include "gis/dem.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/rounding.hpp"
#include "base/text.hpp"
#include "config/input_limits.hpp"
#include "gis/reference_system.hpp"
#include "gis/roughness.hpp"
#include "gis/sampling.hpp"

namespace thawslide::gis {

DemFile::DemFile(const Located<std::string>& file, const Located<std::string>& crs, const Located<double>& resample,
                 std::vector<std::string>& warnings)
    : place_(file.place),
      resample_(resample),
      file_(at_place(file.place, [&] { return RasterFile(file.value, Quantity::length); })) {
  const Raster& layout = file_.layout();
  const std::string name = name_of_file(file.value);
  std::string system;
  at_place(crs.value.empty() ? file.place : crs.place, [&] {
    const MapExtent extent{file.value, file_.extent(), layout.cell_y};
    system = metric_system(extent, layout.crs, crs.value);
    add_warning(location_warning(extent, system), warnings);
    add_warning(distortion_note(extent, system, !crs.value.empty()), warnings);
    const std::string of_key = crs.value.empty() ? "" : height_system_of(reference_system_named(crs.value));
    heights_ = of_key.empty() ? height_system_of(layout.crs) : of_key;
  });
  if (!crs.value.empty() && name_of(system) != name_of(layout.crs)) {
    warnings.push_back(fmt::format("note: {} is read as {}, as set by terrain.crs; the file specifies {}", name,
                                   name_of(system), layout.crs.empty() ? "nothing" : name_of(layout.crs)));
  }
  add_warning(file_.conversion().warning, warnings);
  const double distance = resample.value;
  // Points of the whole DEM are numbered before those of the domain are read.
  const double length = std::max((layout.columns - 1) * layout.cell_x, (layout.rows - 1) * layout.cell_y);
  if (distance > 0.0 && length / distance > config::most_raster_points) {
    throw UserError(
        "{}: points {:g} m apart along the {:.6g} m of {} would be {:.2g}; allowed: {:g}. Give a larger distance.",
        resample.place, distance, length, file.value, length / distance, config::most_raster_points);
  }
  points_ = distance > 0.0 ? resampled_layout(layout, distance) : layout;
  points_.crs = system;
  if (distance > 0.0) {
    warnings.push_back(fmt::format("note: {} was resampled from points {:g} m x {:g} m apart to points {:g} m apart",
                                   name, layout.cell_x, layout.cell_y, distance));
  }
}

Raster DemFile::read_own_points(const std::optional<Rectangle>& area) const {
  return at_place(place_, [&] {
    Raster raster = file_.read(area);
    constexpr double deepest = -11000.0, highest = 9000.0;  // m, on Earth
    for_each_point(raster, [&](int column, int row, double z) {
      const bool is_elevation = z >= deepest && z <= highest && z != -9999.0;
      if (!std::isnan(z) && !is_elevation) {  // a no-data value that is not declared would act as a pit
        throw UserError(
            "{}: the elevation at {}, {} is {:g} m, which is impossible on Earth. If it represents missing data, "
            "declare it in the file: gdal_translate -a_nodata {:.9g} {} with-nodata.tif",
            file(), coordinate_text(raster.x_of(column)), coordinate_text(raster.y_of(row)), z, z, shell_quote(file()));
      }
    });
    raster.crs = points_.crs;
    return raster;
  });
}

Raster DemFile::read(const Rectangle& area) const {
  if (!(resample_.value > 0.0)) {
    return read_own_points(area);
  }
  const Raster target = layout_of(points_, points_in(points_, area));
  const Raster raster = read_own_points(needed_for(target));
  at_place(resample_.place, [&] { require_readable(file(), target.columns, target.rows); });
  return resampled(raster, target);
}

Dem load_dem(const DemFile& file, const Rectangle& domain, double cell, const config::NumberOrAuto& smooth,
             const std::vector<Rectangle>& bodies, std::vector<std::string>& warnings) {
  const Raster &points = file.points(), &own = file.own_points();
  const std::string name = name_of_file(file.file());
  // Nodes of the grid cells around the domain read the ground, and gradients there need neighbours.
  const auto around = [&](const Raster& layout) {
    return domain.widened(3.0 * cell + 2.0 * layout.cell_x, 3.0 * cell + 2.0 * layout.cell_y);
  };
  const Rectangle area = around(points);
  Dem dem;
  dem.span = span_of_points(points);
  dem.heights = file.heights();
  dem.raster = file.read(area);
  add_warning(warning_of_zeros(file.file(), dem.raster), warnings);
  const bool is_interpolated = points.cell_x * points.cell_y < own.cell_x * own.cell_y;  // and has no noise itself
  dem.roughness =
      roughness_of(is_interpolated ? file.read_own_points(around(own)) : dem.raster, domain, cell, smooth, bodies);
  const double width = dem.roughness.width;
  if (width > 0.0) {
    // Reach of the filter, plus the points that a window includes beyond its sides.
    const double reach = smoothing_reach * width + 2.0 * std::max(points.cell_x, points.cell_y);
    const Raster smooth_ground = smoothed(file.read(area.widened(reach, reach)), width);
    dem.before_smoothing = std::move(dem.raster);
    dem.raster = part_of(smooth_ground, points_of(dem.before_smoothing, smooth_ground));
    warnings.push_back(fmt::format(
        "note: {} was smoothed with a standard deviation of {:g} m{}", name, width,
        smooth.is_auto
            ? fmt::format(
                  ", as it has noise of {:.2g} m rms and bumps with an rms slope of {:.2g} (terrain.smooth = \"auto\")",
                  dem.roughness.noise, dem.roughness.bump_slope)
            : ""));
  }
  return dem;
}

std::vector<std::string> warnings_of_holes(const config::Case& parameters, const config::Site& site) {
  const Raster& ground = *site.ground;
  const Rectangle domain = domain_of(parameters.grid);
  std::size_t points = 0, unknown = 0;
  double x = 0.0, y = 0.0;  // of the first one
  for_each_point(ground, [&](int column, int row, double height) {
    if (!domain.contains(ground.x_of(column), ground.y_of(row))) {
      return;
    }
    ++points;
    if (std::isnan(height) && unknown++ == 0) {
      x = ground.x_of(column);
      y = ground.y_of(row);
    }
  });
  std::vector<std::string> warnings;
  if (unknown > 0) {
    warnings.push_back(
        fmt::format("{} of {} points of the DEM within the domain have no data, such as ({:.0f}, {:.0f}): a slide that "
                    "gets there {}",
                    unknown, points, x, y,
                    parameters.grid.leaving == config::Policy::remove ? "is removed and counted" : "ends the run"));
  }
  for (const auto& [name, corners] : site.probes) {
    const bool is_known = std::ranges::any_of(corners, [&](const auto& corner) {
      return !std::isnan(bilinear(ground, corner[0], corner[1], Missing::unknown));
    });
    if (!is_known) {
      warnings.push_back(fmt::format(
          "probe.{}: the DEM has no data there, and the probe reports zeros. Move it to where the terrain is known.",
          name));
    }
  }
  return warnings;
}

std::string warning_of_zeros(const std::string& file, const Raster& ground) {
  constexpr double near_zero = 100.0;  // m: ground on a coast
  std::size_t points = 0;
  double lowest = HUGE_VAL, highest = -HUGE_VAL, x = 0.0, y = 0.0;
  for_each_point(ground, [&](int column, int row, double height) {
    if (height != 0.0) {
      lowest = std::fmin(lowest, height);
      highest = std::fmax(highest, height);
    } else if (points++ == 0) {
      x = ground.x_of(column);
      y = ground.y_of(row);
    }
  });
  if (points == 0 || !std::isfinite(lowest) || lowest < near_zero) {
    return "";
  }
  return fmt::format(
      "{} point{} of {} {} exactly 0 m among heights of {:.0f} to {:.0f} m, such as ({:.0f}, {:.0f}): a hole without "
      "data? Then declare it in the file, gdal_edit.py -a_nodata 0 {}, or fill it",
      points, points == 1 ? "" : "s", name_of_file(file), points == 1 ? "is" : "are", lowest, highest, x, y, file);
}

}  // namespace thawslide::gis
