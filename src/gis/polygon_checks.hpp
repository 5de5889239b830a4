// Validity checks of polygons in a file.
#pragma once

#include "gis/vector_file.hpp"

namespace thawslide::gis {

// Throws UserError for a polygon without an area, and for one that intersects itself, with the location.
void check_polygons(const VectorLayer& layer);

}  // namespace thawslide::gis
