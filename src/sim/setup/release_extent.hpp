// Extent of a release at t = 0, from which travel distance and drop height are measured.
#pragma once

#include "config/site.hpp"

namespace thawslide::sim {

// Corners that bound a release in the map: those of its outlines, or of the cells of its raster.
[[nodiscard]] config::Polyline2 corners_of(const config::Release& release);

// Elevation of the highest point of a release on the ground [m].
[[nodiscard]] double top_of(const config::Release& release, const Raster& ground);

}  // namespace thawslide::sim
