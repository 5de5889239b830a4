#include "sim/block/steepest_descent.hpp"

#include <cmath>
#include <vector>

#include "terrain/height_field.hpp"

namespace thawslide::sim {

namespace {

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

}  // namespace thawslide::sim
