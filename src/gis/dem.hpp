// Ground of a case from its DEM.
#pragma once

#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

struct Dem {
  Raster raster;            // around the domain, in the reference system of the computation; NaN in holes
  Raster before_smoothing;  // at the same points; empty: no smoothing
  config::Roughness roughness;
  Rectangle span;  // from the first to the last possible point of the file: limit of a domain

  [[nodiscard]] const Raster& as_measured() const { return before_smoothing.empty() ? raster : before_smoothing; }
};

// Crops the DEM to the domain with a margin of some cells, and resamples and smooths it as specified by the case.
// Appends warnings.
[[nodiscard]] Dem load_dem(const config::Case& parameters, std::vector<std::string>& warnings);

}  // namespace thawslide::gis
