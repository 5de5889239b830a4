// Points of a DEM that stand for no data although the file does not say so.
#pragma once

#include <string>

#include "base/raster.hpp"

namespace thawslide::gis {

// What the user should know of patches of one value, such as 0, amid ground of quite another height; empty if there are
// none. A patch counts where all ground beside it is more than 100 m higher or lower, and the way there steeper than 80
// degrees: no lake, and no sea, has such a shore all about it. A single point counts where it is 0.
[[nodiscard]] std::string pits_warning(const std::string& file, const Raster& ground);

}  // namespace thawslide::gis
