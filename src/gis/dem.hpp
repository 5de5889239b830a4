// The ground of a case from its DEM.
#pragma once

#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

struct Dem {
  Raster raster;            // about the domain, with the system to compute in; NaN in holes
  Raster before_smoothing;  // at the same points; empty: nothing was smoothed
  config::Roughness roughness;
  Rectangle span;  // from the first to the last point that the file has room for, where a domain may be

  [[nodiscard]] const Raster& as_measured() const { return before_smoothing.empty() ? raster : before_smoothing; }
};

// Cropped to the domain and some cells about it, resampled and smoothed as the case asks for it. Adds to the notes.
[[nodiscard]] Dem load_dem(const config::Case& parameters, std::vector<std::string>& warnings);

}  // namespace thawslide::gis
