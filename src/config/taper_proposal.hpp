// How wide the edges of a release that is cut out of a DEM must be for the slide to get out.
//
// A cut with upright edges is a pit: its lower wall is as high as the release is thick and holds it back. The taper of
// width w about the outline makes a ramp of it, which at its steepest rises 2 t / w against the terrain, for a release
// t thick at its edge. The base that the slide leaves over falls everywhere where that is no more than the slope s of
// the terrain. So w = 2 t / s is proposed, at least 3 t, which is 34 degrees and gentler than the angle at which broken
// rock stands, and at most 10 t, which is 11 degrees and serves ground that is nearly level; in whole cells.
#pragma once

#include "base/raster.hpp"

namespace thawslide::config {

struct EdgeTaper {
  double width = 0.0;     // [m]; 0: no taper is needed, or there is room for none
  double wanted = 0.0;    // what it would be with more room [m]
  double steepest = 0.0;  // rise of the ramp against the terrain, over its run
  double slope = 0.0;     // fall of the terrain below the release, over its run
  [[nodiscard]] bool is_cramped() const { return width < wanted; }
};

// dem: NaN where there is no data; thickness: vertical [m], untapered, on points of the same places. The width is less
// than wanted where the taper would reach ground that is not known, or would make a release thinner in its middle.
[[nodiscard]] EdgeTaper propose_taper(const Raster& dem, const Raster& thickness);

}  // namespace thawslide::config
