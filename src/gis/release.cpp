#include "gis/release.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/nearest_known.hpp"
#include "base/raster_sampling.hpp"
#include "base/rounding.hpp"
#include "gis/features.hpp"
#include "gis/filters.hpp"
#include "gis/point_window.hpp"
#include "gis/polygons.hpp"
#include "gis/sampling.hpp"

namespace thawslide::gis {

namespace {

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

// A thickness in a wrong unit makes a release implausibly tall.
void warn_of_thick_release(const std::string& name, const config::Release& release,
                           std::vector<std::string>& warnings) {
  constexpr double fraction_of_width = 0.5;
  const double width = std::sqrt(release.area);
  const double most = *std::ranges::max_element(release.thickness.values);
  if (most > fraction_of_width * width) {
    warnings.push_back(fmt::format(
        "the release of the body {} is up to {} m thick and, by its area, {} m wide: is the thickness in metres?", name,
        rounded_text(most, 3), rounded_text(width, 3)));
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
  if (area.is_raster()) {
    throw UserError("a raster gives the release: it has no attributes. Name a raster of the quantity, or a number.");
  }
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

// Initial fields from maps by key of the body, at the points of `thickness`, which are among those of the area's
// `fraction`. Points outside the release have the value of the nearest one within. Throws UserError if a value within
// the release is missing or out of range.
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
  ReleaseArea area = load_release_area(input);
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
  warn_of_thick_release(input.name, release, input.warnings);
  loaded.spread = tapered(area.fraction, input.body.taper);
  loaded.fraction = std::move(area.fraction);
  return loaded;
}

}  // namespace thawslide::gis
