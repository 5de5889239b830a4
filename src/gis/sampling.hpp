// Sampling of rasters at the points of another one, and gradients.
#pragma once

#include "base/raster_sampling.hpp"

namespace thawslide::gis {

// dz/dx and dz/dy at a point by central differences; one-sided if a neighbour has no data; 0 if both have none.
struct Gradient {
  double x = 0.0, y = 0.0;
};
[[nodiscard]] Gradient gradient_at(const Raster& raster, int column, int row);

// Samples a raster of any reference system at the points of a layout. Values are bilinear between its points, or the
// mean over the cell around a point if its own points are closer together (averaging.hpp).
[[nodiscard]] Raster sampled(const Raster& raster, const Raster& layout, Missing missing);

// Heights of a surface above the ground at its own points; NaN without a ground.
[[nodiscard]] Raster above_ground(const Raster& surface, const Raster& ground);

}  // namespace thawslide::gis
