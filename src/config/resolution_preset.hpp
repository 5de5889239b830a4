// Resolutions that `thawslide new` offers by name: the cell of each, and the results that it is good for.
#pragma once

#include <array>
#include <string>

namespace thawslide::config {

enum class Resolution { quick, standard, fine };

struct ResolutionFacts {
  Resolution resolution;
  const char* name;
  const char* purpose;
};

inline constexpr std::array<ResolutionFacts, 3> resolutions{
    {{Resolution::quick, "quick", "for travel distance and speed"},
     {Resolution::standard, "standard", "for thickness and area too"},
     {Resolution::fine, "fine", "the difference is half of the error of standard"}}};

// Throws std::out_of_range for another name.
[[nodiscard]] Resolution resolution_named(const std::string& name);

// The cell [m] of a release in space. thickness: half of its volume is where it is thinner; median_thickness: half of
// its area is [m].
//   quick      thickness * particles_per_axis / proposed_particles
//   standard   median_thickness / cells_for_maps
//   fine       half of standard
// quick and standard in few digits, and rounded down.
[[nodiscard]] double cell_of(Resolution resolution, double thickness, double median_thickness, int particles_per_axis);

}  // namespace thawslide::config
