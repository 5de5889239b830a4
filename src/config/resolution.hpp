// Numbers of particles and cells that results need across the thickness of a body, the cost of a finer cell,
// and the named resolutions of `thawslide new`.
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

// Cells across the thickness for maps: the area of the deposit of a slide on a plane is then 4 % too small
// (docs/theory/contact.md).
inline constexpr double cells_for_maps = 4.0;

struct BodyOnCells {
  std::string name;
  double thickness = 0.0;  // vertical, median [m]
  double cell = 0.0;       // [m]
  int particles_per_axis = 2;
  int dimension = 3;
  bool has_maps = false;  // whether the user asks for maps
};

// Every 3D run writes maps. A case that sets maps.cell or maps.arrival_thickness needs them to be accurate. maps.path
// does not count: it is the line along which the front is measured.
[[nodiscard]] bool requests_maps(const Case& parameters);

// Run time on a finer cell, divided by that on the present one. The number of occupied cells is proportional to 1/cell
// per axis, and so is the number of time steps, because an elastic wave may not cross a cell in one step.
//   (cell/finer)^(dimension + 1)
[[nodiscard]] double run_time_factor(double cell, double finer, int dimension);

// Warning about a body with too few particles across its median thickness, or with too few cells for maps; empty if
// there are enough. It starts with `key`, which sets the cell. Any cell fits the domain, which moves to whole cells.
[[nodiscard]] std::string resolution_warning(const BodyOnCells& body, const std::string& key);

enum class Resolution { quick, standard, fine };

// A named resolution, its cells across the thickness of the release, and what cells half as large change: on a plane
// that runs out, with the material and the transfer of `thawslide new` (benchmarks/decisions/viscosity.md).
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

// Size [m] of cells that follow the terrain for a release in 3D. thickness [m]: half of the volume is where the release
// is thinner. median_thickness [m]: half of the area is where it is thinner.
//   quick      thickness * particles_per_axis / fewest_particles
//   standard   median_thickness / cells_for_maps
//   fine       half of standard
// quick and standard are rounded down to few digits.
[[nodiscard]] double cell_of(Resolution resolution, double thickness, double median_thickness, int particles_per_axis);

}  // namespace thawslide::config
