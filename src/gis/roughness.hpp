// Noise and short bumps of a DEM, which act on a slide like friction, and the width of a filter against them. Numbers
// were measured with blocks on planes and in V channels with white noise (docs/theory/roughness.md).
#pragma once

#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/point_window.hpp"

namespace thawslide::gis {

// DEM points in a line to which the noise estimate fits a parabola.
inline constexpr int points_of_fit = 9;

// Rms of the white noise on the points of a raster within a rectangle [m]; 0 for too few. From deviations from the
// best-fit parabola through four neighbours on each side in four directions (Savitzky and Golay 1964): medians of tiles
// of 16 x 16 points in the direction of their minimum, because an edge or a thalweg is no noise; quantile of the tiles.
[[nodiscard]] double noise_rms(const Raster& raster, const Rectangle& rectangle);

// Rms slope of white noise of `rms` on points `spacing` apart, at the scale of a cell, after a Gaussian filter.
[[nodiscard]] double noise_slope(double rms, double spacing, double cell, double width);

// Friction added by noise of an rms slope, as a fraction of the friction.
[[nodiscard]] double apparent_friction(double slope);

inline constexpr double largest_slope = 0.06;  // remaining slope for which a width is chosen: 2.5 % of friction

// Wavelength of which short_waves keeps half.
[[nodiscard]] double bump_length(double spacing, double cell);

// Waves of a DEM shorter than bump_length [m] in and around a rectangle: half of those of this length.
[[nodiscard]] Raster short_waves(const Raster& raster, const Rectangle& rectangle, double cell);

// Rms slope of short waves at the scale of a cell, after a Gaussian filter: upper quartile of tiles; or 0.
[[nodiscard]] double bump_slope(const Raster& short_waves, const Rectangle& rectangle, double cell, double width);

// Smallest width that leaves `largest_slope`: 0, or from half a spacing upwards, where noise_slope holds, in steps.
[[nodiscard]] double fitting_width(double rms, double spacing, double cell);

// The same around a body: the median of the tiles in a rectangle, widened to at least one tile.
[[nodiscard]] double noise_below_body(const Raster& raster, const Rectangle& rectangle);

// Noise and bumps in a rectangle or around bodies, and the width that leaves `largest_slope` of both. It does not
// depend on a cell of at most two spacings: slides on different cells then move on the same ground.
[[nodiscard]] config::Roughness roughness_of(const Raster& raster, const Rectangle& rectangle, double cell,
                                             const config::NumberOrAuto& smooth,
                                             const std::vector<Rectangle>& bodies = {});

// Warning about noise that remains and adds to the friction; empty if there is none.
[[nodiscard]] std::string roughness_warning(const config::Case& parameters, const config::Site& site);

// Width between the walls of a V valley of 90 degrees that loses 3 % of its wedge effect by the filter.
[[nodiscard]] double narrow_valley(double width);

}  // namespace thawslide::gis
