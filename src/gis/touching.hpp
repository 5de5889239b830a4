// Bodies that touch: whose each place is, and how thick it lies there.
//
// The thickness t_b of a body b at the points of the ground falls to 0 within a cell about its outline, or over its
// taper. Where another body goes on beyond the outline there is no such edge. With the share w_b of each point's cell
// that b covers, spread by its taper like t_b,
//   T_b = t_b / w_b  min(1, sum of w over all bodies)
// is how thick it lies in its own part: within its outline, and beyond all outlines where its share is the largest.
#pragma once

#include <map>
#include <string>

#include "gis/release.hpp"

namespace thawslide::gis {

// Throws UserError where the outlines of two bodies overlap by more than a thousandth of the smaller one's area.
void check_overlaps(const config::Case& parameters, const std::map<std::string, LoadedRelease>& releases);

// Gives bodies that touch their T_b (`standing`) and the shares that tell whose a place is (`claim`). The volume of
// each stays its own. Throws UserError where two that touch have different tapers.
void join_touching(const config::Case& parameters, std::map<std::string, LoadedRelease>& releases);

}  // namespace thawslide::gis
