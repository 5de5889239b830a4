#include "gis/release.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "base/raster.hpp"
#include "base/rounding.hpp"
#include "base/text.hpp"
#include "gis/point_window.hpp"
#include "gis/polygons.hpp"
#include "gis/reference_system.hpp"
#include "gis/sampling.hpp"

namespace thawslide::gis {

namespace {

// Ground points around an extent, whether read or not: missing ground is reported later, for points that need it.
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

// A release smaller than a cell would become thinner, as its volume is distributed over the cells of DEM points.
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

Rectangle extent_of_positive(const ReleaseInput& input, const Raster& source) {
  const config::MapValue& thickness = input.body.thickness;
  std::optional<Rectangle> extent;
  for_each_point(source, [&](int column, int row, double value) {
    if (value > 0.0) {
      const double x = source.x_of(column), y = source.y_of(row);
      extent = extent.value_or(Rectangle{x, y, x, y});
      extent->include(x, y);
    }
  });
  if (!extent && thickness.from == config::MapValue::From::raster) {
    input.fail("thickness", "{}: the thickness is not above 0 at any point: there is no release.", thickness.source);
  }
  if (!extent) {
    input.fail("thickness",
               "{}: the surface before the slide is at most {:g} m above the DEM: there is no release. Are the two "
               "files swapped?",
               thickness.source, input.body.surface_tolerance);
  }
  return *extent;
}

// Means of the height of a finer surface above the ground, over the fraction of each cell in which it is known.
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

// Height of a coarser surface above the ground's points. Points at its rim are weighted by heights at the surface's
// points, because its elevations there belong to other positions.
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
  ReleaseArea area;
  area.source = thickness_without_polygons(input);
  const Rectangle extent = extent_of_positive(input, area.source);
  check_area(input, extent, std::ranges::any_of(area.source.values, [](double value) { return value > thickest; }));
  check_taper(input, extent);
  const Rectangle reached = extent.widened(area.source.cell_x, area.source.cell_y);
  area.fraction = sampled(area.source, points_about(reached, input.body.taper, ground), Missing::zero);
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

// Crops to the points with a thickness and one more on each side, within the extent of the ground.
Raster cropped(const Raster& thickness, const Raster& ground) {
  PointWindow window{thickness.columns, thickness.rows, 0, 0};
  int last_column = -1, last_row = -1;
  for_each_point(thickness, [&](int column, int row, double value) {
    if (value > 0.0) {
      window.first_column = std::min(window.first_column, column);
      window.first_row = std::min(window.first_row, row);
      last_column = std::max(last_column, column);
      last_row = std::max(last_row, row);
    }
  });
  THAWSLIDE_ASSERT(last_column >= 0, "{} x {} points without a thickness", thickness.columns, thickness.rows);
  const PointWindow on_ground = points_of(ground, thickness);
  window.first_column = std::max(window.first_column - 1, on_ground.first_column);
  window.first_row = std::max(window.first_row - 1, on_ground.first_row);
  window.columns = std::min(last_column + 1, on_ground.first_column + on_ground.columns - 1) - window.first_column + 1;
  window.rows = std::min(last_row + 1, on_ground.first_row + on_ground.rows - 1) - window.first_row + 1;
  return part_of(thickness, window);
}

void check_volume(const ReleaseInput& input, const Raster& thickness) {
  const double volume = volume_of(thickness), largest = input.body.largest_volume;
  const double most = *std::ranges::max_element(thickness.values);
  if (!(volume > 0.0)) {
    input.fail("thickness",
               "{}: the release has no volume: its thickness is 0 everywhere. Needed: a thickness in metres.",
               input.area_file());
  }
  if (volume > largest) {
    input.fail(input.area_key(),
               "{}: the release has {} m3, is up to {} m thick, and body.{}.largest_volume allows {} m3. {} If the "
               "volume is right, confirm it by a larger body.{}.largest_volume.",
               input.area_file(), rounded_text(volume, 3), rounded_text(most, 3), input.name, rounded_text(largest, 3),
               input.body.release.empty() && most > thickest ? swapped_dem
                                                             : "Is the thickness in the wrong unit? Metres are needed.",
               input.name);
  }
}

// Time of a body from an attribute of its polygons [s]; 0 without one.
double release_time_of(const ReleaseInput& input, const ReleaseArea& area) {
  const std::string& attribute = input.body.release_time.attribute;
  if (attribute.empty()) {
    return 0.0;
  }
  const std::vector<ValuedArea> parts = at_place(input.place("release_time"), [&] {
    return areas_by_value(area.layer, attribute, input.full_key("release_time"));
  });
  const double first = parts.front().value, last = parts.back().value;
  if (parts.size() > 1) {
    input.fail(
        "release_time",
        "{}: the attribute '{}' of the polygons of body.{} is from {:g} to {:g}; allowed: one value. Make a body "
        "of each stage, and select its polygons by body.NAME.polygons.",
        input.area_file(), attribute, input.name, first, last);
  }
  if (!(first >= 0.0 && first < input.end)) {
    input.fail("release_time",
               "{}: the attribute '{}' is {:g} s; allowed: from 0 to less than time.end, {:g} s. Correct it.",
               input.area_file(), attribute, first, input.end);
  }
  return first;
}

// Field with the range of the key's number: above `low`, up to `high`.
struct MappedField {
  const char* key;
  InitialField config::Body::*member;
  double low, high;
  const char* unit;
  Quantity quantity;
};

constexpr MappedField mapped_fields[] = {
    {"temperature", &config::Body::temperature, -273.15, 100.0, " C", Quantity::temperature},
    {"porosity", &config::Body::porosity, 0.0, 0.95, "", Quantity::fraction},
    {"saturation", &config::Body::saturation, 0.0, 1.0, "", Quantity::fraction},
    {"ice_content", &config::Body::ice_content, 0.0, 0.95, "", Quantity::fraction},
};

// Means of the polygons' values over each point's cell; NaN outside the polygons.
Raster from_attribute(const ReleaseArea& area, const std::string& attribute, const std::string& key) {
  Raster sum = area.fraction.filled(0.0), weight = sum;
  for (const ValuedArea& part : areas_by_value(area.layer, attribute, key)) {
    const Raster fraction = coverage_of(part.polygons, area.fraction);
    for (std::size_t k = 0; k < fraction.values.size(); ++k) {
      sum.values[k] += part.value * fraction.values[k];
      weight.values[k] += fraction.values[k];
    }
  }
  for (std::size_t k = 0; k < sum.values.size(); ++k) {
    sum.values[k] =
        weight.values[k] > 0.0 ? sum.values[k] / weight.values[k] : std::numeric_limits<double>::quiet_NaN();
  }
  return sum;
}

// `missing`: whether a no-data point is an error.
void check_values(const Raster& field, const Raster& fraction, const MappedField& what, const std::string& source,
                  bool missing = true) {
  for_each_point(field, [&](int column, int row, double value) {
    const bool is_allowed = (value > what.low && value <= what.high) || (std::isnan(value) && !missing);
    if (fraction.at(column, row) > 0.0 && !is_allowed) {
      throw UserError("{}: at {}, {}, within the release, the {} is {}; allowed: above {:g}{} and up to {:g}{}.",
                      source, coordinate_text(field.x_of(column)), coordinate_text(field.y_of(row)), what.key,
                      std::isnan(value) ? "missing" : fmt::format("{:g}{}", value, what.unit), what.low, what.unit,
                      what.high, what.unit);
    }
  });
}

// Single values of a finer raster are checked too, because a mean may hide an invalid one.
Raster from_raster(const ReleaseArea& area, const Raster& map, const MappedField& what, const std::string& source) {
  if (!is_finer(map, area.fraction)) {
    return sampled(map, area.fraction, Missing::nothing);
  }
  const Polygons polygons = area.is_raster() ? areas_of_mask(area.fraction) : area.polygons;
  const CoveredRaster part = covered_part(map, polygons);
  check_values(part.values, part.fraction, what, source, false);
  return averaged(part, area.fraction).mean;
}

// Initial fields from maps by key, at the points of `thickness`, which are among those of the area's `fraction`. Points
// outside the release have the value of the nearest one within. Throws UserError for a missing or invalid value.
std::map<std::string, Raster> fields_of(const ReleaseInput& input, const ReleaseArea& area, const Raster& thickness) {
  std::map<std::string, Raster> fields;
  for (const MappedField& what : mapped_fields) {
    const InitialField& field = input.body.*what.member;
    if (!field.is_map()) {
      continue;
    }
    const std::string place = input.place(what.key);
    const bool is_raster = field.over == InitialField::Over::raster;
    const Raster map =
        is_raster ? read_map({{field.source, place}, what.quantity, area.fraction.crs, span_of_points(area.fraction)},
                             input.warnings)
                  : Raster{};
    fields[what.key] = at_place(place, [&] {
      Raster made = is_raster ? from_raster(area, map, what, field.source)
                              : from_attribute(area, field.source, input.full_key(what.key));
      check_values(made, area.fraction, what, is_raster ? field.source : area.layer.file);
      for (std::size_t k = 0; k < made.values.size(); ++k) {
        if (!(area.fraction.values[k] > 0.0)) {
          made.values[k] = std::numeric_limits<double>::quiet_NaN();
        }
      }
      fill_from_nearest_known(made);
      return part_of(made, points_of(thickness, made));
    });
  }
  return fields;
}

}  // namespace

LoadedRelease load_release(const ReleaseInput& input) {
  ReleaseArea area = input.body.release.empty() ? area_of_raster(input) : area_of_polygons(input);
  const Raster thickness = vertical_thickness_of(input, area);
  check_volume(input, thickness);
  LoadedRelease loaded;
  config::Release& release = loaded.release;
  release.release_time = release_time_of(input, area);
  release.thickness = cropped(thickness, input.ground.raster);
  release.fields = fields_of(input, area, release.thickness);
  release.outlines = rings_of(area.polygons);
  loaded.polygons = area.is_raster() ? areas_of_mask(area.fraction) : std::move(area.polygons);
  release.area = area_of(loaded.polygons);
  loaded.spread = tapered(area.fraction, input.body.taper);
  loaded.fraction = std::move(area.fraction);
  return loaded;
}

}  // namespace thawslide::gis
