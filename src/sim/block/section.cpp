#include "sim/block/section.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "terrain/height_field.hpp"

namespace thawslide::sim {

namespace {

bool reaches(const Raster& raster, const Point2& point) {
  return point[0] >= raster.x && point[0] <= raster.x_end() && point[1] >= raster.y && point[1] <= raster.y_end();
}

[[noreturn]] void fail_off_ground(const std::string& source, const Raster& ground, double along, const Point2& point) {
  const std::string where = fmt::format("{} m from its beginning, at x = {}, y = {}", rounded_text(along, 3),
                                        coordinate_text(point[0]), coordinate_text(point[1]));
  if (!reaches(ground, point)) {
    throw UserError(
        fmt::format("{}: the line is outside the DEM {}; its points reach from x = {} to {} and from y = {} to {}. "
                    "Draw the line within them, or take a larger DEM.",
                    source, where, coordinate_text(ground.x), coordinate_text(ground.x_end()),
                    coordinate_text(ground.y), coordinate_text(ground.y_end())));
  }
  throw UserError(
      fmt::format("{}: the line crosses a place without data {}; needed: an elevation all along it. Fill the DEM there "
                  "(gdal_fillnodata.py), or draw the line around it.",
                  source, where));
}

}  // namespace

std::vector<double> stations_along(const PathLine& line, double from, double to, double spacing) {
  THAWSLIDE_ASSERT(from < to && spacing > 0.0, "from {} to {} m, {} m apart", from, to, spacing);
  constexpr double least_fraction = 1e-4;  // fraction of the spacing: closer corners count as one
  std::vector<double> fixed{from};
  for (const double corner : line.distances()) {
    if (corner > fixed.back() + least_fraction * spacing && corner < to - least_fraction * spacing) {
      fixed.push_back(corner);
    }
  }
  fixed.push_back(to);
  std::vector<double> stations{from};
  for (std::size_t k = 0; k + 1 < fixed.size(); ++k) {
    const double length = fixed[k + 1] - fixed[k];
    const auto parts = static_cast<long>(std::ceil(length / spacing * (1.0 - 1e-12)));
    for (long part = 1; part < parts; ++part) {
      stations.push_back(fixed[k] + static_cast<double>(part) / static_cast<double>(parts) * length);
    }
    stations.push_back(fixed[k + 1]);
  }
  return stations;
}

std::vector<double> ground_along(const PathLine& line, const std::vector<double>& stations, const Raster& ground) {
  const terrain::HeightField field(ground);
  std::vector<double> elevations;
  for (const double along : stations) {
    const Point2 point = line.point_at(along);
    const Vector<double, 2> below(point[0], point[1]);
    elevations.push_back(field.is_known(below) ? field.height(below) : std::nan(""));
  }
  return elevations;
}

void require_known(const PathLine& line, const std::vector<double>& stations, const std::vector<double>& elevations,
                   double to, const Raster& ground, const std::string& source) {
  for (std::size_t k = 0; k < stations.size() && stations[k] <= to; ++k) {
    if (std::isnan(elevations[k])) {
      fail_off_ground(source, ground, stations[k], line.point_at(stations[k]));
    }
  }
}

std::vector<double> thickness_along(const PathLine& line, const std::vector<double>& stations,
                                    const Raster& thickness) {
  const terrain::HeightField field(thickness);
  std::vector<double> values;
  for (const double along : stations) {
    const Point2 point = line.point_at(along);
    values.push_back(reaches(thickness, point) ? field.height(Vector<double, 2>(point[0], point[1])) : 0.0);
  }
  return values;
}

}  // namespace thawslide::sim
