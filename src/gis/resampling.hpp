// New points for a raster. What is asked for is done at the points of a layout alone, from a part of the
// file that is large enough, so that cropping does not change a value.
//
// Along each axis a value of the new points is a weighted sum of the old ones. Points as near to one another as the old
// ones or nearer are interpolated linearly. Points farther apart get the mean of the linear interpolation over the
// distance of the new points, centred on each. Both leave a plane as it is.
#pragma once

#include "base/raster.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

// The points `distance` metres apart that a whole raster has room for: from its first one on where they are
// interpolated, from half a distance beyond it where they are means. No columns or rows where it has no room.
[[nodiscard]] Raster resampled_layout(const Raster& layout, double distance);

// Where old points must be known for the new ones.
[[nodiscard]] Rectangle needed_for(const Raster& new_layout);

// Values at the points of the new layout. NaN where an old point that an interpolation needs has no data, or where half
// of those that a mean is made of have none.
[[nodiscard]] Raster resampled(const Raster& raster, const Raster& new_layout);

}  // namespace thawslide::gis
