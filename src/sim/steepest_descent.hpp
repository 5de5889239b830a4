// The way straight down a DEM from a place.
//   dx/ds = -grad z/|grad z|
// with the gradient averaged over a square about the place, so that furrows of a point's width do not lead it; in steps
// of a tenth of the square's side (Euler's method).
#pragma once

#include <optional>

#include "base/raster.hpp"
#include "sim/path_line.hpp"

namespace thawslide::sim {

struct Descent {
  PathLine line;              // corners a width apart, its end among them; empty where nothing is lower than the start
  std::optional<Place2> pit;  // in which it ends: all ways that lead on rise
};

// width: of the square [m]. Ends where the square reaches beyond what is known of the ground, or in a pit: where four
// widths bring it no lower.
[[nodiscard]] Descent steepest_descent(const Raster& ground, const Place2& start, double width);

}  // namespace thawslide::sim
