#include "sim/records/run_figures.hpp"

#include <cmath>
#include <limits>

namespace thawslide::sim {

double angle_of_reach(double drop_height, double travel_distance) {
  constexpr double degrees_per_radian = 57.29577951308232;
  return travel_distance > 0.0 ? degrees_per_radian * std::atan2(drop_height, travel_distance)
                               : std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::pair<std::string, double>> named(const RunFigures& figures) {
  return {{"covered_volume_m3", figures.covered_volume},  {"covered_area_m2", figures.covered_area},
          {"affected_area_m2", figures.affected_area},    {"deposit_area_m2", figures.deposit_area},
          {"inundated_area_m2", figures.inundated_area},  {"front_distance_m", figures.front_distance},
          {"travel_distance_m", figures.travel_distance}, {"drop_height_m", figures.drop_height},
          {"reach_angle_degrees", figures.reach_angle}};
}

}  // namespace thawslide::sim
