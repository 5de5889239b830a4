// Noise and short bumps of a DEM, which act on a slide like friction, and the width of a filter that reduces them.
//
// The formulas and numbers of friction were measured with Thawslide: blocks on planes and in V channels with white
// noise on the points (docs/theory/roughness.md).
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

// Rms of the white noise on the points of a raster within a rectangle [m]; 0 if there are too few points.
//
// The deviation of a point from the best-fit parabola through it and four neighbours on each side is computed in four
// directions, along the axes and the diagonals (Savitzky and Golay 1964). Its median over a tile of 16 x 16 points,
// divided by 0.6745 and by the remaining fraction of white noise, estimates the rms. The minimum of the four directions
// counts, so an edge, a thalweg or a step is not noise. The result is the noise that a seventh of the tiles exceeds,
// because a slide crosses rough areas too. Noise of whole rows or columns, a survey artefact, is absent along these. If
// three quarters of the tiles have it in the other directions, the second smallest counts. Resolved curvature causes
// deviations only of the fourth order in the spacing.
[[nodiscard]] double noise_rms(const Raster& raster, const Rectangle& rectangle);

// Rms slope of white noise of `rms` on points `spacing` apart, at the scale of a cell, after a Gaussian filter.
[[nodiscard]] double noise_slope(double rms, double spacing, double cell, double width);

// Friction added by noise of an rms slope, as a fraction of the friction.
[[nodiscard]] double apparent_friction(double slope);

inline constexpr double largest_slope = 0.06;  // remaining slope for which a width is chosen: 2.5 % of friction

// Wavelength of which short_waves keeps half.
[[nodiscard]] double bump_length(double spacing, double cell);

// Waves of a DEM shorter than bump_length [m], in and around a rectangle. Half of the waves of this length are kept,
// 0.98 of those half as long, and 0.03 of those twice as long. Planes, and waves that many points resolve, leave
// nothing.
[[nodiscard]] Raster short_waves(const Raster& raster, const Rectangle& rectangle, double cell);

// Rms slope of short waves within a rectangle at the scale of a cell, after a Gaussian filter; 0 if there are too few
// points. The slope of a tile of 16 x 16 points follows from its medians in four directions. A thalweg, a crest or a
// cliff has no slope along itself and does not count. The result is the upper quartile of the tiles.
[[nodiscard]] double bump_slope(const Raster& short_waves, const Rectangle& rectangle, double cell, double width);

// Smallest width that leaves `largest_slope`: 0, or a value from half a spacing upwards, where the formula of
// noise_slope holds. Steps are a tenth of the larger of spacing and half a cell, up to twice the larger of spacing and
// cell.
[[nodiscard]] double fitting_width(double rms, double spacing, double cell);

// The same around a body: the median of the tiles in a rectangle, widened to at least one tile.
[[nodiscard]] double noise_below_body(const Raster& raster, const Rectangle& rectangle);

// Noise and bumps in a rectangle, or around bodies if the noise there is larger, and the filter width. It is the larger
// of the widths that leave `largest_slope` of the noise and of the bumps. The latter is searched in steps of a tenth of
// the spacing, up to twice the spacing. It does not depend on the cell if the cell is at most two spacings: slides on
// different cells then move on the same ground.
[[nodiscard]] config::Roughness roughness_of(const Raster& raster, const Rectangle& rectangle, double cell,
                                             const config::NumberOrAuto& smooth,
                                             const std::vector<Rectangle>& bodies = {});

// Warning about noise that remains and adds to the friction; empty if there is none.
[[nodiscard]] std::string roughness_warning(const config::Case& parameters, const config::Site& site);

// Width between the walls, at one level, of a V valley with walls of 45 degrees that loses 3 % of its wedge effect by
// the filter.
[[nodiscard]] double narrow_valley(double width);

}  // namespace thawslide::gis
