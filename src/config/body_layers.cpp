#include "config/body_layers.hpp"

#include <fmt/format.h>

#include <iterator>
#include <numeric>

namespace thawslide::config {

namespace {

std::size_t number_of(const Case& parameters, const std::string& body) {
  return static_cast<std::size_t>(std::distance(parameters.bodies.begin(), parameters.bodies.find(body)));
}

// Merges the layers of two bodies under the lower number.
void join(std::vector<std::size_t>& layer, std::size_t body, std::size_t other) {
  const std::size_t from = std::max(layer[body], layer[other]), to = std::min(layer[body], layer[other]);
  std::replace(layer.begin(), layer.end(), from, to);
}

// True if a pair names the two bodies; otherwise the setting for all bodies applies.
bool are_named(const Case& parameters, const std::string& body, const std::string& other) {
  return std::any_of(parameters.contact_pairs.begin(), parameters.contact_pairs.end(), [&](const auto& pair) {
    const auto& names = pair.second.bodies;
    return (names[0] == body && names[1] == other) || (names[0] == other && names[1] == body);
  });
}

std::vector<std::size_t> layers_of(const Case& parameters) {
  std::vector<std::size_t> layer(parameters.bodies.size());
  std::iota(layer.begin(), layer.end(), std::size_t{0});
  for (const auto& [name, pair] : parameters.contact_pairs) {
    if (pair.contact == BodyContact::bonded) {
      join(layer, number_of(parameters, pair.bodies[0]), number_of(parameters, pair.bodies[1]));
    }
  }
  if (parameters.contact.between_bodies == BodyContact::bonded) {
    for (const auto& [body, unused] : parameters.bodies) {
      for (const auto& [other, also_unused] : parameters.bodies) {
        if (body < other && !are_named(parameters, body, other)) {
          join(layer, number_of(parameters, body), number_of(parameters, other));
        }
      }
    }
  }
  // Renumbers the layers without gaps.
  std::vector<std::size_t> used = layer;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (std::size_t& number : layer) {
    number = static_cast<std::size_t>(std::lower_bound(used.begin(), used.end(), number) - used.begin());
  }
  return layer;
}

}  // namespace

BodyLayers body_layers(const Case& parameters, std::string* contradiction, std::string* of_pair) {
  BodyLayers layers;
  layers.of_body = layers_of(parameters);
  layers.count = layers.of_body.empty() ? 1 : 1 + *std::max_element(layers.of_body.begin(), layers.of_body.end());
  layers.friction_angle.assign(layers.count * layers.count, parameters.contact.friction_angle);
  std::vector<std::string> set_by(layers.friction_angle.size());
  const auto report = [&](const std::string& pair, const std::string& text) {
    if (contradiction != nullptr && contradiction->empty()) {
      *contradiction = text;
      *of_pair = pair;
    }
  };
  for (const auto& [name, pair] : parameters.contact_pairs) {
    const std::size_t layer = layers.of_body[number_of(parameters, pair.bodies[0])],
                      other = layers.of_body[number_of(parameters, pair.bodies[1])];
    if (pair.contact != BodyContact::frictional) {
      continue;
    }
    if (layer == other) {
      report(name, fmt::format("contact_pair.{}: {} and {} are frictional here, but bonded through other bodies. Set "
                               "contact.between_bodies = \"frictional\", and make only those pairs "
                               "\"bonded\" that move as one.",
                               name, pair.bodies[0], pair.bodies[1]));
      continue;
    }
    const std::string& before = set_by[layer * layers.count + other];
    if (!before.empty() && layers.friction_between(layer, other) != pair.friction_angle) {
      report(name, fmt::format("contact_pair.{}: its friction_angle is {}, and that of contact_pair.{}, whose bodies "
                               "are bonded to these, {}; allowed: one between bodies that move as one. Give both the "
                               "same.",
                               name, pair.friction_angle, before, layers.friction_between(layer, other)));
    }
    for (const std::size_t index : {layer * layers.count + other, other * layers.count + layer}) {
      layers.friction_angle[index] = pair.friction_angle;
      set_by[index] = name;
    }
  }
  return layers;
}

}  // namespace thawslide::config
