// Slide on a DEM, both created in memory.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base_cases.hpp"
#include "config/site.hpp"
#include "mpm/front.hpp"
#include "sim/simulation.hpp"
#include "small_terrain.hpp"

namespace thawslide::testing_support {

using Height = std::function<double(double x, double y)>;  // [m], at positions in [m]

// Time [s], grid and domain [m].
struct Frame {
  double end, step, cell;
  Position least, greatest;
};

// Case "release" with other frame, material and friction angle [degrees].
inline Variant release_on_dem(const Frame& frame, const Sets& material, double friction_angle) {
  const auto list = [](const Position& p) { return fmt::format("[{}, {}, {}]", p[0], p[1], p[2]); };
  return {"release", Sets(fmt::format(
                         "time.end={}; time.step={}; grid.cell={}; grid.min={}; grid.max={}; basal.friction_angle={}",
                         frame.end, frame.step, frame.cell, list(frame.least), list(frame.greatest), friction_angle)) +
                         material};
}

// Rock that barely deforms, under the stress of a slab on a slope; viscosity divided by stiffness [s].
inline Sets elastic_rock(double viscosity_time) {
  return fmt::format(
      "material.debris.law=elastic; material.debris.youngs_modulus=5e8; material.debris.poisson_ratio=0.2; "
      "material.debris.gaps_close_first=false; material.debris.viscosity_time={}; mechanics.slope_shear=true",
      viscosity_time);
}

// Case from a text or a variant, whose files are "dem.tif" and "thickness.tif". They
// exist but are empty: their contents are in the site.
template <class Text>
config::Case case_on_dem(const Text& text, const Sets& sets = {}) {
  const std::filesystem::path folder = folder_of_this_test();
  std::ofstream(folder / "dem.tif");
  std::ofstream(folder / "thickness.tif");
  return paper_case(text, sets);
}

// Points `cell` [m] apart over the rectangle between two points.
inline Raster raster_between(const Place& least, const Place& greatest, double cell, const Height& height) {
  const auto count = [&](int axis) { return 1 + static_cast<int>(std::lround((greatest - least)[axis] / cell)); };
  return raster(least[0], least[1], cell, count(0), count(1), height);
}

// Thickness [m] over the rectangle between two points, sampled at the centres of squares of side `cell` [m]: it falls
// to zero half a cell outside the rectangle.
inline Raster thickness_between(const Place& least, const Place& greatest, double cell, const Height& thickness) {
  const Place half = Place::Constant(0.5 * cell);
  return raster_between(least + half, greatest - half, cell, thickness);
}

inline config::Site site_of(Raster ground, Raster thickness) {
  config::Site site;
  site.ground = std::make_shared<const Raster>(std::move(ground));
  site.releases["slide"].thickness = std::move(thickness);
  return site;
}

// Mass averages over the particles of position [m, absolute] and velocity [m/s].
struct CentreOfMass {
  double mass = 0.0;
  Position position = Position::Zero(), velocity = Position::Zero();

  explicit CentreOfMass(const sim::Simulation<3>& simulation) {
    const auto& particles = simulation.particles();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      mass += particles.mass(p);
      position += particles.mass(p) * particles.position.get<Position>(p);
      velocity += particles.mass(p) * particles.velocity.get<Position>(p);
    }
    position = position / mass + simulation.model().origin;
    velocity /= mass;
  }
};

// Front of particles (mpm/front.hpp) along any measure of distance.
struct MassOnPath {
  double along, mass;  // [m, kg]
};

// Distance behind which 99.5 % of the mass is.
inline double front_of(std::vector<MassOnPath> masses) {
  std::sort(masses.begin(), masses.end(), [](const MassOnPath& a, const MassOnPath& b) { return a.along > b.along; });
  double mass = 0.0;
  for (const MassOnPath& one : masses) {
    mass += one.mass;
  }
  mpm::FrontSearch search(mass);
  return std::find_if(masses.begin(), masses.end(), [&](const MassOnPath& one) { return search.is_at(one.mass); })
      ->along;
}

}  // namespace thawslide::testing_support
