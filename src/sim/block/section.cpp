#include "sim/block/section.hpp"

#include <algorithm>
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

constexpr double step_fraction = 0.1;      // fraction of the width
constexpr std::size_t patient_steps = 40;  // without descending: four widths
constexpr double least_fall = 1e-6;        // fraction of a step: minimum descent, and minimum slope

// Points a width or more apart, and the last one.
PathLine thinned(const std::vector<Point2>& points, double width) {
  PathLine line;
  line.add(points.front());
  for (const Point2& point : points) {
    const Point2& last = line.corners().back();
    if (std::hypot(point[0] - last[0], point[1] - last[1]) >= width) {
      line.add(point);
    }
  }
  line.add(points.back());
  return line;
}

}  // namespace

Descent steepest_descent(const Raster& ground, const Point2& start, double width) {
  const terrain::HeightField field(ground);
  const double step = step_fraction * width;
  const Vector<double, 2> half = Vector<double, 2>::Constant(0.5 * width);
  Vector<double, 2> point(start[0], start[1]);
  std::vector<Point2> points{start};
  std::size_t lowest = 0;
  double lowest_height = field.height(point);
  Descent descent;
  while (field.is_known(point - half, point + half)) {
    const Vector<double, 2> gradient = field.gradient(point, width);
    if (gradient.norm() <= least_fall || points.size() > lowest + patient_steps) {
      points.resize(lowest + 1);
      descent.pit = points.back();
      break;
    }
    point -= step * gradient.normalized();
    points.push_back({point[0], point[1]});
    const double height = field.height(point);
    if (height < lowest_height - least_fall * step) {
      lowest_height = height;
      lowest = points.size() - 1;
    }
  }
  descent.line = thinned(points, width);
  return descent;
}

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

namespace {

using Point = Vector<double, 2>;

// Part of the ground across the path.
struct Strip {
  double height;         // at its centre [m]
  double along, across;  // slopes
};

// Level of a fill of this area over strips of this width [m].
double level_of(std::vector<double> heights, double width, double area) {
  std::sort(heights.begin(), heights.end());
  double filled = 0.0;  // area filled up to the height of strip k
  std::size_t k = 1;
  for (; k < heights.size(); ++k) {
    const double more = static_cast<double>(k) * width * (heights[k] - heights[k - 1]);
    if (filled + more >= area) {
      break;
    }
    filled += more;
  }
  return heights[k - 1] + (area - filled) / (static_cast<double>(k) * width);
}

double factor_of(const std::vector<Strip>& strips, double width, double area) {
  std::vector<double> heights;
  for (const Strip& strip : strips) {
    heights.push_back(strip.height);
  }
  const double level = level_of(heights, width, area);
  const auto depth = [level](const Strip& strip) { return std::max(0.0, level - strip.height); };
  const double mean = area / (width * static_cast<double>(strips.size()));
  if (0.5 * (depth(strips.front()) + depth(strips.back())) >= mean) {
    return 1.0;  // a ridge: the slide leaves it on both sides
  }
  double base = 0.0, along = 0.0, across = 0.0, up = 0.0;
  for (const Strip& strip : strips) {
    base += depth(strip) * std::sqrt(1.0 + strip.along * strip.along + strip.across * strip.across);
    along += depth(strip) * strip.along;
    across += depth(strip) * strip.across;
    up += depth(strip);
  }
  return base / std::sqrt(along * along + across * across + up * up);
}

}  // namespace

std::vector<double> valley_factors(const PathLine& line, const std::vector<double>& stations, const Raster& ground,
                                   const CrossSection& section) {
  const terrain::HeightField field(ground);
  const auto half = static_cast<long>(std::max(1.0, std::round(0.5 * section.width / section.spacing)));
  const double width = 0.5 * section.width / static_cast<double>(half);
  std::vector<double> factors;
  for (const double station : stations) {
    const Point2 middle = line.point_at(station), behind = line.point_at(station - 0.5 * section.spacing),
                 ahead = line.point_at(station + 0.5 * section.spacing);
    const Point onward = Point(ahead[0] - behind[0], ahead[1] - behind[1]).normalized(), left(-onward[1], onward[0]);
    std::vector<Strip> strips;
    for (long k = -half; k < half; ++k) {
      const Point right_edge = Point(middle[0], middle[1]) + static_cast<double>(k) * width * left;
      const Point left_edge = right_edge + width * left, centre = 0.5 * (right_edge + left_edge);
      const Point back = centre - 0.5 * width * onward, front = centre + 0.5 * width * onward;
      if (field.is_known(right_edge) && field.is_known(left_edge) && field.is_known(back) && field.is_known(front)) {
        const double to_right = field.height(right_edge), to_left = field.height(left_edge);
        strips.push_back({0.5 * (to_right + to_left), (field.height(front) - field.height(back)) / width,
                          (to_left - to_right) / width});
      }
    }
    factors.push_back(strips.empty() ? 1.0 : factor_of(strips, width, section.area));
  }
  return factors;
}

}  // namespace thawslide::sim
