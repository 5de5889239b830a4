// Interpolation and volumes of rasters.
#pragma once

#include "base/raster.hpp"

namespace thawslide {

// Treatment of points without data. unknown: the result is NaN. nothing: they are omitted, and the other weights are
// scaled up. zero: they count as 0, like points outside the raster.
enum class Missing { unknown, nothing, zero };

// Bilinear interpolation between the four points around x, y; points with a weight at round-off level are ignored. NaN
// if no data are available, and outside the outermost points unless `missing` is zero.
[[nodiscard]] double bilinear(const Raster& raster, double x, double y, Missing missing);

// Volume of a thickness [m3]: sum of the values times the area of a cell. Points without data count as 0.
[[nodiscard]] double volume_of(const Raster& thickness);

}  // namespace thawslide
