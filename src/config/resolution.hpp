// Particles and cells that results need across a body, cost of a finer cell, and the resolutions of `thawslide new`.
#pragma once

#include <array>
#include <string>

#include "config/case.hpp"

namespace thawslide::config {

// Removes the round-off of a product from a number for a file or a message.
[[nodiscard]] double tidy(double number);

// Largest number of one or two digits (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten) that is at most x.
[[nodiscard]] double round_down(double x);

inline constexpr double fewest_particles = 4.0;  // across the thickness, for shear and thinning

// Cells across the thickness for maps; the deposit on a plane is then 4 % too small (docs/theory/contact.md).
inline constexpr double cells_for_maps = 4.0;

struct BodyOnCells {
  std::string name;
  double thickness = 0.0;  // vertical, median [m]
  double cell = 0.0;       // [m]
  int particles_per_axis = 2;
  int dimension = 3;
  bool has_maps = false;  // whether the user asks for maps
};

// True if the case sets maps.cell or maps.arrival_thickness, and thus needs accurate maps; every 3D run writes them.
[[nodiscard]] bool requests_maps(const Case& parameters);

// Factor of the run time on a finer cell, (cell/finer)^(dimension + 1): cells per axis, and steps of elastic waves.
[[nodiscard]] double run_time_factor(double cell, double finer, int dimension);

// Warning about a body with too few particles or cells across its median thickness; `key` sets the cell. Or empty.
[[nodiscard]] std::string resolution_warning(const BodyOnCells& body, const std::string& key);

enum class Resolution { quick, standard, fine };

// Named resolution, its cells across the release, and the effect of half the cell (benchmarks/decisions/viscosity.md).
struct ResolutionFacts {
  Resolution resolution;
  const char* name;
  double cells_across;
  const char* errors;
};

inline constexpr std::array<ResolutionFacts, 3> resolutions{
    {{Resolution::quick, "quick", 2.0, "half the cell: 0.6 % (travel), 10 % (areas) on a plane"},
     {Resolution::standard, "standard", 4.0, "half the cell: 0.4 % (travel), 5 % (areas) on a plane"},
     {Resolution::fine, "fine", 8.0, "errors not measured"}}};

// The finest named resolution with at most this number of cells across a body; null below `quick`.
[[nodiscard]] const ResolutionFacts* resolution_with(double cells_across);

// Throws std::out_of_range for another name.
[[nodiscard]] Resolution resolution_named(const std::string& name);

// Size of the cells [m]. quick: thickness particles_per_axis/fewest_particles, where half of the volume is thinner than
// `thickness`; standard: median_thickness/cells_for_maps; both rounded down. fine: half of standard.
[[nodiscard]] double cell_of(Resolution resolution, double thickness, double median_thickness, int particles_per_axis);

}  // namespace thawslide::config
