#include "app/substrate_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/rounding.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::app {

namespace {

// Length along x within the domain [m].
double length_of(const config::Substrate& strip, const config::Grid& grid) {
  return std::min(strip.x_max, grid.max[0]) - std::max(strip.x_min, grid.min[0]);
}

// Part of the domain covered by a substrate, along x or as horizontal area.
double covered_by(const std::string& name, const config::Case& parameters, const config::Site& site) {
  const config::Substrate& substrate = parameters.substrates.at(name);
  const double width = parameters.general.dimension == 3 ? parameters.grid.max[1] - parameters.grid.min[1] : 1.0;
  return substrate.is_strip() ? length_of(substrate, parameters.grid) * width : site.substrates.at(name).area;
}

std::string location_of(const config::Substrate& substrate) {
  if (!substrate.raster.empty()) {
    return fmt::format("code {} of its raster", substrate.code);
  }
  if (!substrate.outline.empty()) {
    return "within its polygons";
  }
  if (std::isinf(substrate.x_max)) {
    return fmt::format("from x = {:.9g} m on", substrate.x_min);
  }
  return std::isinf(substrate.x_min) ? fmt::format("up to x = {:.9g} m", substrate.x_max)
                                     : fmt::format("from x = {:.9g} to {:.9g} m", substrate.x_min, substrate.x_max);
}

std::string strength_of(const config::GroundStrength& ground) {
  const double cohesion = ground.numbers(physics::basal::initial_cohesion);
  return fmt::format(
      "friction \"{}\", {}", ground.friction,
      cohesion > 0.0
          ? fmt::format("cohesion {} Pa, \"{}\"",
                        cohesion < 1e3 ? fmt::format("{:g}", cohesion) : with_commas(cohesion, 6), ground.cohesion_law)
          : "no cohesion");
}

}  // namespace

std::vector<SubstrateFacts> substrate_facts(const config::Case& parameters, const config::Site& site) {
  std::vector<SubstrateFacts> facts;
  if (parameters.substrates.empty()) {
    return facts;
  }
  double whole = 1.0, left = 1.0;
  for (std::size_t a = 0; a + 1 < static_cast<std::size_t>(parameters.general.dimension); ++a) {
    whole *= parameters.grid.max[a] - parameters.grid.min[a];
  }
  for (const auto& [name, substrate] : parameters.substrates) {
    const double covered = covered_by(name, parameters, site);
    facts.push_back({name, location_of(substrate), covered, covered / whole, strength_of(substrate)});
    left -= covered / whole;
  }
  const double fraction = std::max(0.0, left);
  facts.push_back({"", "elsewhere [basal]", fraction * whole, fraction, strength_of(parameters.basal)});
  return facts;
}

}  // namespace thawslide::app
