// Slide on a DEM, both created in memory.
#pragma once

#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "case_from_text.hpp"
#include "config/site.hpp"
#include "friction_alone.hpp"
#include "sim/simulation.hpp"
#include "small_terrain.hpp"

namespace thawslide::testing_support {

using Height = std::function<double(double x, double y)>;  // [m], at positions in [m]

// The only body of a case of slide_on_dem().
const std::string release_table = "[body.slide]\nshape = \"release\"\nthickness = { raster = \"thickness.tif\" }\n";

// Time [s], grid and domain [m].
struct Frame {
  double end, step, cell;
  Position least, greatest;
};

// Text of a case in which a release of the material "debris" slides with Coulomb friction [degrees] alone; `material`:
// tables of the material and others.
inline std::string release_on_dem(const Frame& frame, const std::string& material, double friction_angle) {
  const auto list = [](const Position& p) { return fmt::format("[{}, {}, {}]", p[0], p[1], p[2]); };
  return fmt::format(R"(
[case]
dimension = 3
[time]
end = {}
step = {}
[grid]
cell = {}
min = {}
max = {}
[terrain]
type = "dem"
file = "dem.tif"
)",
                     frame.end, frame.step, frame.cell, list(frame.least), list(frame.greatest)) +
         material + release_table + "material = \"debris\"\n" + friction_alone(friction_angle);
}

// Rock that barely deforms, under the stress of a slab on a slope; viscosity divided by stiffness [s].
inline std::string elastic_rock(double viscosity_time) {
  return fmt::format(R"(
[material.debris]
law = "elastic"
youngs_modulus = 5e8
poisson_ratio = 0.2
viscosity_time = {}
[mechanics]
slope_shear = true
)",
                     viscosity_time);
}

// Case with `text`, in which the DEM is terrain.file = "dem.tif" and the release is `release_table`. The files exist
// but are empty: their contents are in the site.
inline config::Case case_on_dem(const std::string& text, const std::vector<std::string>& sets = {}) {
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

}  // namespace thawslide::testing_support
