// What a run comes to in a few numbers: the deposit, how far the slide went, how far it fell, and the angle of reach.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace thawslide::sim {

// Angle of reach [degrees], atan(H/L): slope of the straight line from the highest point of the release to the front of
// the deposit, which H [m] lies below it and L [m] away (the Fahrboeschung of Heim 1932). NaN without any distance.
[[nodiscard]] double angle_of_reach(double drop_height, double travel_distance);

struct RunFigures {
  double deposit_volume = 0.0;   // of all thicker than maps.arrival_thickness [m3]
  double deposit_area = 0.0;     // of the same, horizontal [m2]
  double front_distance = 0.0;   // of the front, along the path from its first corner [m]
  double travel_distance = 0.0;  // horizontal, along the path, from the release's rear end to the front [m]
  double drop_height = 0.0;      // of the ground at the front below the highest point of the release [m]
  double reach_angle = 0.0;      // [degrees]
};

// By name and unit, as run.json tells them.
[[nodiscard]] std::vector<std::pair<std::string, double>> named(const RunFigures& figures);

}  // namespace thawslide::sim
