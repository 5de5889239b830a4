// What rasters tell beyond their points: values between them, and volumes.
#pragma once

#include "base/raster.hpp"

namespace thawslide {

// What a point without data stands for: no value can be known; it is left out, and the weights of the others are
// enlarged; 0, as the points beyond the raster then are.
enum class Missing { unknown, nothing, zero };

// Bilinear interpolation between the four points about x, y, of which those that are as good as beside the place do not
// count. NaN where nothing is known, and beyond the outermost points unless what is missing is zero.
[[nodiscard]] double bilinear(const Raster& raster, double x, double y, Missing missing);

// Volume of a thickness [m3]: the sum of the values times the area of a cell. Points without data hold nothing.
[[nodiscard]] double volume_of(const Raster& thickness);

}  // namespace thawslide
