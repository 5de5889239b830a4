// Runs on cells that follow the ground: bitwise identical for any number of threads and after a restart, and particles
// of a body have its exact volume.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "../support/channel_on_dem.hpp"
#include "../support/fields.hpp"
#include "../support/following_plane.hpp"
#include "base/parallel.hpp"
#include "io/checkpoint.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// State after some steps. stop: time step before which the run stops and resumes from its checkpoint; -1: no stop.
template <int Dim, class Make>
std::map<std::string, std::vector<double>> state_after(const Make& make, int steps, int threads, int interval,
                                                       int stop) {
  const int threads_before = thread_count();
  set_thread_count(threads);
  std::unique_ptr<Simulation<Dim>> simulation = make();
  simulation->set_sorting_interval(interval);
  for (int k = 0; k < steps; ++k) {
    if (k == stop) {
      const auto folder = folder_of_this_test();
      io::write_checkpoint<Dim>(folder, simulation->particles(), simulation->particles_at_start(),
                                simulation->scalars());
      simulation = make();
      simulation->set_sorting_interval(interval);
      std::vector<double> scalars;
      io::read_checkpoint<Dim>(io::newest_checkpoint(folder), simulation->particles(), scalars);
      simulation->restore(scalars);
    }
    simulation->step(simulation->next_step(100.0));
  }
  (void)simulation->next_step(100.0);  // locates the particles
  auto state = state_of(*simulation);
  set_thread_count(threads_before);
  return state;
}

template <int Dim, class Make>
void expect_the_same_bits(const Make& make, int steps) {
  const auto first = state_after<Dim>(make, steps, 1, 0, -1);
  for (const auto& [threads, interval, stop] :
       {std::tuple(2, 7, -1), std::tuple(3, 1, steps / 2), std::tuple(4, 3, steps - 1)}) {
    expect_the_same_state(first, state_after<Dim>(make, steps, threads, interval, stop),
                          fmt::format("{} threads, sorted every {} steps, stopped at {}", threads, interval, stop));
  }
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
