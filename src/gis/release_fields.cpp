#include "gis/release_fields.hpp"

#include <cmath>
#include <limits>

#include "base/nearest_known.hpp"
#include "gis/coverage.hpp"
#include "gis/map_raster.hpp"
#include "gis/point_window.hpp"
#include "gis/sampling.hpp"
#include "gis/told_at.hpp"
#include "gis/valued_areas.hpp"

namespace thawslide::gis {

namespace {

// The range is that of the key's number: above `low`, up to `high`.
struct MappedField {
  const char* key;
  InitialField config::Body::*member;
  double low, high;
  const char* unit;
};

constexpr MappedField mapped_fields[] = {
    {"temperature", &config::Body::temperature, -273.15, 100.0, " C"},
    {"porosity", &config::Body::porosity, 0.0, 0.95, ""},
    {"saturation", &config::Body::saturation, 0.0, 1.0, ""},
    {"ice_content", &config::Body::ice_content, 0.0, 0.95, ""},
};

// Means of the polygons' values over each point's cell; NaN where none of them lies.
Raster from_attribute(const ReleaseArea& area, const std::string& attribute, const std::string& key) {
  if (area.is_raster()) {
    throw UserError("a raster gives the release: it has no attributes. Name a raster of the quantity, or a number.");
  }
  Raster sum = area.share.filled(0.0), weight = sum;
  for (const ValuedArea& part : areas_by_value(area.layer, attribute, key)) {
    const Raster share = coverage_of(part.polygons, area.share);
    for (std::size_t k = 0; k < share.values.size(); ++k) {
      sum.values[k] += part.value * share.values[k];
      weight.values[k] += share.values[k];
    }
  }
  for (std::size_t k = 0; k < sum.values.size(); ++k) {
    sum.values[k] =
        weight.values[k] > 0.0 ? sum.values[k] / weight.values[k] : std::numeric_limits<double>::quiet_NaN();
  }
  return sum;
}

void check_values(const Raster& field, const Raster& share, const MappedField& what, const std::string& source) {
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      const double value = field.at(column, row);
      if (share.at(column, row) > 0.0 && !(value > what.low && value <= what.high)) {
        throw UserError(
            fmt::format("{}: at {:.10g}, {:.10g}, within the release, the {} is {}; allowed: above {:g}{} and "
                        "up to {:g}{}.",
                        source, field.x_of(column), field.y_of(row), what.key,
                        std::isnan(value) ? "missing" : fmt::format("{:g}{}", value, what.unit), what.low, what.unit,
                        what.high, what.unit));
      }
    }
  }
}

}  // namespace

std::map<std::string, Raster> fields_of(const config::Case& parameters, const std::string& body,
                                        const ReleaseArea& area, const Raster& thickness,
                                        std::vector<std::string>& notes) {
  std::map<std::string, Raster> fields;
  for (const MappedField& what : mapped_fields) {
    const InitialField& field = parameters.bodies.at(body).*what.member;
    if (!field.is_map()) {
      continue;
    }
    const std::string key = key_of(body, what.key);
    const bool is_raster = field.over == InitialField::Over::raster;
    const Raster map =
        is_raster ? read_map(parameters, {key, field.source, area.share.crs, span_of_points(area.share)}, notes)
                  : Raster{};
    fields[what.key] = told_at(parameters, key, [&] {
      Raster made = is_raster ? sampled(map, area.share, Missing::nothing) : from_attribute(area, field.source, key);
      check_values(made, area.share, what, is_raster ? field.source : area.layer.file);
      for (std::size_t k = 0; k < made.values.size(); ++k) {
        if (!(area.share.values[k] > 0.0)) {
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
