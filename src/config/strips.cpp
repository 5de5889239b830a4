#include "config/strips.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thawslide::config {

std::vector<Strip> strips_of(const Case& parameters) {
  std::vector<Strip> strips;
  for (const auto& [name, substrate] : parameters.substrates) {
    if (substrate.is_strip()) {
      strips.push_back({name, substrate.x_min, substrate.x_max});
    }
  }
  std::sort(strips.begin(), strips.end(), [](const Strip& one, const Strip& other) { return one.from < other.from; });
  return strips;
}

std::vector<std::string> warnings_of_gaps(const Case& parameters) {
  std::vector<std::string> warnings;
  const std::vector<Strip> strips = strips_of(parameters);
  for (std::size_t k = 1; k < strips.size(); ++k) {
    const double from = strips[k - 1].to, to = strips[k].from;
    if (to > from) {
      warnings.push_back(fmt::format(
          "between the substrates {} and {}, from x = {:.9g} to {:.9g} m, there is no substrate: [basal] applies there",
          strips[k - 1].name, strips[k].name, from, to));
    }
  }
  return warnings;
}

}  // namespace thawslide::config
