#include "sim/steepest_descent.hpp"

#include <cmath>
#include <vector>

#include "terrain/height_field.hpp"

namespace thawslide::sim {

namespace {

constexpr double step_share = 0.1;         // fraction of the width
constexpr std::size_t patient_steps = 40;  // without descending: four widths
constexpr double least_fall = 1e-6;        // fraction of a step: minimum descent, and minimum slope

// Points a width or more apart, and the last one.
PathLine thinned(const std::vector<Place2>& places, double width) {
  PathLine line;
  line.add(places.front());
  for (const Place2& place : places) {
    const Place2& last = line.corners().back();
    if (std::hypot(place[0] - last[0], place[1] - last[1]) >= width) {
      line.add(place);
    }
  }
  line.add(places.back());
  return line;
}

}  // namespace

Descent steepest_descent(const Raster& ground, const Place2& start, double width) {
  const terrain::HeightField field(ground);
  const double step = step_share * width;
  const Vector<double, 2> half = Vector<double, 2>::Constant(0.5 * width);
  Vector<double, 2> place(start[0], start[1]);
  std::vector<Place2> places{start};
  std::size_t lowest = 0;
  double lowest_height = field.height(place);
  Descent descent;
  while (field.is_known(place - half, place + half)) {
    const Vector<double, 2> gradient = field.gradient(place, width);
    if (gradient.norm() <= least_fall || places.size() > lowest + patient_steps) {
      places.resize(lowest + 1);
      descent.pit = places.back();
      break;
    }
    place -= step * gradient.normalized();
    places.push_back({place[0], place[1]});
    const double height = field.height(place);
    if (height < lowest_height - least_fall * step) {
      lowest_height = height;
      lowest = places.size() - 1;
    }
  }
  descent.line = thinned(places, width);
  return descent;
}

}  // namespace thawslide::sim
