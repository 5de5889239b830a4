#include "gis/map_distortion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "gis/reprojection.hpp"
#include "gis/spatial_reference.hpp"

namespace thawslide::gis {

namespace {

// With central differences of longitude and latitude, which are in units of `radians`. Empty outside the projection.
std::optional<PointScales> scales_at(double x, double y, const OGRSpatialReference& reference,
                                     const Reprojection& to_degrees, double radians) {
  constexpr double step = 10.0;  // m
  std::vector<double> longitude{x + step, x - step, x, x, x}, latitude{y, y, y + step, y - step, y};
  if (!to_degrees.apply(longitude, latitude)) {
    return std::nullopt;
  }
  const double a = reference.GetSemiMajor(nullptr), b = reference.GetSemiMinor(nullptr);
  const double e2 = 1.0 - (b / a) * (b / a), sine = std::sin(radians * latitude[4]);
  const double w2 = 1.0 - e2 * sine * sine;
  const double meridian = a * (1.0 - e2) / (w2 * std::sqrt(w2)) * radians / (2.0 * step);
  const double parallel = a / std::sqrt(w2) * std::cos(radians * latitude[4]) * radians / (2.0 * step);
  // Metres on the ellipsoid, to the east and to the north, per metre on the map.
  const double turn = 2.0 * std::numbers::pi / radians;
  const double east_x = parallel * std::remainder(longitude[0] - longitude[1], turn);
  const double east_y = parallel * std::remainder(longitude[2] - longitude[3], turn);
  const double north_x = meridian * (latitude[0] - latitude[1]), north_y = meridian * (latitude[2] - latitude[3]);
  // Sum and difference of the singular values of this matrix.
  const double sum = std::hypot(east_x + north_y, east_y - north_x);
  const double difference = std::hypot(east_x - north_y, east_y + north_x);
  const PointScales scales{2.0 / (sum + difference), 2.0 / std::abs(sum - difference), x, y};
  return std::isfinite(scales.error()) ? std::optional(scales) : std::nullopt;
}

}  // namespace

double PointScales::error() const {
  return std::max({std::abs(largest - 1.0), std::abs(smallest - 1.0), largest / smallest - 1.0});
}

PointScales worst_scales(const std::string& wkt, const Rectangle& extent) {
  const OGRSpatialReference reference = reference_from_wkt(wkt);
  OGRSpatialReference degrees;
  degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  degrees.CopyGeogCSFrom(&reference);
  const Reprojection to_degrees(wkt, wkt_from_reference(&degrees));
  PointScales worst;
  for (const double x : {extent.min_x, extent.max_x}) {
    for (const double y : {extent.min_y, extent.max_y}) {
      const std::optional<PointScales> scales =
          scales_at(x, y, reference, to_degrees, degrees.GetAngularUnits(nullptr));
      worst = scales && scales->error() > worst.error() ? *scales : worst;
    }
  }
  return worst;
}

}  // namespace thawslide::gis
