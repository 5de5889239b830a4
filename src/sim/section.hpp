// A vertical section through the ground and a release along a line: what a 2D case is cut out of.
#pragma once

#include <string>
#include <vector>

#include "base/raster.hpp"
#include "sim/path_line.hpp"

namespace thawslide::sim {

// Distances along the line [m]: `from`, `to`, the corners between that are apart, and as many between these as leave no
// two farther apart than `spacing`.
[[nodiscard]] std::vector<double> stations_along(const PathLine& line, double from, double to, double spacing);

// Elevations [m] of the triangulated ground at the stations; NaN beyond its points, and where it has no data.
[[nodiscard]] std::vector<double> ground_along(const PathLine& line, const std::vector<double>& stations,
                                               const Raster& ground);

// Throws UserError, which begins with `source`, with the first station up to `to` [m] whose elevation is NaN.
void require_known(const PathLine& line, const std::vector<double>& stations, const std::vector<double>& elevations,
                   double to, const Raster& ground, const std::string& source);

// A thickness [m] at the stations, triangulated as the ground is, so that ground and thickness sum to the triangulated
// sum; 0 beyond its points.
[[nodiscard]] std::vector<double> thickness_along(const PathLine& line, const std::vector<double>& stations,
                                                  const Raster& thickness);

}  // namespace thawslide::sim
