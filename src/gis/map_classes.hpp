// Classes and colours of the maps of a run, equal for all runs, so that maps of different runs can be compared. Colours
// are those of the report (python/thawslide/figures/maximum_maps.py).
#pragma once

#include <string>

#include "gis/map_style.hpp"

namespace thawslide::gis {

// Style of a map by its name ("max_thickness"). Classes have round limits.
[[nodiscard]] RasterStyle style_of_map(const std::string& name);

// Style with classes of hazard, for the maximum thickness and pressure: limits 0.5, 1 and 2 m, and 3 and 30 kPa.
// Without classes for the other maps.
[[nodiscard]] RasterStyle hazard_style_of_map(const std::string& name);

}  // namespace thawslide::gis
