// Bodies that touch: assignment of each point, and thickness in each body's own part.
//
// The thickness t_b of a body b at the points of the ground falls to 0 within a cell of its outline, or over its taper.
// There is no such edge where another body continues beyond the outline. With the fraction w_b of each point's cell
// that b covers, distributed by its taper like t_b, the thickness in its own part is
//    T_b = t_b / w_b  min(1, sum of w over all bodies)
// The own part is the area within its outline, and beyond all outlines the area in which its fraction is the largest.
#pragma once

#include <map>
#include <string>

#include "gis/release.hpp"

namespace thawslide::gis {

// Throws UserError if the outlines of two bodies overlap by more than a thousandth of the smaller area.
void check_overlaps(const config::Case& parameters, const std::map<std::string, LoadedRelease>& releases);

// Sets T_b (`standing`) of touching bodies and the fractions that assign points to them (`claim`). The volume of each
// is conserved. Throws UserError if two touching bodies have different tapers.
void join_touching(const config::Case& parameters, std::map<std::string, LoadedRelease>& releases);

}  // namespace thawslide::gis
