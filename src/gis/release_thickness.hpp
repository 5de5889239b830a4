// Vertical thickness of a release at the points of the ground.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "gis/release_area.hpp"

namespace thawslide::gis {

// [m], at the points of the area's `share`, with its taper. Throws UserError if it is missing or negative. Appends
// warnings.
[[nodiscard]] Raster vertical_thickness_of(const config::Case& parameters, const std::string& body,
                                           const ReleaseArea& area, const Dem& ground,
                                           std::vector<std::string>& warnings);

// Vertical thickness [m] of a layer `along_normal` [m] thick on a plane with the gradient dz/dx, dz/dy.
inline double vertical_thickness(double along_normal, double dz_dx, double dz_dy) {
  return along_normal * std::sqrt(1.0 + dz_dx * dz_dx + dz_dy * dz_dy);
}

}  // namespace thawslide::gis
