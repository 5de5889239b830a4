// From the case to what each stage needs: parameters in the solver's types, positions relative to the local origin.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "band/model.hpp"
#include "config/case.hpp"
#include "config/site.hpp"
#include "mpm/between_bodies.hpp"
#include "mpm/constraints.hpp"
#include "mpm/motion.hpp"
#include "terrain/contact.hpp"
#include "terrain/polyline.hpp"
#include "terrain/substrates.hpp"
#include "terrain/surface.hpp"

namespace thawslide::sim {

template <int Dim, class Real>
struct Model {
  Vector<double, Dim> origin;  // lower corner of the domain [m]; positions are relative to it
  mpm::MotionModel<Dim, Real> motion;
  mpm::Constraints<Dim, Real> constraints;
  mpm::BetweenBodies<Real> between_bodies;
  terrain::ContactModel<Dim, Real> contact;
  band::BandModel<Dim, Real> band;
  std::shared_ptr<const terrain::Surface<Dim>> ground;    // null: none
  std::shared_ptr<const terrain::Substrates> substrates;  // null: it is all of one kind
  std::optional<terrain::Polyline> profile;               // the ground, where it is a line over x
  // Of the cells that make up the band, over horizontal places, both in [m]; empty: one cell. The largest counts for
  // the step.
  std::function<Real(const Vector<Real, Dim - 1>&)> layer_thickness;
  std::function<double(const std::array<int, Dim - 1>&)> layer_at_middle;  // of a column of cells
  Real largest_layer = 0;
  std::vector<Real> free_gaps;                          // by material: 1: its gaps are free, 0: they bear stress
  Real bed_density = 0;                                 // of the erodible bed [kg/m3]; 0: there is none
  std::vector<std::string> body_names, material_names;  // by number; the last body is what is taken up of the bed
};

// site: what the map files of the case hold; needed where the terrain is a DEM.
template <int Dim, class Real>
Model<Dim, Real> make_model(const config::Case& parameters, const config::Site& site = {});

}  // namespace thawslide::sim
