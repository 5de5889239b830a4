// Initial fields of a release from maps: temperature, porosity.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gis/release_area.hpp"

namespace thawslide::gis {

// Fields by key of the body, at the points of `thickness`, which are among those of the area's `share`. Points outside
// the release have the value of the nearest one within. Throws UserError if a value within the release is missing or
// out of range. Appends warnings.
[[nodiscard]] std::map<std::string, Raster> fields_of(const config::Case& parameters, const std::string& body,
                                                      const ReleaseArea& area, const Raster& thickness,
                                                      std::vector<std::string>& warnings);

}  // namespace thawslide::gis
