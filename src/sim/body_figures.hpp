// What the bodies of a case come to at t = 0, and how they stand.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/simulation.hpp"

namespace thawslide::sim {

// Thickness is vertical, of the columns of particles. Of 2D cases extensive figures are per metre of width.
struct BodyFigures {
  std::string name;
  std::size_t particles = 0;
  double volume = 0.0;                                                           // of its particles [m3]
  double shape_volume = 0.0;                                                     // as the case gives it [m3]
  double mass = 0.0;                                                             // [kg]
  double area = 0.0;                                                             // horizontal [m2]
  double mean_thickness = 0.0, median_thickness = 0.0, largest_thickness = 0.0;  // [m]
  double particles_across = 0.0, most_particles_across = 0.0;                    // of median and largest thickness
  double spacing = 0.0;                                                          // of its particles [m]
  double coldest = 0.0, warmest = 0.0;                                           // [C]
  // Of its underside above what is below it, the ground or another body: the smallest distance over all columns [m],
  // infinite where nothing is below; and the share of its area that stands on that, to one spacing.
  double clearance = 0.0, standing_share = 1.0;
};

// By name, as in the case. For a simulation that has not taken a step.
template <int Dim>
[[nodiscard]] std::vector<BodyFigures> body_figures(const Simulation<Dim, double>& simulation);

}  // namespace thawslide::sim
