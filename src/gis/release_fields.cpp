#include "gis/release_fields.hpp"

#include <cmath>
#include <limits>

#include "base/nearest_known.hpp"
#include "base/rounding.hpp"
#include "gis/averaging.hpp"
#include "gis/coverage.hpp"
#include "gis/error_location.hpp"
#include "gis/geopackage.hpp"
#include "gis/map_raster.hpp"
#include "gis/point_window.hpp"
#include "gis/sampling.hpp"
#include "gis/valued_areas.hpp"

namespace thawslide::gis {

namespace {

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
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      const double value = field.at(column, row);
      const bool is_allowed = (value > what.low && value <= what.high) || (std::isnan(value) && !missing);
      if (fraction.at(column, row) > 0.0 && !is_allowed) {
        throw UserError("{}: at {}, {}, within the release, the {} is {}; allowed: above {:g}{} and up to {:g}{}.",
                        source, coordinate_text(field.x_of(column)), coordinate_text(field.y_of(row)), what.key,
                        std::isnan(value) ? "missing" : fmt::format("{:g}{}", value, what.unit), what.low, what.unit,
                        what.high, what.unit);
      }
    }
  }
}

// Single values of a finer raster are checked too, because a mean may hide an invalid one.
Raster from_raster(const ReleaseArea& area, const Raster& map, const MappedField& what, const std::string& source) {
  if (!is_finer(map, area.fraction)) {
    return sampled(map, area.fraction, Missing::nothing);
  }
  const Polygons polygons = area.is_raster() ? areas_of_mask(area.fraction) : area.polygons;
  const CoveredRaster part = covered_part(map, polygons, area.fraction.crs);
  check_values(part.values, part.fraction, what, source, false);
  return averaged(part, area.fraction).mean;
}

}  // namespace

std::map<std::string, Raster> fields_of(const config::Case& parameters, const std::string& body,
                                        const ReleaseArea& area, const Raster& thickness,
                                        std::vector<std::string>& warnings) {
  std::map<std::string, Raster> fields;
  for (const MappedField& what : mapped_fields) {
    const InitialField& field = parameters.bodies.at(body).*what.member;
    if (!field.is_map()) {
      continue;
    }
    const std::string key = key_of(body, what.key);
    const bool is_raster = field.over == InitialField::Over::raster;
    const Raster map =
        is_raster
            ? read_map(parameters, {key, field.source, what.quantity, area.fraction.crs, span_of_points(area.fraction)},
                       warnings)
            : Raster{};
    fields[what.key] = with_error_location(parameters, key, [&] {
      Raster made = is_raster ? from_raster(area, map, what, field.source) : from_attribute(area, field.source, key);
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

}  // namespace thawslide::gis
