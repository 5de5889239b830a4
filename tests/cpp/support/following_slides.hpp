// Slides on cells that follow the ground: a block on a plane, and a release in a curved gully.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "channel_on_dem.hpp"
#include "following_plane.hpp"

namespace thawslide::testing_support {

inline std::unique_ptr<sim::Simulation<2>> slide_on_plane(double slope, const Sets& sets = {}) {
  const Incline plane{slope};
  return std::make_unique<sim::Simulation<2>>(body_on_plane(
      plane, 10.0, {plane.place(-100, 0), plane.place(100, 0), plane.place(100, 40), plane.place(-100, 40)}, sets));
}

// Gully with waves along it.
inline double gully(double x, double y) {
  return 0.002 * y * y - 0.4 * x + 3.0 * std::sin(0.1 * x) + 2.0 * std::sin(0.13 * y);
}

inline std::unique_ptr<sim::Simulation<3>> slide_in_gully(const Sets& sets = {}) {
  const Place half(200.0, 200.0);
  const auto slide =
      release_on_dem({20.0, 0.01, 10.0, {-200.0, -200.0, -200.0}, {200.0, 200.0, 300.0}}, loose_rock, 20.0);
  const Raster ground = raster_between(-half, half, 4.0, gully);
  const Raster thickness = thickness_between(-half, half, 5.0, [](double x, double y) {
    return std::max(0.0, 30.0 * (1.0 - std::pow((x + 50.0) / 60.0, 2) - std::pow(y / 60.0, 2)));
  });
  return std::make_unique<sim::Simulation<3>>(case_on_dem(slide, "time.stepping=adaptive" + sets),
                                              site_of(ground, thickness));
}

}  // namespace thawslide::testing_support
