// How many particles and cells results need across the thickness of a body, and what a finer cell costs.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

inline constexpr double fewest_particles = 4.0;    // across the thickness, for shear and thinning
inline constexpr double proposed_particles = 6.0;  // as many are proposed
inline constexpr double cells_for_maps = 8.0;      // across the thickness, for thickness and area of the deposit

struct BodyOnCells {
  std::string name;
  double thickness = 0.0;  // vertical, median [m]
  double cell = 0.0;       // [m]
  int particles_per_axis = 2;
  int dimension = 3;
  bool has_maps = false;  // whether the user asks for maps
};

// Every 3D run has maps. A case asks for them with a key of their cells or of the thickness that counts as arrived:
// maps.path alone is the line along which the front is measured.
[[nodiscard]] bool asks_for_maps(const Case& parameters);

// How many times the run time a finer cell takes: occupied cells go with 1/cell per axis, and so does the number of
// time steps, as the elastic wave may not cross a cell in one.
//   (cell/finer)^(dimension + 1)
[[nodiscard]] double run_time_factor(double cell, double finer, int dimension);

// What is said of a body with too few particles across its median thickness, or with too few cells for maps; empty if
// there are enough. It starts with `key`, which sets the cell. The cells that it names fit a domain of these `lengths`
// [m], a whole number of cells each; empty: any cell fits, as the domain follows from it.
[[nodiscard]] std::string resolution_note(const BodyOnCells& body, const std::string& key,
                                          const std::vector<double>& lengths = {});

// A comment of a case file that gives the cell for maps of a body and its cost; empty if `cell` is fine enough.
[[nodiscard]] std::string maps_comment(const BodyOnCells& body);

}  // namespace thawslide::config
