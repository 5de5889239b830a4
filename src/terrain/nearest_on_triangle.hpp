// Point of a triangle nearest to a position.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/linear.hpp"

namespace thawslide::terrain {

// Nearest point of the segment from a to b [m].
inline Vector<double, 3> nearest_on_segment(const Vector<double, 3>& position, const Vector<double, 3>& a,
                                            const Vector<double, 3>& b) {
  const Vector<double, 3> along = b - a;
  return a + std::clamp((position - a).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
}

// If the foot of the perpendicular is outside the triangle, the nearest point lies on an edge that separates the foot
// from the triangle.
inline Vector<double, 3> nearest_on_triangle(const Vector<double, 3>& position,
                                             const std::array<Vector<double, 3>, 3>& triangle) {
  const Vector<double, 3>& a = triangle[0];
  const Vector<double, 3> across = (triangle[1] - a).cross(triangle[2] - a);
  const Vector<double, 3> foot = position - across * (across.dot(position - a) / across.squaredNorm());
  Vector<double, 3> best = foot;
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector<double, 3>& from = triangle[k];
    const Vector<double, 3>& to = triangle[(k + 1) % 3];
    if ((to - from).cross(foot - from).dot(across) >= 0.0) {
      continue;
    }
    const Vector<double, 3> candidate = nearest_on_segment(position, from, to);
    const double squared = (candidate - position).squaredNorm();
    if (squared < least) {
      least = squared;
      best = candidate;
    }
  }
  return best;
}

}  // namespace thawslide::terrain
