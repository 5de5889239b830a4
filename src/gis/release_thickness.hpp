// Vertical thickness of a release at the points of the ground.
#pragma once

#include <string>
#include <vector>

#include "gis/release_area.hpp"

namespace thawslide::gis {

// [m], at the points of the area's `share`, with its taper. Throws UserError if it is missing or negative. Appends
// warnings.
[[nodiscard]] Raster vertical_thickness_of(const config::Case& parameters, const std::string& body,
                                           const ReleaseArea& area, const Dem& ground,
                                           std::vector<std::string>& warnings);

}  // namespace thawslide::gis
