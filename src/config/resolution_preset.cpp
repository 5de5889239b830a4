#include "config/resolution_preset.hpp"

#include <algorithm>
#include <stdexcept>

#include "config/fitting_cell.hpp"
#include "config/resolution.hpp"

namespace thawslide::config {

Resolution resolution_named(const std::string& name) {
  const auto* const found = std::find_if(resolutions.begin(), resolutions.end(),
                                         [&](const ResolutionFacts& facts) { return name == facts.name; });
  if (found == resolutions.end()) {
    throw std::out_of_range(name);
  }
  return found->resolution;
}

double cell_of(Resolution resolution, double thickness, double median_thickness, int particles_per_axis) {
  if (resolution == Resolution::quick) {
    return round_down(thickness * particles_per_axis / proposed_particles);
  }
  const double standard = round_down(median_thickness / cells_for_maps);
  return resolution == Resolution::standard ? standard : 0.5 * standard;
}

}  // namespace thawslide::config
