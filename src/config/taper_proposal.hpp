// Width of the edges of an excavated release that lets the slide leave the pit.
//
// An excavation with upright edges is a pit whose lower wall is as high as the release is thick, and which holds the
// slide back. A taper of width w along the outline turns the wall into a ramp, whose maximum rise against the terrain
// is 2 t / w for a release of thickness t at its edge. If this is at most the slope s of the terrain, the base that the
// slide leaves falls everywhere. The proposal is therefore w = 2 t / s in whole cells. The minimum is 3 t (34 degrees,
// gentler than the angle at which broken rock stands). The maximum is 10 t (11 degrees, sufficient for nearly level
// ground).
#pragma once

#include "base/raster.hpp"

namespace thawslide::config {

struct EdgeTaper {
  double width = 0.0;     // [m]; 0: no taper is needed, or there is no space for one
  double wanted = 0.0;    // width without limits of space [m]
  double steepest = 0.0;  // rise of the ramp against the terrain, divided by its run
  double slope = 0.0;     // fall of the terrain below the release, divided by its run
  [[nodiscard]] bool is_cramped() const { return width < wanted; }
};

// dem: NaN for no data; thickness: vertical [m], untapered, on the same points. The width is less than wanted if the
// taper would reach unknown ground, or reduce the thickness in the middle of the release.
[[nodiscard]] EdgeTaper propose_taper(const Raster& dem, const Raster& thickness);

// Fall of the mean plane of the terrain below a release, divided by its run.
[[nodiscard]] double slope_below(const Raster& dem, const Raster& thickness);

}  // namespace thawslide::config
