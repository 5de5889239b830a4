// Small 3D slide for tests of run records.
#pragma once

#include <fmt/format.h>

#include "case_from_text.hpp"

namespace thawslide::testing_support {

// Frictionless box of 6 x 4 x 3 m of warm ice on a plane of 25 degrees that falls towards +x, on a grid of 1 m; `body`:
// more keys of the box.
inline config::Case slide_in_space(const std::string& body = "", const std::vector<std::string>& sets = {}) {
  return paper_case(fmt::format(R"(
[case]
dimension = 3
gravity_tilt = 25.0
[time]
end = 10.0
step = 0.002
[grid]
cell = 1.0
min = [-4.0, -5.0, -3.0]
max = [60.0, 15.0, 20.0]
[terrain]
type = "flat"
elevation = 0.0
[material.rock]
law = "mohr_coulomb"
youngs_modulus = 1e7
poisson_ratio = 0.3
friction_angle = 20.0
cohesion = 0.0
hydraulic_conductivity = 1e-9
[body.box]
material = "rock"
min = [0.0, 3.0, 0.0]
max = [6.0, 7.0, 3.0]
temperature = -0.5
porosity = 0.375
{}
[basal]
friction = "lubricated"
friction_angle = 5.0
[band]
thickness = 0.1
)",
                                body),
                    sets);
}

}  // namespace thawslide::testing_support
