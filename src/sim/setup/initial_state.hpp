// Temperature and porosity at t = 0, from the fields of the case.
#pragma once

#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/raster.hpp"
#include "config/case.hpp"
#include "config/site.hpp"
#include "sim/setup/model.hpp"
#include "sim/setup/release_body.hpp"
#include "sim/setup/seed.hpp"

namespace thawslide::sim {

// Value of a field at a seed, from the case or from a map of the release.
template <int Dim>
double initial_value(const InitialField& field, const config::Release* release, const std::string& key,
                     const Seed<Dim>& seed) {
  if (!field.is_map()) {
    return field.at(seed.depth, seed.position[0]);
  }
  THAWSLIDE_ASSERT(release != nullptr, "the field {} of the map '{}' without a release", key, field.source);
  const Raster& map = release->fields.at(key);
  const double value = bilinear(map, seed.position[0], seed.position[1], Missing::unknown);
  if (std::isfinite(value)) {
    return value;
  }
  // At the edge, some surrounding points have no value; use the nearest one that has.
  return nearest_value(map, seed.position[0], seed.position[1]);
}

// [C]; given, or computed from the saturation by the freezing curve.
template <int Dim>
double initial_temperature(const Model<Dim>& model, const config::Body& body, const config::Release* release,
                           const Seed<Dim>& seed) {
  if (!body.saturation.is_given()) {
    return initial_value(body.temperature, release, "temperature", seed);
  }
  const auto saturation = initial_value(body.saturation, release, "saturation", seed);
  return model.band.with_heat_content([&](const auto& content) { return content.curve.temperature(saturation); });
}

// Ice fills the pores except for the liquid fraction.
template <int Dim>
double initial_porosity(const config::Body& body, const config::Release* release, const Seed<Dim>& seed,
                        double saturation) {
  return body.ice_content.is_given()
             ? initial_value(body.ice_content, release, "ice_content", seed) / (1.0 - saturation)
             : initial_value(body.porosity, release, "porosity", seed);
}

}  // namespace thawslide::sim
