// Distortion of lengths and angles by a map projection.
#pragma once

#include <string>

#include "gis/rectangle.hpp"

namespace thawslide::gis {

// Principal point scales: the smallest and the largest length on the map over the length on the ellipsoid, by direction
// (Snyder 1987, Map projections: a working manual, USGS Professional Paper 1395, pp. 20-26). Their ratio is that of the
// axes of Tissot's indicatrix, which measures the angular distortion.
struct PointScales {
  double smallest = 1.0, largest = 1.0;
  double x = 0.0, y = 0.0;  // on the map [m]

  // Largest relative error of lengths, or of ratios of lengths in two directions.
  [[nodiscard]] double error() const;
};

// Scales at the corner of the extent with the largest error. `wkt`: a projection in metres. Without distortion if no
// corner lies on the ellipsoid.
[[nodiscard]] PointScales worst_scales(const std::string& wkt, const Rectangle& extent);

}  // namespace thawslide::gis
