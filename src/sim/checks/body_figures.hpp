// Properties of the bodies of a case at t = 0.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/simulation.hpp"

namespace thawslide::sim {

// Thickness is vertical, from columns of particles. In 2D, extensive quantities are per metre of width.
struct BodyFigures {
  std::string name;
  std::size_t particles = 0;
  double volume = 0.0;        // of the particles [m3]
  double shape_volume = 0.0;  // of the shape specified by the case [m3]
  double mass = 0.0;          // [kg]
  double area = 0.0;          // horizontal [m2]
  double mean_thickness = 0.0, median_thickness = 0.0, largest_thickness = 0.0;  // [m]
  double particles_across = 0.0, max_particles_across = 0.0;  // across the median and the maximum thickness
  double spacing = 0.0;                                       // of the particles [m]
  double release_time = 0.0;                                  // [s]
  double coldest = 0.0, warmest = 0.0;                        // minimum and maximum temperature [C]
  // Minimum clearance of all columns above the ground or another body [m], infinite if nothing is below; fraction of
  // the area that rests on it, to within one spacing.
  double clearance = 0.0, resting_fraction = 1.0;
};

// By name, as in the case. Requires a simulation before its first step.
template <int Dim>
[[nodiscard]] std::vector<BodyFigures> body_figures(const Simulation<Dim>& simulation);

}  // namespace thawslide::sim
