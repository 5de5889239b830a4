#include "sim/checks/valley_factor.hpp"

#include <algorithm>
#include <cmath>

#include "terrain/height_field.hpp"

namespace thawslide::sim {

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
