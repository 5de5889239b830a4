// Valley factor: ratio of the basal area of a slide in a valley to that on a plane. The slide fills the ground's
// cross-section to a level surface. Its pressure increases with the depth h and acts on all of the ground, but only the
// resultant carries the weight:
//    k = int h dA / |int h n dA|
// In a V-shaped channel k = 1/sin(alpha), with alpha half its opening angle, for any fill; on a plane, also an oblique
// one, k = 1. Friction and cohesion of the base are multiplied by k.
#pragma once

#include <vector>

#include "base/raster.hpp"
#include "sim/maps/path_line.hpp"

namespace thawslide::sim {

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
