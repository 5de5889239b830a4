// Key figures of a run: covered area, travel distance, drop height and reach angle.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace thawslide::sim {

// Reach angle [degrees], atan(H/L): slope of the straight line from the highest point of the release to the front of
// the slide, which is H [m] lower and L [m] away (the Fahrboeschung of Heim 1932). NaN at zero distance.
[[nodiscard]] double angle_of_reach(double drop_height, double travel_distance);

struct RunFigures {
  double covered_volume = 0.0;   // current, of cells thicker than maps.arrival_thickness [m3]
  double covered_area = 0.0;     // horizontal, of the same cells (sim/maps/covered_area.hpp) [m2]
  double affected_area = 0.0;    // covered at any time [m2]
  double deposit_area = 0.0;     // of cells now thicker than maps.area_thickness [m2]
  double inundated_area = 0.0;   // of cells ever thicker than it [m2]
  double front_distance = 0.0;   // of the front, along the path from its first corner [m]
  double travel_distance = 0.0;  // horizontal, along the path, from the release's rear end to the front [m]
  double drop_height = 0.0;      // of the ground at the front below the highest point of the release [m]
  double reach_angle = 0.0;      // [degrees]
};

// Name with unit and value, as in run.json.
[[nodiscard]] std::vector<std::pair<std::string, double>> named(const RunFigures& figures);

}  // namespace thawslide::sim
