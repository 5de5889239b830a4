// Case with every mechanism, for tests of whole steps.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "base_cases.hpp"
#include "config/site.hpp"
#include "small_terrain.hpp"

namespace thawslide::testing_support {

// Two bodies on a slope, one frozen and one melted, with every mechanism. Each body has a different particle size and
// number of particles per cell, so that SIMD batches are not aligned with nodes. length, height: of the left body [m];
// speed: of both down the slope [m/s]; sets: further keys of the case.
template <int Dim>
config::Case two_bodies(double cohesion, double length = 7.0, double height = 5.0, double speed = 0.0,
                        const Sets& sets = {}) {
  const auto at = [](double x, double z, double y) {
    return Dim == 2 ? fmt::format("[{}, {}]", x, z) : fmt::format("[{}, {}, {}]", x, y, z);
  };
  const Sets size = fmt::format(
      "case.dimension={}; grid.min={}; grid.max={}; body.left.min={}; body.left.max={}; body.right.min={}; "
      "body.right.max={}; body.left.velocity={}; body.right.velocity={}",
      Dim, at(-4.0, -4.0, -4.0), at(std::ceil(length) + 33.0, height + 15.0, 10.0), at(0.0, 0.0, 0.0),
      at(length, height, 3.0), at(length, 0.0, 0.0), at(length + 4.3, 4.1, 3.0), at(speed, 0.0, 0.0),
      at(speed, 0.0, 0.0));
  const Sets strength =
      fmt::format("material.frozen.cohesion={0}; material.melted.cohesion={0}; material.melted.residual_cohesion={1}",
                  cohesion, 0.5 * cohesion);
  return published_case("two_bodies", size + strength + sets);
}

// Ground of a DEM, whose content is in the site: the file exists but is empty.
inline Sets on_dem() {
  const auto file = folder_of_this_test() / "dem.tif";
  std::ofstream{file};
  return "terrain.type=dem; terrain.file=" + file.string();
}

// Its content: bumps below the bodies, known up to a position along x [m].
inline config::Site bumpy_site(double known_to = 1e9, double spacing = 2.0) {
  config::Site site;
  const int columns = static_cast<int>(120.0 / spacing), rows = static_cast<int>(32.0 / spacing);
  site.ground = std::make_shared<const Raster>(raster(-10.0, -10.0, spacing, columns, rows, [&](double x, double y) {
    return x > known_to ? no_data : 0.1 * std::sin(0.7 * x) * std::cos(0.9 * y) - 0.11;
  }));
  return site;
}

// Bed of melted material below two_bodies, weak enough to be entrained.
inline Sets loose_bed() {
  return "bed.depth={x=[-4,8],value=[0.2,0.6]}; bed.strength=100; bed.friction_angle=5; bed.depth_per_slip=0.2; "
         "bed.material=melted; bed.temperature=-0.5; bed.porosity=0.9; bed.particles_per_axis=4";
}

}  // namespace thawslide::testing_support
