// Extent of the substrates of a case, from polygons and from rasters of codes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/dem.hpp"

namespace thawslide::gis {

// Substrates given by maps, by name. Throws UserError for one outside the domain, and for two that overlap by more than
// a thousandth of the smaller area, because adjacent outlines share slivers. Warnings report codes that belong to no
// substrate, and parts of the domain not covered by a raster.
[[nodiscard]] std::map<std::string, config::SubstrateArea> load_substrates(const config::Case& parameters,
                                                                           const Dem& ground,
                                                                           std::vector<std::string>& warnings);

}  // namespace thawslide::gis
