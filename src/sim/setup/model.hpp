// Model: parameters of each stage in the solver's types, built from the case; positions relative to the local origin.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "band/model.hpp"
#include "band/segment_step.hpp"
#include "config/case.hpp"
#include "config/site.hpp"
#include "mpm/between_bodies.hpp"
#include "mpm/constraints.hpp"
#include "mpm/motion.hpp"
#include "terrain/contact.hpp"
#include "terrain/following_ground.hpp"
#include "terrain/polyline.hpp"
#include "terrain/substrates.hpp"

namespace thawslide::sim {

template <int Dim>
struct Model {
  Vector<double, Dim> origin;  // lower corner of the domain [m]; positions are relative to it
  mpm::MotionModel<Dim> motion;
  mpm::Constraints<Dim> constraints;
  mpm::BetweenBodies between_bodies;
  terrain::ContactModel contact;
  band::BandModel<Dim> band;
  std::shared_ptr<const terrain::FollowingGround<Dim>> ground;  // null if there is none
  std::shared_ptr<const terrain::Substrates> substrates;        // null if the ground is of one kind
  std::optional<terrain::Polyline> profile;                     // ground, if it is a line over x
  std::vector<double> free_gaps;                        // by material: 1: gaps are stress-free, 0: they carry stress
  bool splits_stretched = false;                        // particles, along the ground (mpm/splitting.hpp)
  double bed_density = 0;                               // of the erodible bed [kg/m3]; 0 if there is none
  std::vector<std::string> body_names, material_names;  // by number; the last body is the entrained bed material
  std::vector<double> release_times;                    // by body [s]; empty: all bodies move from the start
};

template <int Dim>
mpm::Mapping mapping_of(const Model<Dim>& model) {
  return {model.ground != nullptr};
}

// Background grid without particles.
template <int Dim>
mpm::SparseGrid<Dim> make_grid(const config::Case& parameters, const Model<Dim>& model) {
  return mpm::SparseGrid<Dim>(parameters.grid.cell, model.between_bodies.layer_of_body, mapping_of(model));
}

// Case of a simulation and all that follows from it before the first step.
template <int Dim>
struct Setup {
  config::Case parameters;
  config::Site site;  // contents of its map files
  Model<Dim> model;

  [[nodiscard]] double cell() const { return parameters.grid.cell; }  // mesh size [m]
  [[nodiscard]] bool is_adaptive() const { return parameters.time.stepping == config::Stepping::adaptive; }
  // Prescribed band thickness [m].
  [[nodiscard]] double band_thickness(double time) const { return parameters.band.thickness.at(time); }
};

// site: contents of the map files of the case; required if the terrain is a DEM.
template <int Dim>
Model<Dim> make_model(const config::Case& parameters, const config::Site& site = {});

// Material of the columns at the body's base: temperature [C], porosity, hydraulic conductivity [m/s], and maximum flow
// depth [m].
struct ColumnMaterial {
  double temperature, porosity, hydraulic_conductivity, depth;
};

template <int Dim>
band::ColumnsModel make_columns_model(const config::Case& parameters, const Model<Dim>& model,
                                      const ColumnMaterial& material);

}  // namespace thawslide::sim
