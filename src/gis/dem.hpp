// Ground of a case from its DEM.
#pragma once

#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/point_window.hpp"

namespace thawslide::gis {

struct Dem {
  Raster raster;            // around the domain, in the reference system of the computation; NaN in holes
  Raster before_smoothing;  // at the same points; empty: no smoothing
  config::Roughness roughness;
  std::string heights;  // vertical reference system of the elevations; empty: not specified
  Rectangle span;       // from the first to the last possible point of the file: limit of a domain

  [[nodiscard]] const Raster& as_measured() const { return before_smoothing.empty() ? raster : before_smoothing; }
};

// Complete DEM of a file, for computations without a case. `crs`: as terrain.crs. Appends warnings.
[[nodiscard]] Raster read_dem(const std::string& file, const std::string& crs, std::vector<std::string>& warnings);

// Crops the DEM to the domain with a margin of some cells, and resamples and smooths it as specified by the case.
// Appends warnings.
[[nodiscard]] Dem load_dem(const config::Case& parameters, std::vector<std::string>& warnings);

}  // namespace thawslide::gis
