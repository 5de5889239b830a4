// Polyline in the horizontal plane, and projection of places onto it. For host and device.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/portability.hpp"

namespace thawslide {

using Point2 = std::array<double, 2>;  // x, y [m]

// Position relative to a line.
struct LinePosition {
  double along = 0.0;   // arc length from the line's first corner [m]; negative before it
  double offset = 0.0;  // distance from the line [m], positive to the left of its direction
};

// Bounding box of consecutive segments, to reject all of them with one test.
struct BoxOfLine {
  Point2 lower, upper;

  [[nodiscard]] THAWSLIDE_HD double distance2(const Point2& point) const {  // squared [m2]
    double sum = 0.0;
    for (std::size_t a = 0; a < 2; ++a) {
      const double below = lower[a] - point[a], above = point[a] - upper[a];
      const double away = below > 0.0 ? below : above > 0.0 ? above : 0.0;
      sum += away * away;
    }
    return sum;
  }
};

// View of a line; valid while the line exists and does not change.
struct LineView {
  static constexpr std::size_t segments_of_box = 8;

  const Point2* corners = nullptr;     // one more than segments
  const double* along = nullptr;       // arc length at each corner [m]
  const Point2* directions = nullptr;  // unit vectors from each corner but the last to the next
  const BoxOfLine* boxes = nullptr;    // one per segments_of_box segments
  std::size_t segments = 0;            // 0: the line has no direction, and projection is undefined

  [[nodiscard]] THAWSLIDE_HD std::size_t boxes_count() const {
    return (segments + segments_of_box - 1) / segments_of_box;
  }

  // Projects onto the nearest point, the first of equally near ones. The line continues straight beyond both ends.
  [[nodiscard]] THAWSLIDE_HD LinePosition project(const Point2& point) const {
    Nearest nearest;
    project_onto(0, point, nearest);  // these two extend beyond the boxes
    project_onto(segments - 1, point, nearest);
    const std::size_t count = boxes_count();
    std::size_t closest = 0;
    double least2 = std::numeric_limits<double>::infinity();
    for (std::size_t box = 0; box < count; ++box) {
      const double distance2 = boxes[box].distance2(point);
      if (distance2 < least2) {
        least2 = distance2;
        closest = box;
      }
    }
    project_onto_box(closest, point, nearest);
    for (std::size_t box = 0; box < count; ++box) {
      if (box != closest && boxes[box].distance2(point) <= nearest.distance2) {
        project_onto_box(box, point, nearest);
      }
    }
    return nearest.position;
  }

 private:
  struct Nearest {
    LinePosition position;
    double distance2 = std::numeric_limits<double>::infinity();  // squared [m2]
  };

  THAWSLIDE_HD void project_onto_box(std::size_t box, const Point2& point, Nearest& nearest) const {
    const std::size_t first = box * segments_of_box;
    for (std::size_t k = first; k < first + segments_of_box && k < segments; ++k) {
      project_onto(k, point, nearest);
    }
  }

  THAWSLIDE_HD void project_onto(std::size_t k, const Point2& point, Nearest& nearest) const {
    using std::sqrt, std::copysign;
    const double x = point[0] - corners[k][0], y = point[1] - corners[k][1];
    double along_segment = x * directions[k][0] + y * directions[k][1];
    if (k > 0 && along_segment < 0.0) {
      along_segment = 0.0;
    }
    if (k + 1 < segments && along_segment > along[k + 1] - along[k]) {
      along_segment = along[k + 1] - along[k];
    }
    const double away_x = x - along_segment * directions[k][0], away_y = y - along_segment * directions[k][1];
    const double distance2 = away_x * away_x + away_y * away_y;
    along_segment += along[k];
    if (distance2 < nearest.distance2 || (distance2 == nearest.distance2 && along_segment < nearest.position.along)) {
      nearest.distance2 = distance2;
      nearest.position = {along_segment, copysign(sqrt(distance2), directions[k][0] * y - directions[k][1] * x)};
    }
  }
};

}  // namespace thawslide
