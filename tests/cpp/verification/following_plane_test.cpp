// Slides on planes with cells that follow the ground.
#include "../support/following_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/record.hpp"

namespace thawslide::verification {
namespace {

using namespace testing_support;
using sim::Simulation;

// Block of 200 m x 40 m on a plane, with gravity normal to it.
Spread spread_of_block(const Incline& plane, double cell) {
  Simulation<2> simulation(body_on_plane(
      plane, cell, {plane.place(-100, 0), plane.place(100, 0), plane.place(100, 40), plane.place(-100, 40)},
      {fmt::format("case.gravity_tilt={}", -plane.degrees)}));
  run_until(simulation, 16.0);
  return Spread(simulation, plane);
}

TEST(FollowingPlane, BlockSpreadsAsOnAGridLine) {
  Record record(
      "Cells that follow the ground: loose block that spreads on a plane",
      "A block of 200 m x 40 m without cohesion on a base with the friction coefficient 0.02. Gravity is "
      "normal to the plane.",
      "standard deviation of the mass along the plane after 16 s: 115.8 m, the limit on fine cells whose grid "
      "line is the ground",
      "refinement of the cell");
  for (const double degrees : {0.0, 10.0, 20.0, 30.0, 40.0}) {
    const Spread on_20 = spread_of_block({degrees}, 20.0), on_10 = spread_of_block({degrees}, 10.0);
    const std::string plane = fmt::format(", plane of {} degrees", degrees);
    record.expect_near("cells of 20 m over exact" + plane, on_20.along / 115.8, 1.0, 0.03);
    record.expect_near("cells of 10 m over exact" + plane, on_10.along / 115.8, 1.0, 0.01);
    record.expect_near("growth of the volume, cells of 20 m" + plane, on_20.growth, 0.0, 0.05);
    record.expect_near("growth of the volume, cells of 10 m" + plane, on_10.growth, 0.0, 0.03);
  }
}

// Error of the acceleration over gravity, and of pressures at single nodes over that of the overburden.
struct SlabErrors {
  double acceleration = 0.0, mean = 0.0, rms = 0.0;
};

SlabErrors errors_of_slab(const Incline& plane, double cell) {
  constexpr double gravity = 9.81, coefficient = 0.25, length = 400.0, thickness = 40.0, from = 2.0, to = 4.0;
  const double vertical = thickness / std::cos(plane.angle());
  const auto foot = plane.place(-0.5 * length, 0.0), toe = plane.place(0.5 * length, 0.0);
  const Vector<double, 2> up(0.0, vertical);
  Simulation<2> simulation(body_on_plane(
      plane, cell, {foot, toe, toe + up, foot + up},
      {"material.grains.law=elastic", "material.grains.youngs_modulus=5e8", "material.grains.viscosity_time=0.01",
       "basal.friction_coefficient=0.25", "mechanics.slope_shear=true"}));
  const auto& particles = simulation.particles();
  const auto velocity = [&] {
    double momentum = 0.0, mass = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      mass += particles.mass(p);
      momentum += particles.mass(p) * particles.velocity.get<Vector<double, 2>>(p).dot(plane.down());
    }
    return momentum / mass;
  };
  run_until(simulation, from);
  const double first = velocity(), began = simulation.time();
  run_until(simulation, to);
  const double found = (velocity() - first) / (simulation.time() - began);
  const double overburden = particles.mass(0) / particles.volume(0) * gravity * thickness * std::cos(plane.angle());
  double centre = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    centre += particles.position(p, 0) / static_cast<double>(particles.size());
  }
  SlabErrors errors;
  errors.acceleration = (found - gravity * (std::sin(plane.angle()) - coefficient * std::cos(plane.angle()))) / gravity;
  double count = 0.0;
  const auto& nodes = simulation.nodes();
  for (std::size_t b = 0; b < simulation.grid().blocks().size(); ++b) {
    for (std::size_t k = 0; nodes.contact.contains(b) && k < nodes.contact.nodes; ++k) {
      const auto& contact = nodes.contact(b, k);
      const double x = mpm::node_position(simulation.grid(), b, k)[0];
      if (contact[mpm::Contact::touching] > 0.0 && std::abs(x - centre) < 0.3 * length * std::cos(plane.angle())) {
        const double error = contact[mpm::Contact::normal_force] / contact[mpm::Contact::area] / overburden - 1.0;
        errors.mean += error;
        errors.rms += error * error;
        count += 1.0;
      }
    }
  }
  errors.mean /= count;
  errors.rms = std::sqrt(errors.rms / count);
  return errors;
}

TEST(FollowingPlane, SlabHasItsAccelerationAndPressure) {
  Record record("Cells that follow the ground: slab on a plane",
                "An elastic slab, 400 m long and 40 m thick, slides on a plane with the friction coefficient 0.25; "
                "cells of 10 m. Pressures in one time step.",
                "acceleration g (sin a - mu cos a); normal pressure of single nodes rho g h cos a", "rigid slab");
  for (const double degrees : {35.0, 48.0, 60.0}) {
    const SlabErrors errors = errors_of_slab({degrees}, 10.0);
    const std::string plane = fmt::format(", plane of {} degrees", degrees);
    record.expect_near("error of the acceleration over gravity" + plane, errors.acceleration, 0.0, 1e-4);
    record.expect_near("mean error of the pressure of nodes" + plane, errors.mean, 0.0, 0.01);
    record.expect_near("rms error of the pressure of nodes" + plane, errors.rms, 0.0, 0.05);
  }
}

}  // namespace
}  // namespace thawslide::verification
