// How much larger the base of a slide is in a valley than on a plane. The slide fills the ground's cross-section to a
// level surface; its pressure grows with the depth h and stands on all of the ground, and only the resultant bears the
// weight:
//   k = int h dA / |int h n dA|
// In a V channel k = 1/sin(alpha), with alpha half its opening angle, whatever the fill; on a plane, also an oblique
// one, k = 1. Friction and cohesion of the base count k times.
#pragma once

#include <vector>

#include "base/raster.hpp"
#include "sim/path_line.hpp"

namespace thawslide::sim {

// A slide across its path.
struct CrossSection {
  double width;    // horizontal, half of it to either side of the path [m]
  double area;     // vertical [m2]
  double spacing;  // of the ground's heights that count [m]
};

// k at the stations of a line [m]; 1 where the ground is not hollow or not known.
[[nodiscard]] std::vector<double> valley_factors(const PathLine& line, const std::vector<double>& stations,
                                                 const Raster& ground, const CrossSection& section);

}  // namespace thawslide::sim
