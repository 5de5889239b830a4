// A block on an incline sticks, slides and heats correctly, in 2D and 3D, with tilted gravity and on a tilted plane.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/base_cases.hpp"
#include "../support/record.hpp"
#include "base/portability.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;
using verification::Record;
constexpr double gravity = 9.81;
double radians(double degrees) { return degrees * pi / 180.0; }

// Gravity turned by 30 degrees over flat ground: the grid's axes are the slope's.
const Variant turned_2d{
    "block",
    "case.gravity_tilt=30; time.end=2; mechanics.slope_shear=true; basal.friction_angle=15; heat.enabled=true; "
    "pressure.enabled=true"};

const Variant turned_3d =
    turned_2d +
    "case.dimension=3; time.end=1; grid.min=[-20,-20,-10]; grid.max=[100,40,30]; body.block.min=[0,0,0]; "
    "body.block.max=[20,20,10]";

// Motion of the block in the second half of the run, after the initial adjustment of its stress.
struct Slide {
  double acceleration, velocity, heat, work, mass, distance;
};

template <int Dim>
Slide slide(const Variant& variant, const Sets& sets = {}) {
  Simulation<Dim> simulation(paper_case(variant, sets));
  const double end = simulation.parameters().time.end;
  run_until(simulation, 0.5 * end);
  const auto middle = history_row(simulation);
  run_until(simulation, end);
  const auto row = history_row(simulation);
  const double v1 = value_of(middle, "mean_velocity_m_s"), v2 = value_of(row, "mean_velocity_m_s");
  return {(v2 - v1) / (0.5 * end),
          v2,
          value_of(row, "friction_heat_J") - value_of(middle, "friction_heat_J"),
          value_of(row, "friction_work_J") - value_of(middle, "friction_work_J"),
          value_of(row, "mass_kg"),
          value_of(row, "mean_displacement_m") - value_of(middle, "mean_displacement_m")};
}

void expect_slide(const std::string& title, const Slide& seen, double friction_angle, double tolerance) {
  Record record("Block on an incline: " + title, "A block slides down 30 degrees, friction angle 15 degrees.",
                "a = g (sin - mu cos), work of friction = mu m g cos times the displacement", "Coulomb friction");
  const double mu = std::tan(radians(friction_angle));
  const double expected = gravity * (std::sin(radians(30.0)) - mu * std::cos(radians(30.0)));
  record.expect_near("acceleration over exact", seen.acceleration / expected, 1.0, tolerance);
  // Heat = mu m g cos(theta) times the travel distance.
  const double work = mu * seen.mass * gravity * std::cos(radians(30.0)) * seen.distance;
  record.expect_near("work over exact", seen.work / work, 1.0, tolerance);
}

TEST(Incline, SlidesAndHeatsOnTurnedGravity) {
  const Slide seen = slide<2>(turned_2d);
  expect_slide("gravity turned, 2D", seen, 15.0, 2e-3);
  EXPECT_NEAR(seen.heat / seen.work, 1.0, 1e-12);
}

TEST(Incline, PartOfTheWorkIsConverted) {
  const Slide seen = slide<2>(turned_2d, {"basal.heat_fraction=0.35"});
  expect_slide("a part of the work heats", seen, 15.0, 2e-3);
  EXPECT_NEAR(seen.heat / seen.work, 0.35, 1e-12);
}

TEST(Incline, CohesionHoldsOrBrakes) {
  // Driving stress rho g H sin: 2750 x 0.625 + 917 x 0.375 = 2062.6 kg/m3, 20 m: 202 kPa; friction at 15 degrees
  // reduces it by 94.
  Record record("Block on an incline: with cohesion",
                "The same block of 20 m with a cohesion of 0.04 MPa, which brakes it, and of 0.2 MPa, which holds it.",
                "a = g (sin - mu cos) - c A/m; at rest where that is not above 0", "Coulomb friction with cohesion");
  record.expect_near("velocity with 0.2 MPa [m/s]",
                     slide<2>(turned_2d, {"basal.cohesion=2e5", "basal.cohesion_law=constant"}).velocity, 0.0, 2e-3);
  const Slide slow = slide<2>(turned_2d, {"basal.cohesion=4e4", "basal.cohesion_law=constant"});
  const double mu = std::tan(radians(15.0));
  const double expected = gravity * (0.5 - mu * std::cos(radians(30.0))) - 4e4 * 40.0 / slow.mass;
  record.expect_near("acceleration with 0.04 MPa over exact", slow.acceleration / expected, 1.0, 2e-2);
}

TEST(Incline, QuadraticShapeFunctionsSlideAsWell) {
  expect_slide("quadratic shape functions", slide<2>(turned_2d, {"mechanics.shape_function=quadratic"}), 15.0, 2e-2);
}

TEST(Incline, SlidesAndHeatsInThreeDimensions) {
  const Slide seen = slide<3>(turned_3d);
  expect_slide("gravity turned, 3D", seen, 15.0, 5e-3);
  EXPECT_NEAR(seen.heat / seen.work, 1.0, 1e-12);
}

TEST(Incline, SticksInThreeDimensions) { EXPECT_LT(slide<3>(turned_3d, {"basal.friction_angle=40.0"}).velocity, 5e-3); }

// A plane that falls by 30 degrees through the grid, gravity upright: the body is a parallelogram on it.
TEST(Incline, SlidesOnATiltedPlane) {
  const Variant plane =
      turned_2d +
      "case.gravity_tilt=0; terrain.type=plane; terrain.slope=30; grid.min=[-20,-150]; body.block.shape=polygon; "
      "body.block.vertices=[[0.0, 0.0], [60.0, -34.641], [60.0, -11.547], [0.0, 23.094]]";
  expect_slide("plane through the grid, 2D", slide<2>(plane), 15.0, 2e-2);
  EXPECT_LT(slide<2>(plane, "basal.friction_angle=40; time.end=4").velocity, 0.05);
}

// In 3D, bodies are boxes: successive boxes of 2.5 m, each lower than the previous one, follow the plane.
Variant stairs() {
  Variant plane =
      turned_3d +
      "case.gravity_tilt=0; terrain.type=plane; terrain.slope=30; grid.min=[-20,-20,-80]; body.block.max=[2.5,20,10]";
  for (int k = 1; k < 8; ++k) {
    const double x = 2.5 * k, z = -x * std::tan(radians(30.0));
    plane = plane + fmt::format(
                        "body.stair_{0}.material=rock; body.stair_{0}.min=[{1}, 0.0, {2}]; "
                        "body.stair_{0}.max=[{3}, 20.0, {4}]",
                        k, x, z, x + 2.5, z + 10.0);
  }
  return plane;
}

TEST(Incline, SlidesOnATiltedPlaneInThreeDimensions) {
  expect_slide("plane through the grid, 3D", slide<3>(stairs()), 15.0, 2e-2);
}

TEST(FreeFall, KeepsMomentumToRoundOff) {
  const Sets thrown =
      "case.gravity=9.81; time.step=0.001; grid.cell=5; grid.min=[0,-100]; grid.max=[60,100]; "
      "material.rock.youngs_modulus=5e8; material.rock.poisson_ratio=0.2; body.block.min=[10,20]; "
      "body.block.max=[40,50]; body.block.velocity=[3,0]; heat.enabled=true; pressure.enabled=true";
  Simulation<2> simulation(published_case("free", thrown));
  run_until(simulation, 1.0);
  const auto row = history_row(simulation);
  double vx = 0.0, vy = 0.0;
  for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
    vx += simulation.particles().velocity(p, 0);
    vy += simulation.particles().velocity(p, 1);
  }
  const auto count = static_cast<double>(simulation.particles().size());
  Record record("Free fall", "A body thrown at 3 m/s falls for 1 s.", "d(sum p)/dt = m g; its energy is kept",
                "Newton's second law");
  record.expect_near("horizontal velocity [m/s]", vx / count, 3.0, 1e-10);
  record.expect_near("vertical velocity [m/s]", vy / count, -gravity, 1e-10);
  // Every position is on the parabola: the midpoint rule of the step is exact for it.
  record.expect_near("residual of the energy budget, over the kinetic energy",
                     value_of(row, "mechanical_residual_J") / value_of(row, "kinetic_J"), 0.0, 1e-11);
}

}  // namespace
}  // namespace thawslide::sim
