// Parts of the domain with unknown terrain.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::gis {

// Warning about no-data points within the domain: their number, the one nearest to a release, and the effect on a slide
// that reaches them; empty if there are none.
[[nodiscard]] std::string holes_warning(const config::Case& parameters, const config::Site& site);

// Warning for each probe whose point, or all of whose corners, have no terrain data.
[[nodiscard]] std::vector<std::string> probes_in_holes(const config::Site& site);

}  // namespace thawslide::gis
