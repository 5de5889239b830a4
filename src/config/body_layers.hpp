// Groups of bodies that move as one, and the friction between the groups, from [contact] and [contact_pair.NAME].
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "config/case.hpp"

namespace thawslide::config {

// Whether a body is held for a time (body.NAME.release_time).
[[nodiscard]] inline bool has_stages(const Case& parameters) {
  return std::any_of(parameters.bodies.begin(), parameters.bodies.end(), [](const auto& body) {
    return body.second.release_time.number > 0.0 || !body.second.release_time.attribute.empty();
  });
}

// Bodies that are bonded, directly or through others, share a layer; layers are numbered by their first body.
struct BodyLayers {
  std::vector<std::size_t> of_body;    // by name
  std::size_t count = 1;               // at least 1
  std::vector<double> friction_angle;  // degrees, by layer * count + other layer

  [[nodiscard]] double friction_between(std::size_t layer, std::size_t other) const {
    return friction_angle[layer * count + other];
  }
};

// Pairs must name existing bodies. `contradiction` receives a text on the first inconsistent pair, `of_pair` its name.
[[nodiscard]] BodyLayers body_layers(const Case& parameters, std::string* contradiction = nullptr,
                                     std::string* of_pair = nullptr);

}  // namespace thawslide::config
