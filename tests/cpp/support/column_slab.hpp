// Case with band columns: an elastic slab on a frictional incline, with the grid along the slope.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "case_from_text.hpp"

namespace thawslide::testing_support {

// 200 m long, 40 m thick, on 30 degrees, with an initial velocity of 8 m/s; `dimension` 2 or 3 (40 m wide between
// smooth walls).
inline std::string column_slab(int dimension = 2) {
  const bool space = dimension == 3;
  return fmt::format(
      R"(
[case]
dimension = {}
gravity_tilt = 30.0
[time]
end = 6.0
step = 0.005
[grid]
cell = 10.0
min = {}
max = {}
{}
[terrain]
type = "flat"
elevation = 0.0
[phases]
water_expansion_law = "by_temperature"
[material.rock]
law = "elastic"
youngs_modulus = 2e8
poisson_ratio = 0.2
viscosity_time = 0.02
hydraulic_conductivity = 1e-7
[body.slab]
material = "rock"
min = {}
max = {}
temperature = -1.0
porosity = 0.375
velocity = {}
[basal]
friction = "lubricated"
friction_angle = 32.0
cohesion = 0.0
heat_fraction = 0.9
[band]
model = "columns"
thickness = 0.1
thickness_change = "conserving"
[pressure]
frozen = "none"
frozen_rows = "sealed"
melt_contraction = true
skeleton_compressibility = 2e-9
)",
      dimension, space ? "[-60.0, 0.0, -20.0]" : "[-60.0, -20.0]", space ? "[600.0, 40.0, 80.0]" : "[600.0, 80.0]",
      space ? "boundary.y_min = \"roller\"\nboundary.y_max = \"roller\"" : "", space ? "[0.0, 0.0, 0.0]" : "[0.0, 0.0]",
      space ? "[200.0, 40.0, 40.0]" : "[200.0, 40.0]", space ? "[8.0, 0.0, 0.0]" : "[8.0, 0.0]");
}

// Median of of(segment) over the basal segments.
template <class Simulation, class Of>
double median_over_base(const Simulation& simulation, const Of& of) {
  std::vector<double> numbers;
  for (const auto& segment : simulation.band_columns()->segments()) {
    numbers.push_back(of(segment));
  }
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

}  // namespace thawslide::testing_support
