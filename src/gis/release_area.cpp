// Areas of releases.

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/rounding.hpp"
#include "base/shell_quote.hpp"
#include "gis/features.hpp"
#include "gis/filters.hpp"
#include "gis/polygons.hpp"
#include "gis/reference_system.hpp"
#include "gis/release.hpp"
#include "gis/sampling.hpp"

namespace thawslide::gis {

namespace {

// Ground points around an extent, including those outside the points that were read: missing ground is reported later,
// for points that need it.
Raster points_about(const Rectangle& extent, double taper, const Raster& ground) {
  const auto along = [&](double low, double high, double first, double cell, double& new_first, int& count) {
    const int margin = 2 + taper_reach(taper, cell);
    const int begin = static_cast<int>(std::floor((low - first) / cell)) - margin;
    new_first = first + begin * cell;
    count = static_cast<int>(std::ceil((high - first) / cell)) + margin - begin + 1;
  };
  Raster layout;
  layout.cell_x = ground.cell_x;
  layout.cell_y = ground.cell_y;
  layout.crs = ground.crs;
  along(extent.min_x, extent.max_x, ground.x, ground.cell_x, layout.x, layout.columns);
  along(extent.min_y, extent.max_y, ground.y, ground.cell_y, layout.y, layout.rows);
  return layout;
}

// `extent`: of all positive thickness before tapering. `is_dem`: the thickness seems to be elevations.
void check_area(const ReleaseInput& input, const Rectangle& extent, bool is_dem = false) {
  const auto check = [&](const char* what, const Rectangle& outer, const std::string& remedy) {
    const std::string beyond = describe_overhang(extent, outer);
    if (!beyond.empty()) {
      input.fail(input.area_key(), "{}: the release lies {}outside {}, by {}; found: {}; allowed: {}. {}",
                 input.area_file(), extent.touches(outer) ? "partly " : "", what, beyond, format_range(extent),
                 format_range(outer), remedy);
    }
  };
  check(
      "the DEM", input.ground.span,
      fmt::format("Check that both have the same location and reference system (the DEM has {}), or use a larger DEM.",
                  name_of(input.ground.raster.crs)));
  check("the domain", input.domain, is_dem ? swapped_dem : "Widen grid.min and grid.max.");
}

// Widest taper whose points lie within `outer`, around an extent that does.
double widest_taper(const Rectangle& extent, const Rectangle& outer, const Raster& ground) {
  const auto along = [](double available, double cell) {
    return 2.0 * (std::floor(available / cell + 1e-9) + 1.0) * cell;
  };
  return std::min({along(extent.min_x - outer.min_x, ground.cell_x), along(outer.max_x - extent.max_x, ground.cell_x),
                   along(extent.min_y - outer.min_y, ground.cell_y), along(outer.max_y - extent.max_y, ground.cell_y)});
}

void check_taper(const ReleaseInput& input, const Rectangle& extent) {
  const double taper = input.body.taper;
  const Raster& points = input.ground.raster;
  const Rectangle reached = extent.widened(taper_reach(taper, points.cell_x) * points.cell_x,
                                           taper_reach(taper, points.cell_y) * points.cell_y);
  const auto check = [&](const char* what, const Rectangle& outer, const char* remedy) {
    const std::string beyond = describe_overhang(reached, outer);
    if (!beyond.empty()) {
      input.fail(
          "taper",
          "a taper of {:g} m spreads the release {:g} m beyond its outline, and outside {} by {}; allowed: up to "
          "{:.9g} m. Set a narrower one, or {}.",
          taper, 0.5 * taper, what, beyond, widest_taper(extent, outer, points), remedy);
    }
  };
  check("the DEM", input.ground.span, "take a larger DEM");
  check("the domain", input.domain, "widen grid.min and grid.max");
}

// A release smaller than a cell would become much thinner, because its volume is distributed over the cells of DEM
// points.
void check_size(const ReleaseInput& input, double size) {
  const double cell = input.ground.raster.cell_x * input.ground.raster.cell_y;
  if (size < cell * (1.0 - 1e-9)) {
    const double finer = 0.25 * std::sqrt(size);
    input.fail(
        "release",
        "{}: the release is smaller than a cell of the DEM ({} m2; {} m2), over which it would be distributed and "
        "become too thin. Draw it larger, or resample the DEM (gdalwarp -tr {:.1g} {:.1g} -r bilinear {} finer.tif).",
        input.body.release, rounded_text(size, 3), rounded_text(cell, 3), finer, finer, shell_quote(input.dem_file));
  }
}

Rectangle extent_of_positive(const config::Body& body, const Raster& source) {
  const std::string& file = body.thickness.source;
  std::optional<Rectangle> extent;
  for_each_point(source, [&](int column, int row, double value) {
    if (value > 0.0) {
      const double x = source.x_of(column), y = source.y_of(row);
      extent = extent.value_or(Rectangle{x, y, x, y});
      extent->include(x, y);
    }
  });
  if (!extent) {
    if (body.thickness.from == config::MapValue::From::raster) {
      throw UserError("{}: the thickness is not above 0 at any point: there is no release.", file);
    }
    throw UserError(
        "{}: the surface before the slide is at most {:g} m above the DEM: there is no release. Are the two files "
        "swapped?",
        file, body.surface_tolerance);
  }
  return *extent;
}

// Means of the height of a finer surface above the ground, over the fraction of each cell in which the surface is
// known.
Raster finer_above(const Raster& surface, const Raster& ground, double tolerance) {
  Raster above = averaged(above_ground(surface, ground), ground, Missing::nothing);
  Raster known = surface;
  for (double& value : known.values) {
    value = std::isnan(value) ? 0.0 : 1.0;
  }
  const Raster fraction = averaged(known, ground, Missing::zero);
  for (std::size_t k = 0; k < above.values.size(); ++k) {
    above.values[k] = above.values[k] > tolerance ? above.values[k] * fraction.values[k] : 0.0;
  }
  return above;
}

// Height of another surface above the ground's points. Points at its rim are weighted by the heights above ground at
// the surface's own points, because its elevations there belong to other positions.
Raster coarser_above(const Raster& surface, const Raster& ground, double tolerance) {
  Raster above = above_ground(sampled(surface, ground, Missing::unknown), ground);
  const Raster fractions = sampled(above_ground(surface, ground), ground, Missing::zero);
  for (std::size_t k = 0; k < above.values.size(); ++k) {
    const bool at_rim = std::isnan(above.values[k]) && !std::isnan(ground.values[k]);
    const double height = at_rim ? fractions.values[k] : above.values[k];
    above.values[k] = height > tolerance ? height : 0.0;
  }
  return above;
}

// Thickness from a raster, or height of a surface above the ground at the ground's points.
Raster thickness_without_polygons(const ReleaseInput& input) {
  const config::MapValue& thickness = input.body.thickness;
  Raster map =
      read_map({{thickness.source, input.place("thickness")}, Quantity::length, input.ground.raster.crs, std::nullopt},
               input.warnings);
  if (thickness.from == config::MapValue::From::raster) {
    return map;
  }
  const Raster& measured = input.ground.as_measured();  // not smoothed, like the surface before release
  const double tolerance = input.body.surface_tolerance;
  return is_finer(map, measured) ? finer_above(map, measured, tolerance) : coarser_above(map, measured, tolerance);
}

ReleaseArea area_of_raster(const ReleaseInput& input) {
  const Raster& ground = input.ground.raster;
  const std::string place = input.place("thickness");
  ReleaseArea area;
  area.source = thickness_without_polygons(input);
  const Rectangle extent = at_place(place, [&] { return extent_of_positive(input.body, area.source); });
  check_area(input, extent, std::ranges::any_of(area.source.values, [](double value) { return value > thickest; }));
  check_taper(input, extent);
  const Rectangle reached = extent.widened(area.source.cell_x, area.source.cell_y);
  area.fraction = at_place(
      place, [&] { return sampled(area.source, points_about(reached, input.body.taper, ground), Missing::zero); });
  for (double& fraction : area.fraction.values) {
    fraction = fraction > 0.0 ? 1.0 : 0.0;
  }
  return area;
}

ReleaseArea area_of_polygons(const ReleaseInput& input) {
  const config::Body& body = input.body;
  const Raster& ground = input.ground.raster;
  ReleaseArea area;
  area.layer = read_named_polygons(
      {{body.release, input.place("release")}, {body.polygons, input.place("polygons")}, body.name_attribute},
      ground.crs, input.warnings);
  area.polygons = union_of_features(area.layer);
  const Rectangle extent = extent_of(area.polygons);
  check_area(input, extent);
  check_taper(input, extent);
  check_size(input, area_of(area.polygons));
  area.fraction = coverage_of(area.polygons, points_about(extent, body.taper, ground));
  return area;
}

}  // namespace

ReleaseArea load_release_area(const ReleaseInput& input) {
  return input.body.release.empty() ? area_of_raster(input) : area_of_polygons(input);
}

}  // namespace thawslide::gis
