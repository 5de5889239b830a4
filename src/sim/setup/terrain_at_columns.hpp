// Terrain functions for the columns of the slide (band/slide_columns.hpp). They refer to the model, which must outlive
// them.
#pragma once

#include <algorithm>

#include "band/columns.hpp"
#include "sim/setup/model.hpp"

namespace thawslide::sim {

// Empty without ground. cell: mesh size [m].
template <int Dim>
band::OfPosition<Dim> slope_cosine_of(const Model<Dim>& model, double cell) {
  if (!model.ground) {
    return {};
  }
  return [&model, cell](const Vector<double, Dim - 1>& point) { return model.ground->slope_cosine(point, cell); };
}

template <int Dim>
band::OfPosition<Dim> normal_gravity_of(const Model<Dim>& model, double cell) {
  return [&model, cell](const Vector<double, Dim - 1>& point) {
    const Vector<double, Dim> gravity = model.motion.gravity;
    if (!model.ground) {
      return -gravity[Dim - 1];
    }
    const auto normal = model.ground->normal_below(point, cell);
    return std::max(0.0, gravity.dot(normal)) * -normal[Dim - 1];
  };
}

}  // namespace thawslide::sim
