// Whether polygons of a file bound an area.
#pragma once

#include "gis/vector_file.hpp"

namespace thawslide::gis {

// Throws UserError for a polygon without an area, and for one that crosses itself, with the place.
void check_polygons(const VectorLayer& layer);

}  // namespace thawslide::gis
