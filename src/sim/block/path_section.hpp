// Section of a 3D case on a DEM along its path: the 2D case for the rigid block. If the case specifies no path, the
// line of steepest descent from the centre of its release is used.
//
// The terrain is the ground below the path, beginning at the release, and extended straight if the release reaches
// beyond its ends. It ends with the path, or where the path leaves the DEM below the release. The release has the mean
// thickness across the path. Its points are assigned to the nearest point of the path, in bins of one grid cell, or of
// two DEM cells if these are longer; thickness is volume over area. Initial fields from maps become their mean over the
// release's volume, fields over x their value at its centre. The velocity becomes its components along the path and
// upwards. Substrates become stretches of the path, resolved to a quarter of the DEM spacing. Sides and frames are
// omitted, because the block never reaches them.
#pragma once

#include <optional>

#include "base/table.hpp"
#include "config/case.hpp"
#include "config/site.hpp"
#include "sim/block/block.hpp"
#include "sim/maps/path_line.hpp"

namespace thawslide::sim {

struct PathSection {
  config::Case parameters;  // 2D: x is the distance along the path [m], y the elevation [m]
  config::Site site;        // contains the profile
  Table valley_factor;      // over the distance (section.hpp)
  BlockStart start;         // of the whole release
  bool path_given = true;   // false: found by steepest descent
  double off_steepest = 0;  // angle between the path and the steepest descent at the release's middle [degrees]

  // Closed depression in which the line of steepest descent ends: distance along it [m] and position. Nothing beyond it
  // leads down.
  struct Pit {
    double along;
    Point2 point;
  };
  std::optional<Pit> pit;
};

// Requires a case with one body. Throws UserError for a path without length, a path that misses the release or has no
// ground there, a release without a downhill path, a body that is not a release, and tilted gravity.
[[nodiscard]] PathSection section_along_path(const config::Case& parameters, const config::Site& site);

}  // namespace thawslide::sim
