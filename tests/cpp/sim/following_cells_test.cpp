// Runs on cells that follow the ground: bitwise identical for any number of threads and after a restart, and particles
// of a body have its exact volume.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/channel_on_dem.hpp"
#include "../support/following_plane.hpp"
#include "../support/reproducible_runs.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

template <int Dim, class Make>
void expect_the_same_bits(const Make& make, int steps) {
  expect_reproducible_run<Dim>(make, steps, {{2, 7, -1}, {3, 1, steps / 2}, {4, 3, steps - 1}},
                               [](const Simulation<Dim>& /*simulation*/, int /*step*/) {});
}

TEST(FollowingCells, ResultsAreReproducibleInThePlane) {
  const Incline plane{30.0};
  const auto make = [&] {
    return std::make_unique<Simulation<2>>(body_on_plane(
        plane, 10.0, {plane.place(-100, 0), plane.place(100, 0), plane.place(100, 40), plane.place(-100, 40)}));
  };
  expect_the_same_bits<2>(make, 60);
}

// Gully with waves along it.
double gully(double x, double y) {
  return 0.002 * y * y - 0.4 * x + 3.0 * std::sin(0.1 * x) + 2.0 * std::sin(0.13 * y);
}

std::unique_ptr<Simulation<3>> slide_in_gully() {
  const Place half(200.0, 200.0);
  const auto slide =
      release_on_dem({20.0, 0.01, 10.0, {-200.0, -200.0, -200.0}, {200.0, 200.0, 300.0}}, loose_rock, 20.0);
  const Raster ground = raster_between(-half, half, 4.0, gully);
  const Raster thickness = thickness_between(-half, half, 5.0, [](double x, double y) {
    return std::max(0.0, 30.0 * (1.0 - std::pow((x + 50.0) / 60.0, 2) - std::pow(y / 60.0, 2)));
  });
  return std::make_unique<Simulation<3>>(case_on_dem(slide, "grid.follows_terrain=true; time.stepping=adaptive"),
                                         site_of(ground, thickness));
}

TEST(FollowingCells, ResultsAreReproducibleInSpace) { expect_the_same_bits<3>(slide_in_gully, 30); }

// Inclined ends are cut into columns, whose particles are then scaled.
TEST(FollowingCells, BodiesHaveTheirExactVolume) {
  const Incline plane{25.0};
  const Simulation<2> block(
      body_on_plane(plane, 10.0, {plane.place(-83, 0), plane.place(71, 0), plane.place(71, 33), plane.place(-83, 33)}));
  const auto& particles = block.particles();
  double area = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    area += particles.volume(p);
  }
  EXPECT_NEAR(area, 154.0 * 33.0, 1e-9 * area);
}

}  // namespace
}  // namespace thawslide::sim
