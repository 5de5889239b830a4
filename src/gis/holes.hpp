// Places of the domain whose terrain is not known.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"

namespace thawslide::gis {

// What the user should know of points without data within the domain: how many, the one nearest to a release, and what
// becomes of a slide that gets there; empty if there are none.
[[nodiscard]] std::string holes_warning(const config::Case& parameters, const config::Site& site);

// A note for each probe whose point, or all of whose corners, have no terrain data.
[[nodiscard]] std::vector<std::string> probes_in_holes(const config::Site& site);

}  // namespace thawslide::gis
