// Resampling of rasters at the points of another one, means over their cells, gradients, smoothing and tapering. All
// rasters are in one reference system. Along each axis, a new value is a weighted sum of old ones. A DEM is a surface:
// its heights are interpolated linearly or, for a larger spacing, the means of that over intervals. Both reproduce a
// plane. Other maps are averaged over cells, which conserves volumes; A_k: area that the cell of v_k shares with the
// new cell:
//    mean = sum v_k A_k / sum A_k
#pragma once

#include "base/raster.hpp"
#include "gis/polygons.hpp"

namespace thawslide::gis {

// Points `distance` metres apart that fit in a raster: from its first point, or for means half a distance beyond it.
[[nodiscard]] Raster resampled_layout(const Raster& layout, double distance);

// Area in which old points must be known for the new ones.
[[nodiscard]] Rectangle needed_for(const Raster& new_layout);

// Heights at new points; NaN if an old point of an interpolation has no data, or half of those in a mean.
[[nodiscard]] Raster resampled(const Raster& raster, const Raster& new_layout);

// dz/dx and dz/dy at a point by central differences; one-sided if a neighbour has no data; 0 if both have none.
struct Gradient {
  double x = 0.0, y = 0.0;
};
[[nodiscard]] Gradient gradient_at(const Raster& raster, int column, int row);

// Values of a map at the points of a layout: bilinear, or the mean over a point's cell if the map is finer.
[[nodiscard]] Raster sampled(const Raster& raster, const Raster& layout, Missing missing);

// Heights of a surface above the ground at its own points; NaN without a ground.
[[nodiscard]] Raster above_ground(const Raster& surface, const Raster& ground);

// True if points of a raster are closer together than those of a layout; otherwise interpolation conserves the volume.
[[nodiscard]] bool is_finer(const Raster& raster, const Raster& layout);

// Means of a finer raster. No-data points are 0 if missing is zero; otherwise the mean is that of the remaining area,
// and NaN if none remains, or if missing is unknown and less than half remains.
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

// Height of the best-fit plane through the known points around each point with data (local linear regression; Fan and
// Gijbels 1996), with weights exp(-d^2 / (2 s^2)) along both axes up to d = 4 s, s: standard deviation [m]. Away from
// edges, this is the Gaussian mean, which would tilt a slope at the edge of the known area.
[[nodiscard]] Raster smoothed(const Raster& raster, double standard_deviation);

// Number of points on each side within the reach of a width [m].
[[nodiscard]] int taper_reach(double width, double cell);

// Mean of a thickness with weights 1 + cos(2 pi d / w) for d < w / 2 along each axis: a straight edge becomes a ramp of
// width w. The volume is conserved if the raster has zeros within half the width of every side.
[[nodiscard]] Raster tapered(const Raster& thickness, double width);

}  // namespace thawslide::gis
