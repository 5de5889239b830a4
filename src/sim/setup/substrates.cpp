#include "sim/setup/substrates.hpp"

#include "base/error.hpp"

namespace thawslide::sim {

std::shared_ptr<const terrain::Substrates> make_substrates(const config::Case& parameters, const config::Site& site) {
  if (parameters.substrates.empty()) {
    return nullptr;
  }
  auto substrates =
      std::make_shared<terrain::Substrates>(std::array<double, 2>{parameters.grid.min[0], parameters.grid.min[1]});
  const bool is_section = !site.profile.empty();
  int number = 0;
  for (const auto& [name, substrate] : parameters.substrates) {
    ++number;
    if (is_section) {
      for (const config::SubstrateStretch& stretch : site.stretches) {
        if (stretch.name == name) {
          substrates->add_strip(number, stretch.from, stretch.to);
        }
      }
    } else if (substrate.is_strip()) {
      substrates->add_strip(number, substrate.x_min, substrate.x_max);
    } else {
      const auto area = site.substrates.find(name);
      THAWSLIDE_ASSERT(area != site.substrates.end(), "{}: no map was read for substrate {}", parameters.name, name);
      if (area->second.codes != nullptr) {
        substrates->add_code(number, area->second.codes, area->second.code);
      } else {
        substrates->add_rings(number, area->second.rings);
      }
    }
  }
  return substrates;
}

}  // namespace thawslide::sim
