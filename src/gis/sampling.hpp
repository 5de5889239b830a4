// Resampling of rasters at the points of another one, means over their cells, and gradients. All rasters are in one
// reference system.
//
// Along each axis, a new value is a weighted sum of old ones, so only the requested points are computed. A DEM is a
// surface: if the new spacing is at most the old one, its heights are interpolated linearly. Points with a larger
// spacing get the mean of the linear interpolation over an interval of the new spacing, centred on each. Both reproduce
// a plane exactly.
//
// Other maps are averaged over cells. A value v_k of a raster applies to its whole cell; A_k is the area that this cell
// shares with the cell of a new point:
//    mean = sum v_k A_k / sum A_k
// The sum of mean times area over the new cells therefore equals that of the raster (a volume, if the values are
// thicknesses).
#pragma once

#include "base/raster_sampling.hpp"
#include "gis/polygons.hpp"

namespace thawslide::gis {

// Points `distance` metres apart that fit in a whole raster: from its first point if they are interpolated, from half a
// distance beyond it if they are means. No columns or rows if none fit.
[[nodiscard]] Raster resampled_layout(const Raster& layout, double distance);

// Area in which old points must be known for the new ones.
[[nodiscard]] Rectangle needed_for(const Raster& new_layout);

// Heights at the points of the new layout. NaN if an old point that an interpolation needs has no data, or if half of
// those in a mean have none.
[[nodiscard]] Raster resampled(const Raster& raster, const Raster& new_layout);

// dz/dx and dz/dy at a point by central differences; one-sided if a neighbour has no data; 0 if both have none.
struct Gradient {
  double x = 0.0, y = 0.0;
};
[[nodiscard]] Gradient gradient_at(const Raster& raster, int column, int row);

// Values of a map at the points of a layout: bilinear between its points, or the mean over the cell around a point if
// its own points are closer together.
[[nodiscard]] Raster sampled(const Raster& raster, const Raster& layout, Missing missing);

// Heights of a surface above the ground at its own points; NaN without a ground.
[[nodiscard]] Raster above_ground(const Raster& surface, const Raster& ground);

// True if the points of a raster are closer together than those of a layout along any axis, by more than a hundredth.
// For a wider spacing, bilinear interpolation conserves the volume.
[[nodiscard]] bool is_finer(const Raster& raster, const Raster& layout);

// Means of a finer raster at the points of a layout. No-data points count as 0 if missing is zero. Otherwise the mean
// is that of the remaining area, and NaN if none remains, or if missing is unknown and less than half of the cell
// remains.
[[nodiscard]] Raster averaged(const Raster& raster, const Raster& layout, Missing missing);

// Part of a raster that polygons cover.
struct CoveredRaster {
  Raster values;    // around the polygons; without points if the raster does not reach them
  Raster fraction;  // covered fraction of each of its cells
};
[[nodiscard]] CoveredRaster covered_part(const Raster& raster, const Polygons& polygons);

// Means of a finer raster within polygons, at the points of a layout.
struct CoveredMeans {
  Raster amount;  // sum v_k A_k over the area of the point's cell, A_k: covered by polygons; 0 for no data
  Raster mean;    // over the covered area; NaN for no data
};
[[nodiscard]] CoveredMeans averaged(const CoveredRaster& part, const Raster& layout);

}  // namespace thawslide::gis
