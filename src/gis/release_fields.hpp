// Initial fields of a release that a map gives: temperature, porosity.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gis/release_area.hpp"

namespace thawslide::gis {

// By key of the body; at the points of `thickness`, which lie among those of the area's share. Every point has a value:
// those beyond the release that of the nearest one within. Throws UserError where a value is missing within the release
// or is out of range. Adds to the notes.
[[nodiscard]] std::map<std::string, Raster> fields_of(const config::Case& parameters, const std::string& body,
                                                      const ReleaseArea& area, const Raster& thickness,
                                                      std::vector<std::string>& warnings);

}  // namespace thawslide::gis
