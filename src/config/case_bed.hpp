// Erodible bed of a case, which the slide entrains.
#pragma once

#include <string>
#include <vector>

#include "base/table.hpp"
#include "physics/options.hpp"

namespace thawslide::config {

using physics::BedLaw;

struct Bed {
  BedLaw law = BedLaw::none;
  InitialField depth;                 // m, vertical: a number, a table over x, a raster, an attribute of the polygons
  std::string outline;                // file of polygons; absolute once read; empty: none
  std::vector<std::string> polygons;  // names of the polygons that the bed covers; empty: all
  std::string name_attribute = "name";
  double strength = 0;        // Pa, c_b
  double friction_angle = 0;  // phi_b
  double depth_per_slip = 0;  // 1
  std::string material;
  double temperature = -10.0, porosity = 0.9;
  int particles_per_axis = 2;  // per cell and axis, for entrained material
};

}  // namespace thawslide::config
