// Slides on DEMs with noise on their points, filtered by default: shared by the short and the complete tests.
#pragma once

#include <random>

#include "../support/channel_on_dem.hpp"
#include "gis/roughness.hpp"
#include "gis/sampling.hpp"
#include "verification.hpp"

namespace thawslide::verification::rough_dem {

// White noise of a given rms [m] on the points, and the filter chosen by terrain.smooth = "auto".
inline Treatment noise_and_filter(double rms, unsigned seed) {
  return [=](Raster ground) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, rms);
    for (double& height : ground.values) {
      height += noise(random);
    }
    const gis::Rectangle domain{-120.0, -120.0, 120.0, 120.0};
    const double width =
        gis::roughness_of(ground, domain, channel_cell, config::NumberOrAuto{.is_auto = true, .number = 0.0}).width;
    return width > 0.0 ? gis::smoothed(ground, width) : ground;
  };
}

inline Record make_record(const std::string& title) {
  return Record(
      title,
      "Loose rock, 60 m long, slides on a slope of 35 degrees with a friction angle of 15 degrees, on cells of 5 m. "
      "The points of the DEM have white noise, filtered by terrain.smooth = \"auto\". Mean from 1 to 3 s.",
      "that of the clean ground: 1 on the plane, 1/sin(a) in a V of half an opening angle a",
      "noise of the DEM is not friction");
}

// A slab of 40 m x 10 m across the slope; noise and point spacing in cells.
inline void expect_no_friction_on_plane(Record& record, double noise, double spacing, double allowed,
                                        unsigned seed = 3) {
  Channel plane = plane_channel(40.0, 10.0);
  plane.spacing = spacing * channel_cell;
  const double found = friction_in_channel(plane, loose_rock, 1.0, 3.0, noise_and_filter(noise * channel_cell, seed));
  record.expect_near(
      fmt::format("apparent friction over that of the ground, plane, noise {} cells rms, points {} cells "
                  "apart, seed {}",
                  noise, spacing, seed),
      found, 1.0, allowed);
}

inline void expect_wedge_with_noise(Record& record, double spacing, double allowed) {
  Channel valley = v_channel(45.0, 8.0 * channel_cell);
  valley.spacing = spacing * channel_cell;
  const double found = friction_in_channel(valley, loose_rock, 1.0, 3.0, noise_and_filter(0.2 * channel_cell, 3));
  record.expect_near(
      fmt::format(
          "apparent friction over exact, V of 90 degrees, 8 cells wide, noise 0.2 cells rms, points {} cells apart",
          spacing),
      found / std::sqrt(2.0), 1.0, allowed);
}

}  // namespace thawslide::verification::rough_dem
