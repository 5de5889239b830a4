// Values of rasters between their points, and at those of another one.
#pragma once

#include "base/raster.hpp"

namespace thawslide::gis {

// What a point without data stands for.
enum class Missing { nothing, zero };

// Bilinear interpolation between the four points about x, y. Points without data count as 0 (zero), or not at all
// (nothing: the weights of the others are enlarged). NaN beyond the outermost points and where no point has data; 0
// there with Missing::zero.
[[nodiscard]] double bilinear(const Raster& raster, double x, double y, Missing missing);

// dz/dx and dz/dy at a point by central differences; one-sided where a neighbour has no data; 0 where both have none.
struct Gradient {
  double x = 0.0, y = 0.0;
};
[[nodiscard]] Gradient gradient_at(const Raster& raster, int column, int row);

// A raster of any reference system at the points of a layout.
[[nodiscard]] Raster sampled(const Raster& raster, const Raster& layout, Missing missing);

// Points without data get the value of the nearest one that has data, counted in steps along rows and columns.
void fill_from_nearest(Raster& raster);

}  // namespace thawslide::gis
