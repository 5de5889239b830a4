// Which bodies move as one, and the friction between those that do not: what [contact] and [contact_pair.NAME] say
// together.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Bodies that are bonded, one by way of others too, are of one layer; layers are numbered by their first body.
struct BodyLayers {
  std::vector<std::size_t> of_body;    // by name
  std::size_t count = 1;               // at least 1
  std::vector<double> friction_angle;  // degrees, by layer * count + other layer

  [[nodiscard]] double friction_between(std::size_t layer, std::size_t other) const {
    return friction_angle[layer * count + other];
  }
};

// For a case whose pairs name bodies that are there. `contradiction`, where it is not null, gets the text on the first
// pair that does not fit the others, and `of_pair` its name.
[[nodiscard]] BodyLayers body_layers(const Case& parameters, std::string* contradiction = nullptr,
                                     std::string* of_pair = nullptr);

}  // namespace thawslide::config
