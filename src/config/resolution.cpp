#include "config/resolution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/rounding.hpp"

namespace thawslide::config {

namespace {

bool are_enough(double found, double needed) { return found >= needed * (1.0 - 1e-9); }

// Rounded down: a number that is too small must not appear to be enough.
std::string format_found(double found) { return fmt::format("{:.2g}", rounded_down(found, 2)); }

}  // namespace

double tidy(double number) { return std::stod(fmt::format("{:.12g}", number)); }

double round_down(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  double best = tidy(power);
  for (const double digit : {1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    best = digit * power <= x * (1.0 + 1e-12) ? tidy(digit * power) : best;
  }
  return best;
}

bool requests_maps(const Case& parameters) {
  return parameters.general.dimension == 3 &&
         (was_given(parameters, "maps.cell") || was_given(parameters, "maps.arrival_thickness"));
}

double run_time_factor(double cell, double finer, int dimension) { return std::pow(cell / finer, dimension + 1); }

std::string resolution_warning(const BodyOnCells& body, const std::string& key) {
  const double cells = body.thickness / body.cell, particles = cells * body.particles_per_axis;
  const bool lacks_particles = !are_enough(particles, fewest_particles);
  const bool lacks_cells = body.has_maps && !are_enough(cells, cells_for_maps);
  if (!lacks_particles && !lacks_cells) {
    return "";
  }
  const auto times = [&](double finer) { return rounded_text(run_time_factor(body.cell, finer, body.dimension)); };
  const double moving = round_down(body.thickness * body.particles_per_axis / fewest_particles);
  const double mapped = round_down(body.thickness / cells_for_maps);
  std::string problem, remedy;
  if (lacks_particles) {
    problem = fmt::format("too few particles to resolve shear and thinning (found {}; needed {:g})",
                          format_found(particles), fewest_particles);
    remedy = fmt::format("{:.9g} m, at about {} times the run time", moving, times(moving));
  }
  if (lacks_cells) {
    problem += fmt::format("{}too few cells for maps of thickness and area (found {}; needed {:g})",
                           lacks_particles ? ", and " : "", format_found(cells), cells_for_maps);
    remedy += fmt::format("{}{:.9g} m, at about {} times the run time", lacks_particles ? ", or for maps to " : "",
                          mapped, times(mapped));
  }
  return fmt::format("{}: across the median thickness of body {}, {} m, there are {}. Set {} to {}.{}", key, body.name,
                     rounded_text(body.thickness, 3), problem, key, remedy,
                     lacks_cells && !lacks_particles ? " Travel distance and speed need 2." : "");
}

Resolution resolution_named(const std::string& name) {
  const auto* const found = std::find_if(resolutions.begin(), resolutions.end(),
                                         [&](const ResolutionFacts& facts) { return name == facts.name; });
  if (found == resolutions.end()) {
    throw std::out_of_range(name);
  }
  return found->resolution;
}

const ResolutionFacts* resolution_with(double cells_across) {
  const ResolutionFacts* found = nullptr;
  for (const ResolutionFacts& each : resolutions) {
    found = are_enough(cells_across, each.cells_across) ? &each : found;
  }
  return found;
}

double cell_of(Resolution resolution, double thickness, double median_thickness, int particles_per_axis) {
  if (resolution == Resolution::quick) {
    return round_down(thickness * particles_per_axis / fewest_particles);
  }
  const double standard = round_down(median_thickness / cells_for_maps);
  return resolution == Resolution::standard ? standard : 0.5 * standard;
}

}  // namespace thawslide::config
