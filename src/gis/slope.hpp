// Conversion of thickness from the slope normal to the vertical.
//
// A surface z(x, y) has the normal (-dz/dx, -dz/dy, 1) / sqrt(1 + (dz/dx)^2 + (dz/dy)^2); its last component is the
// cosine of the slope. A layer of thickness t along the normal of a plane measures t / cos(slope) along the vertical.
#pragma once

#include <cmath>

namespace thawslide::gis {

// Vertical thickness [m] of a layer `along_normal` [m] thick on a plane with the gradient dz/dx, dz/dy.
inline double vertical_thickness(double along_normal, double dz_dx, double dz_dy) {
  return along_normal * std::sqrt(1.0 + dz_dx * dz_dx + dz_dy * dz_dy);
}

}  // namespace thawslide::gis
