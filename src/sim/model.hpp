// From the case to what each stage needs: parameters in the solver's types, positions relative to the local origin.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "band/model.hpp"
#include "config/case.hpp"
#include "mpm/constraints.hpp"
#include "mpm/motion.hpp"
#include "terrain/contact.hpp"
#include "terrain/ground.hpp"

namespace thawslide::sim {

template <int Dim, class Real>
struct Model {
  Vector<double, Dim> origin;  // lower corner of the domain [m]; positions are relative to it
  mpm::MotionModel<Dim, Real> motion;
  mpm::Constraints<Dim, Real> constraints;
  terrain::ContactModel<Dim, Real> contact;
  band::BandModel<Dim, Real> band;
  std::optional<terrain::Ground<Dim>> ground;
  // Of the cells that make up the band, over x, both in [m]; empty: one cell. The largest counts for the step.
  std::function<Real(Real)> layer_thickness;
  Real largest_layer = 0;
  std::vector<std::string> body_names, material_names;  // by number
};

template <int Dim, class Real>
Model<Dim, Real> make_model(const config::Case& parameters);

}  // namespace thawslide::sim
