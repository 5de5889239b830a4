// Where the substrates of a case lie, from polygons and from rasters of codes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/dem.hpp"

namespace thawslide::gis {

// By name, those that maps give. Throws UserError for one that lies outside the domain, and where two cover the same
// place: by more than a thousandth of the smaller one's area, as outlines along one another share slivers. The notes
// tell codes that belong to no substrate, and what a raster leaves out of the domain.
[[nodiscard]] std::map<std::string, config::SubstrateArea> load_substrates(const config::Case& parameters,
                                                                           const Dem& ground,
                                                                           std::vector<std::string>& warnings);

}  // namespace thawslide::gis
