// Probes: time series at given points and cross sections, sampled from the maps.
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "config/case.hpp"
#include "config/site.hpp"
#include "sim/maps/flow_maps.hpp"

namespace thawslide::sim {

// Part of a cross section between four points of the maps.
struct SectionPart {
  double column, row;         // of its middle, in cells as in MapGrid
  double length;              // [m]
  double normal_x, normal_y;  // unit vector across the section, to the right of its direction
};

// Flow through a cross section.
struct SectionFlow {
  double area = 0.0;           // sum of thickness times length [m2]
  double discharge = 0.0;      // sum of thickness times length times normal velocity, positive to the right [m3/s]
  double max_thickness = 0.0;  // [m]

  // Mean speed across the section, |Q|/A of a discharge Q through a flow area A (continuity) [m/s]; 0 without flow.
  [[nodiscard]] double mean_speed() const { return area > 0.0 ? std::abs(discharge) / area : 0.0; }
};

// Parts of a line between the points of a map grid, in order. The line must lie over the grid.
[[nodiscard]] std::vector<SectionPart> parts_of_section(const config::Polyline2& line, const MapGrid& map_grid);

// Flow where the section lies: thickness and discharge are bilinear between the points of the maps, and constant beyond
// the outermost ones.
[[nodiscard]] SectionFlow flow_through(const std::vector<SectionPart>& section, const FlowMaps& maps);

class Probes {
 public:
  Probes() = default;
  // Probes of the site, by name. Throws UserError for a probe outside the map grid.
  Probes(const config::Case& parameters, const std::map<std::string, config::Polyline2>& probes,
         const MapGrid& map_grid);

  [[nodiscard]] bool empty() const { return points_.empty() && sections_.empty(); }
  // One row of probes.csv from the maps at a time [s]: time_s, then for each point, by name, NAME_thickness_m and
  // NAME_speed_m_s of the map cell there, then for each cross section NAME_flow_area_m2, NAME_discharge_m3_s,
  // NAME_mean_speed_m_s and NAME_max_thickness_m.
  [[nodiscard]] std::vector<std::pair<std::string, double>> row(const FlowMaps& maps, double time) const;

 private:
  struct Point {
    std::string name;
    int column, row;
  };
  struct Section {
    std::string name;
    std::vector<SectionPart> parts;
  };

  std::vector<Point> points_;
  std::vector<Section> sections_;
};

}  // namespace thawslide::sim
