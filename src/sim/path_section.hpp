// The section of a 3D case on a DEM along its path: the 2D case that the rigid block slides. A case without a path gets
// the way of steepest descent from the centre of its release.
//
// The terrain is the ground below the path from the release on, which goes on straight where the release reaches beyond
// its ends; it ends with the path, or where this leaves the DEM below the release. The release stands on it
// as thick as it is on average across the path: its points are counted at the nearest place of the path, over lengths
// of a cell of the grid, or two of the DEM where these are longer; volume over area is the thickness. Initial fields
// from maps become their mean over the release's volume, those over x their value at its centre; the velocity becomes
// its parts along the path and upwards. Substrates become stretches of the path, to a quarter of the distance of the
// DEM's points. Sides and frames are left out: the block never meets them.
#pragma once

#include <optional>

#include "base/table.hpp"
#include "config/case.hpp"
#include "config/site.hpp"
#include "sim/path_line.hpp"

namespace thawslide::sim {

struct PathSection {
  config::Case parameters;  // 2D: x is the distance along the path [m], y the elevation [m]
  config::Site site;        // its profile
  Table valley_factor;      // over the distance (valley_factor.hpp)
  bool path_given = true;   // or found by steepest descent
  double off_steepest = 0;  // angle between the path and the steepest descent at the release's middle [degrees]

  // That the way of steepest descent ends in: where, along it [m] and in space. What lies beyond is no way down.
  struct Pit {
    double along;
    Place2 place;
  };
  std::optional<Pit> pit;
};

// Of a case with one body. Throws UserError for a path without a length, that passes the release by or has no ground
// there, for a release from which no way leads down, for a body that is no release, and for tilted gravity.
[[nodiscard]] PathSection section_along_path(const config::Case& parameters, const config::Site& site);

}  // namespace thawslide::sim
