// A run in a few numbers: how much ground the slide covers and has covered, how far it went, how far it fell, and the
// angle of reach.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace thawslide::sim {

// Angle of reach [degrees], atan(H/L): slope of the straight line from the highest point of the release to the front of
// the slide, which H [m] lies below it and L [m] away (the Fahrboeschung of Heim 1932). NaN without any distance.
[[nodiscard]] double angle_of_reach(double drop_height, double travel_distance);

struct RunFigures {
  double covered_volume = 0.0;   // of all thicker than maps.arrival_thickness now [m3]
  double covered_area = 0.0;     // horizontal, of the same (sim/covered_area.hpp) [m2]
  double affected_area = 0.0;    // where it was at any time [m2]
  double front_distance = 0.0;   // of the front, along the path from its first corner [m]
  double travel_distance = 0.0;  // horizontal, along the path, from the release's rear end to the front [m]
  double drop_height = 0.0;      // of the ground at the front below the highest point of the release [m]
  double reach_angle = 0.0;      // [degrees]
};

// By name and unit, as run.json tells them.
[[nodiscard]] std::vector<std::pair<std::string, double>> named(const RunFigures& figures);

}  // namespace thawslide::sim
