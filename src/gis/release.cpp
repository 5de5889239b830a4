#include "gis/release.hpp"

#include <algorithm>
#include <cmath>

#include "base/raster_sampling.hpp"
#include "base/rounding.hpp"
#include "gis/error_location.hpp"
#include "gis/geopackage.hpp"
#include "gis/point_window.hpp"
#include "gis/release_area.hpp"
#include "gis/release_fields.hpp"
#include "gis/release_thickness.hpp"
#include "gis/taper.hpp"
#include "gis/valued_areas.hpp"

namespace thawslide::gis {

namespace {

// Crops to the points with a thickness and one more on each side, within the extent of the ground.
Raster cropped(const Raster& thickness, const Raster& ground) {
  PointWindow window{thickness.columns, thickness.rows, 0, 0};
  int last_column = -1, last_row = -1;
  for (int row = 0; row < thickness.rows; ++row) {
    for (int column = 0; column < thickness.columns; ++column) {
      if (thickness.at(column, row) > 0.0) {
        window.first_column = std::min(window.first_column, column);
        window.first_row = std::min(window.first_row, row);
        last_column = std::max(last_column, column);
        last_row = std::max(last_row, row);
      }
    }
  }
  THAWSLIDE_ASSERT(last_column >= 0, "{} x {} points without a thickness", thickness.columns, thickness.rows);
  const PointWindow on_ground = points_of(ground, thickness);
  window.first_column = std::max(window.first_column - 1, on_ground.first_column);
  window.first_row = std::max(window.first_row - 1, on_ground.first_row);
  window.columns = std::min(last_column + 1, on_ground.first_column + on_ground.columns - 1) - window.first_column + 1;
  window.rows = std::min(last_row + 1, on_ground.first_row + on_ground.rows - 1) - window.first_row + 1;
  return part_of(thickness, window);
}

void check_volume(const config::Case& parameters, const std::string& name, const Raster& thickness) {
  const double volume = volume_of(thickness);
  const double most = *std::max_element(thickness.values.begin(), thickness.values.end());
  if (!(volume > 0.0)) {
    fail_at(parameters, key_of(name, "thickness"),
            "{}: the release has no volume: its thickness is 0 everywhere. Needed: a thickness in metres.",
            area_file(parameters, name));
  }
  const double largest = parameters.bodies.at(name).largest_volume;
  if (volume > largest) {
    fail_at(parameters, area_key(parameters, name),
            "{}: the release has {} m3, is up to {} m thick, and body.{}.largest_volume allows {} m3. {} If the volume "
            "is right, confirm it by a larger body.{}.largest_volume.",
            area_file(parameters, name), rounded_text(volume, 3), rounded_text(most, 3), name, rounded_text(largest, 3),
            parameters.bodies.at(name).release.empty() && most > thickest
                ? swapped_dem
                : "Is the thickness in the wrong unit? Metres are needed.",
            name);
  }
}

// A thickness in a wrong unit makes a release implausibly tall.
void warn_of_thick_release(const std::string& name, const config::Release& release,
                           std::vector<std::string>& warnings) {
  constexpr double fraction_of_width = 0.5;
  const double width = std::sqrt(release.area);
  const double most = *std::max_element(release.thickness.values.begin(), release.thickness.values.end());
  if (most > fraction_of_width * width) {
    warnings.push_back(fmt::format(
        "the release of the body {} is up to {} m thick and, by its area, {} m wide: is the thickness in metres?", name,
        rounded_text(most, 3), rounded_text(width, 3)));
  }
}

// Time of a body from an attribute of its polygons [s]; 0 without one.
double release_time_of(const config::Case& parameters, const std::string& name, const ReleaseArea& area) {
  const std::string& attribute = parameters.bodies.at(name).release_time.attribute;
  if (attribute.empty()) {
    return 0.0;
  }
  const std::string key = key_of(name, "release_time");
  const std::vector<ValuedArea> parts =
      with_error_location(parameters, key, [&] { return areas_by_value(area.layer, attribute, key); });
  const double first = parts.front().value, last = parts.back().value;
  if (parts.size() > 1) {
    fail_at(parameters, key,
            "{}: the attribute '{}' of the polygons of body.{} is from {:g} to {:g}; allowed: one value. Make a body "
            "of each stage, and select its polygons by body.NAME.polygons.",
            area_file(parameters, name), attribute, name, first, last);
  }
  if (!(first >= 0.0 && first < parameters.time.end)) {
    fail_at(parameters, key,
            "{}: the attribute '{}' is {:g} s; allowed: from 0 to less than time.end, {:g} s. Correct it.",
            area_file(parameters, name), attribute, first, parameters.time.end);
  }
  return first;
}

}  // namespace

LoadedRelease load_release(const config::Case& parameters, const std::string& body, const Dem& ground,
                           std::vector<std::string>& warnings) {
  ReleaseArea area = load_release_area(parameters, body, ground, warnings);
  const Raster thickness = vertical_thickness_of(parameters, body, area, ground, warnings);
  check_volume(parameters, body, thickness);
  LoadedRelease loaded;
  config::Release& release = loaded.release;
  release.release_time = release_time_of(parameters, body, area);
  release.thickness = cropped(thickness, ground.raster);
  release.fields = fields_of(parameters, body, area, release.thickness, warnings);
  for (const Polygon& polygon : area.polygons) {
    release.outlines.push_back(polygon.outline);
    release.outlines.insert(release.outlines.end(), polygon.holes.begin(), polygon.holes.end());
  }
  loaded.polygons = area.is_raster() ? areas_of_mask(area.fraction) : std::move(area.polygons);
  release.area = area_of(loaded.polygons);
  warn_of_thick_release(body, release, warnings);
  loaded.spread = tapered(area.fraction, parameters.bodies.at(body).taper);
  loaded.fraction = std::move(area.fraction);
  return loaded;
}

}  // namespace thawslide::gis
