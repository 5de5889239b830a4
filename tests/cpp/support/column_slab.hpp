// Case with band columns: an elastic slab on a frictional incline, with the grid along the slope.
#pragma once

#include <algorithm>
#include <vector>

#include "band/basal_segments.hpp"
#include "base_cases.hpp"

namespace thawslide::testing_support {

// 200 m long, 40 m thick, on 30 degrees, with an initial velocity of 8 m/s; `dimension` 2 or 3 (40 m wide between
// smooth walls).
inline Variant column_slab(int dimension = 2) {
  const Sets space =
      "case.dimension=3; grid.min=[-60,0,-20]; grid.max=[600,40,80]; grid.boundary.y_min=roller; "
      "grid.boundary.y_max=roller; body.slab.min=[0,0,0]; body.slab.max=[200,40,40]; body.slab.velocity=[8,0,0]";
  return {"columns", dimension == 3 ? space : Sets()};
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
