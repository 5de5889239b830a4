// Resampling of rasters at the points of another one, means over their cells, gradients, smoothing and tapering. All
// rasters are in one reference system.
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

#include "base/raster.hpp"
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

inline constexpr double smoothing_reach = 4.0;  // standard deviations

// Replaces the height at each point with data by that of the best-fit plane through the surrounding known points (local
// linear regression; Fan and Gijbels 1996). The weights are exp(-d^2 / (2 s^2)), with the distance d along both axes
// and the standard deviation s [m], up to d = 4 s. If all surrounding points are known, this is the Gaussian mean. At
// the edge of the known area a mean would tilt a slope, but the plane does not. No-data points remain.
//
// Planes are reproduced exactly. The mean height is conserved if the ground is plane within the filter's reach of the
// edge.
[[nodiscard]] Raster smoothed(const Raster& raster, double standard_deviation);

// Number of points on each side within the reach of a width [m].
[[nodiscard]] int taper_reach(double width, double cell);

// Mean of a thickness around each point, with weights 1 + cos(2 pi d / w) for d < w / 2 along each axis: a straight
// edge becomes a ramp of width w with smooth ends. The weights sum to 1, so the volume is conserved if the raster has
// zeros within half the width of every side.
[[nodiscard]] Raster tapered(const Raster& thickness, double width);

}  // namespace thawslide::gis
