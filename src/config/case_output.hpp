// Output settings of a case: checkpoints, maps, and data for comparison in reports. Paths are absolute once read, and
// empty for none.
#pragma once

#include <string>
#include <vector>

namespace thawslide::config {

struct Checkpoint {
  double interval = 0;         // s of simulated time; 0: at the end
  double wall_interval = 600;  // s of wall-clock time; 0: none
};

struct Maps {
  double cell = 0.0;               // m; 0: determined by the DEM and grid.cell
  double arrival_thickness = 0.1;  // m, thickness at which the slide has arrived
  double area_thickness = 0.5;     // m, thickness from which ground counts as deposit or as inundated
  std::string path;                // line along which the front is measured
};

struct Report {
  std::string author;                 // name or office
  std::string scenario;               // sentences on the simulated event
  std::string logo;                   // PNG or JPEG
  std::vector<double> times;          // s, of the snapshot figures; empty: selected by displacement
  std::string targets;                // CSV: quantity,time_s,value,unit,source,kind
  std::string force_record;           // CSV: time_s,up_N,north_N,east_N
  std::vector<double> force_periods;  // s, shortest and longest period of the record's waves
  std::string force_source;           // author of the inversion
};

}  // namespace thawslide::config
