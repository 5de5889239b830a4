// Line of steepest descent on a DEM from a point.
//    dx/ds = -grad z/|grad z|
// The gradient is averaged over a square around the point, so that narrow furrows do not divert the line. The step is a
// tenth of the square's side (Euler's method).
#pragma once

#include <optional>

#include "base/raster.hpp"
#include "sim/maps/path_line.hpp"

namespace thawslide::sim {

struct Descent {
  PathLine line;              // corners a width apart, and the end; empty if nothing is lower than the start
  std::optional<Point2> pit;  // closed depression in which the line ends: the ground rises in all directions
};

// width: of the square [m]. The line ends where the square reaches beyond the known ground, or in a closed depression,
// where it descends no further within four widths.
[[nodiscard]] Descent steepest_descent(const Raster& ground, const Point2& start, double width);

}  // namespace thawslide::sim
