// Case with every mechanism, for tests of whole steps.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "case_from_text.hpp"

namespace thawslide::testing_support {

// Two bodies on a slope, one frozen and one melted, with every mechanism. Each body has a different particle size and
// number of particles per cell, so that SIMD batches are not aligned with nodes. length, height: of the left body [m];
// speed: of both down the slope [m/s]; terrain: its table; sets: further keys of the case.
template <int Dim>
config::Case two_bodies(double cohesion, double length = 7.0, double height = 5.0, double speed = 0.0,
                        const std::string& terrain = "type = \"flat\"\nelevation = 0.0",
                        const std::vector<std::string>& sets = {}) {
  const auto at = [](double x, double z) {
    return Dim == 2 ? fmt::format("[{}, {}]", x, z) : fmt::format("[{}, {}, {}]", x, z > 0.0 ? 3.0 : 0.0, z);
  };
  const auto along_slope = Dim == 2 ? fmt::format("[{}, 0.0]", speed) : fmt::format("[{}, 0.0, 0.0]", speed);
  return paper_case(fmt::format(R"(
[case]
dimension = {}
gravity_tilt = 35.0
[time]
end = 10.0
step = 0.002
[grid]
cell = 1.0
min = {}
max = {}
[terrain]
{}
[material.frozen]
law = "mohr_coulomb"
youngs_modulus = 2e8
poisson_ratio = 0.3
friction_angle = 35.0
cohesion = {}
hydraulic_conductivity = 1e-9
[material.melted]
law = "mohr_coulomb"
youngs_modulus = 1e8
poisson_ratio = 0.2
friction_angle = 30.0
cohesion = {}
residual_cohesion = {}
softening_strain = 1.0
tension_cutoff = 1e5
hydraulic_conductivity = 1e-10
[body.left]
material = "frozen"
min = {}
max = {}
velocity = {}
temperature = -0.5
porosity = 0.375
[body.right]
material = "melted"
min = {}
max = {}
velocity = {}
temperature = 1.5
porosity = 0.3
particles_per_axis = 3
[basal]
friction = "lubricated"
friction_angle = 25.0
[band]
thickness = 0.1
)",
                                Dim, Dim == 2 ? "[-4.0, -4.0]" : "[-4.0, -4.0, -4.0]",
                                Dim == 2 ? fmt::format("[{}, {}]", std::ceil(length) + 33.0, height + 15.0)
                                         : fmt::format("[{}, 10.0, {}]", std::ceil(length) + 33.0, height + 15.0),
                                terrain, cohesion, cohesion, 0.5 * cohesion, at(0.0, 0.0), at(length, height),
                                along_slope, at(length, 0.0), at(length + 4.3, 4.1), along_slope),
                    sets);
}

// Bed of melted material below two_bodies, weak enough to be entrained.
inline std::vector<std::string> loose_bed() {
  return {"bed.depth={x=[-4.0,8.0],value=[0.2,0.6]}",
          "bed.strength=100.0",
          "bed.friction_angle=5.0",
          "bed.depth_per_slip=0.2",
          "bed.material=melted",
          "bed.temperature=-0.5",
          "bed.porosity=0.9",
          "bed.particles_per_axis=4"};
}

}  // namespace thawslide::testing_support
