// A step allocates nothing once its rooms have grown.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "../support/case_from_text.hpp"
#include "base/parallel.hpp"
#include "sim/simulation.hpp"

#ifndef __SANITIZE_ADDRESS__  // which counts allocations itself

namespace {

std::atomic<long> allocations{0};

void* allocate(std::size_t bytes, std::size_t boundary) {
  ++allocations;
  void* place = std::aligned_alloc(boundary, (bytes + boundary - 1) / boundary * boundary);
  if (place == nullptr) {
    throw std::bad_alloc();
  }
  return place;
}

}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t boundary) {
  return allocate(bytes, static_cast<std::size_t>(boundary));
}
void operator delete(void* place) noexcept { std::free(place); }
void operator delete(void* place, std::size_t /*bytes*/) noexcept { std::free(place); }
void operator delete(void* place, std::align_val_t /*boundary*/) noexcept { std::free(place); }
void operator delete(void* place, std::size_t /*bytes*/, std::align_val_t /*boundary*/) noexcept { std::free(place); }

namespace thawslide::sim {
namespace {

// A melted body on a slope, with every mechanism, at rest in its tiles.
template <int Dim>
long allocations_of_steps() {
  const auto at = [](double x, double z) {
    return Dim == 2 ? fmt::format("[{}, {}]", x, z) : fmt::format("[{}, {}, {}]", x, z > 0.0 ? 9.0 : 1.0, z);
  };
  const auto parameters = testing_support::case_from_text(
      fmt::format(R"(
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
type = "flat"
elevation = 0.0
[material.debris]
law = "mohr_coulomb"
youngs_modulus = 2e8
poisson_ratio = 0.3
friction_angle = 35.0
cohesion = 5e3
hydraulic_conductivity = 1e-9
[body.slab]
material = "debris"
min = {}
max = {}
temperature = 0.5
porosity = 0.375
[basal]
friction = "lubricated"
friction_angle = 25.0
[band]
thickness = 0.1
)",
                  Dim, Dim == 2 ? "[-4.0, -4.0]" : "[-4.0, -4.0, -4.0]",
                  Dim == 2 ? "[40.0, 20.0]" : "[40.0, 14.0, 20.0]", at(1.0, 0.0), at(21.0, 6.0)));
  Simulation<Dim, double> simulation(parameters);
  simulation.set_sorting_interval(5);
  for (int k = 0; k < 20; ++k) {
    simulation.step(0.002);
  }
  const long before = allocations;
  for (int k = 0; k < 20; ++k) {
    simulation.step(0.002);
  }
  return allocations - before;
}

TEST(Step, AllocatesNothingInThePlane) {
  EXPECT_GT(allocations, 0);
  EXPECT_EQ(allocations_of_steps<2>(), 0);
}
TEST(Step, AllocatesNothingInSpace) { EXPECT_EQ(allocations_of_steps<3>(), 0); }

}  // namespace
}  // namespace thawslide::sim

#endif
