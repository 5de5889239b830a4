// Means of a raster over the cells of other points that are farther apart.
//
// A value v_k of a raster is that of its whole cell, A_k the area which this cell shares with that of a new point:
//   mean = sum v_k A_k / sum A_k
// so that sum over the new cells of mean times area is the raster's own (a volume, if the values are thicknesses). In
// one reference system the areas are exact. From another one the cell of a new point is divided into parts smaller than
// the raster's cells, each of which has the value of the cell that its middle lies in.
#pragma once

#include "base/raster_sampling.hpp"
#include "gis/polygons.hpp"

namespace thawslide::gis {

// Whether the points of a raster are nearer to one another than those of a layout, along any axis, by more than a
// hundredth: between points farther apart, bilinear interpolation keeps the volume.
[[nodiscard]] bool is_finer(const Raster& raster, const Raster& layout);

// The means of a finer raster at the points of a layout. Where it has no data: 0 if missing is zero. Else the mean is
// that of the rest, and NaN without a rest, or if missing is unknown, where the rest is less than half of the cell.
[[nodiscard]] Raster averaged(const Raster& raster, const Raster& layout, Missing missing);

// The part of a raster that polygons cover.
struct CoveredRaster {
  Raster values;  // about the polygons; without points where it does not reach them
  Raster share;   // of each of its cells within them
};
// `crs`: of the polygons, as WKT.
[[nodiscard]] CoveredRaster covered_part(const Raster& raster, const Polygons& polygons, const std::string& crs);

// Of a finer raster within polygons, at the points of a layout.
struct CoveredMeans {
  Raster amount;  // sum v_k A_k over the area of the point's cell, A_k of what polygons cover: 0 without data
  Raster mean;    // over what they cover; NaN without data
};
[[nodiscard]] CoveredMeans averaged(const CoveredRaster& part, const Raster& layout);

}  // namespace thawslide::gis
