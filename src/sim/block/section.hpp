// Vertical section through the ground and a release along a line, from which a 2D case is made, and the line of
// steepest descent from a point of a DEM:
//    dx/ds = -grad z/|grad z|
// The gradient is averaged over a square around the point, so that narrow furrows do not divert the line. The step is a
// tenth of the square's side (Euler's method).
#pragma once

#include <optional>
#include <string>
#include <vector>

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

// Distances along the line [m]: `from`, `to`, the distinct corners between them, and intermediate stations so that none
// are farther apart than `spacing`.
[[nodiscard]] std::vector<double> stations_along(const PathLine& line, double from, double to, double spacing);

// Elevations [m] of the triangulated ground at the stations; NaN beyond its points, and at no-data points.
[[nodiscard]] std::vector<double> ground_along(const PathLine& line, const std::vector<double>& stations,
                                               const Raster& ground);

// Throws UserError, prefixed with `source`, for the first station up to `to` [m] whose elevation is NaN.
void require_known(const PathLine& line, const std::vector<double>& stations, const std::vector<double>& elevations,
                   double to, const Raster& ground, const std::string& source);

// Thickness [m] at the stations, triangulated like the ground, so ground plus thickness equals the triangulated sum; 0
// beyond its points.
[[nodiscard]] std::vector<double> thickness_along(const PathLine& line, const std::vector<double>& stations,
                                                  const Raster& thickness);

// Valley factor: ratio of the basal area of a slide in a valley to that on a plane. The slide fills the ground's
// cross-section to a level surface. Its pressure increases with the depth h and acts on all of the ground, but only the
// resultant carries the weight:
//    k = int h dA / |int h n dA|
// In a V-shaped channel k = 1/sin(alpha), with alpha half its opening angle, for any fill; on a plane, also an oblique
// one, k = 1. Friction and cohesion of the base are multiplied by k.

// Cross-section of a slide normal to its path.
struct CrossSection {
  double width;    // horizontal, half of it to either side of the path [m]
  double area;     // vertical [m2]
  double spacing;  // of the sampled ground heights [m]
};

// k at the stations of a line [m]; 1 where the ground is convex or unknown.
[[nodiscard]] std::vector<double> valley_factors(const PathLine& line, const std::vector<double>& stations,
                                                 const Raster& ground, const CrossSection& section);

}  // namespace thawslide::sim
