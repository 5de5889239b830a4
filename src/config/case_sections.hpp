// Sections of a case: strength of the ground and of its substrates, the erodible bed, which the slide entrains, and
// output: checkpoints, maps, and data for comparison in reports. Paths are absolute once read, and empty for none.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "base/table.hpp"
#include "physics/basal/parameter.hpp"
#include "physics/options.hpp"

namespace thawslide::config {

using physics::BedLaw;
using physics::FrictionClamp;

// Parameters of basal laws by key; an absent one has its default.
struct LawNumbers {
  std::map<std::string, double> by_key;

  [[nodiscard]] double operator()(const physics::basal::Parameter& number) const {
    const auto found = by_key.find(number.key);
    return found == by_key.end() ? number.initial : found->second;
  }
  [[nodiscard]] double& operator[](const physics::basal::Parameter& number) {
    return by_key.try_emplace(number.key, number.initial).first->second;
  }
};

// Strength of one kind of ground: keywords of physics/basal/laws.hpp, and the parameters of these laws.
struct GroundStrength {
  std::string friction = "lubricated";
  std::string cohesion_law = "slip";
  LawNumbers numbers;
};

struct Basal : GroundStrength {
  FrictionClamp clamp = FrictionClamp::keep_cohesion;
  bool cap_pressure = false;   // P <= N
  double heat_fraction = 1.0;  // energy conversion coefficient
  bool distance_check = true;
};

// Ground with separate properties, and its extent: along x, within polygons, or where a raster has its code.
struct Substrate : GroundStrength {
  double x_min = -std::numeric_limits<double>::infinity(), x_max = std::numeric_limits<double>::infinity();
  std::string outline;                // file of polygons; absolute once read; empty: none
  std::vector<std::string> polygons;  // names of the polygons that bound it; empty: all
  std::string name_attribute = "name";
  std::string raster;  // raster of codes; absolute once read; empty: none
  int code = 0;

  [[nodiscard]] bool is_strip() const { return outline.empty() && raster.empty(); }
};

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
