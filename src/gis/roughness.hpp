// Noise and short bumps of a DEM, which act on a slide as friction, and the width of a filter against them.
//
// The formulas and numbers of friction are measurements of Thawslide itself: blocks on planes and in V channels with
// white noise on the points (docs/theory/contact.md, "Roughness").
#pragma once

#include <string>
#include <vector>

#include "base/raster.hpp"
#include "config/case.hpp"
#include "config/site.hpp"
#include "gis/rectangle.hpp"

namespace thawslide::gis {

// Points of a DEM in a line that the estimate of noise fits a parabola to.
inline constexpr int points_of_fit = 9;

// Rms of the white noise on the points of a raster within a rectangle [m]; 0 where there are too few points.
//
// In each of four directions (along the axes and the diagonals) the deviation of a point from the parabola that fits
// it and four neighbours on each side best (Savitzky and Golay 1964). Its median over a tile of 16 x 16 points, over
// 0.6745 and the share of white noise that is left of it, estimates the rms there; the least of the four directions
// counts, so that an edge, a thalweg or a step is not noise. Of the tiles the noise that a seventh exceeds counts: a
// slide runs where it is rough too. Noise of whole rows or columns, as surveys leave it, is none along these: where
// three quarters of the tiles have it in the other directions, the second least counts. Curvature that the points
// resolve deviates in the fourth order of their distance only.
[[nodiscard]] double noise_rms(const Raster& raster, const Rectangle& rectangle);

// Rms slope of white noise of `rms` on points `spacing` apart, at the scale of a cell, after a Gaussian filter.
[[nodiscard]] double noise_slope(double rms, double spacing, double cell, double width);

// Friction that noise of an rms slope adds, as a share of the friction.
[[nodiscard]] double apparent_friction(double slope);

inline constexpr double largest_slope = 0.06;  // that the choice of a width leaves: 2.5 % of friction

// Length of the waves of which short_waves keeps half.
[[nodiscard]] double bump_length(double spacing, double cell);

// What a DEM has in and about a rectangle of waves shorter than bump_length [m]: half of those of this
// length, 0.98 of those half as long, and 0.03 of those twice as long. Planes, and waves that many points resolve,
// leave nothing.
[[nodiscard]] Raster short_waves(const Raster& raster, const Rectangle& rectangle, double cell);

// Rms slope of short waves within a rectangle at the scale of a cell, after a Gaussian filter; 0 where there are too
// few points. That of a tile of 16 x 16 points follows from its medians in four directions, so that a thalweg, a crest
// or a cliff, which have no slope along themselves, do not count. Of the tiles the upper quartile counts.
[[nodiscard]] double bump_slope(const Raster& short_waves, const Rectangle& rectangle, double cell, double width);

// The least width that leaves `largest_slope`: 0, or from half a spacing on, where the law of noise_slope holds, in
// steps of a tenth of the larger of spacing and half a cell, up to twice the larger of spacing and cell.
[[nodiscard]] double fitting_width(double rms, double spacing, double cell);

// The same about a body: the median of the tiles in a rectangle, widened to at least one tile.
[[nodiscard]] double noise_below_body(const Raster& raster, const Rectangle& rectangle);

// The noise and bumps in a rectangle, and about bodies if that is more noise, and the filter against them: the wider of
// those that leave `largest_slope` of the noise and of the bumps. The latter goes in steps of a tenth of the spacing,
// up to twice the spacing. It does not depend on the cell where that is at most two spacings: slides on several cells
// then move on the same ground.
[[nodiscard]] config::Roughness roughness_of(const Raster& raster, const Rectangle& rectangle, double cell,
                                             const config::NumberOrAuto& smooth,
                                             const std::vector<Rectangle>& bodies = {});

// What the user should know of noise that stays; empty where it adds little to the friction.
[[nodiscard]] std::string roughness_warning(const config::Case& parameters, const config::Site& site);

// Width between its walls, along the level, of the V valley with walls of 45 degrees that loses 3 % of its wedge effect
// by the filter.
[[nodiscard]] double narrow_valley(double width);

}  // namespace thawslide::gis
