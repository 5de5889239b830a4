// Pressure of a block at rest on the ground, and the angle at which it starts to slide.
#include "../exact/motion.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

const Sets resting{"time.end=2; time.step=0.002; grid.min=[0,-10]; grid.max=[40,40]; grid.boundary.x_min=roller",
                   "grid.boundary.x_max=roller; material.rock.viscosity_time=0; basal.friction_angle=30",
                   "pressure.enabled=true"};

struct Pressing {
  double unevenness = 0.0;  // maximum relative difference of nodal pressure from weight over area
  double ringing = 0.0;     // maximum relative difference of the total force from the weight
};

Pressing press(const Sets& sets) {
  Simulation<2> simulation(published_case("block", resting + sets));
  simulation.settle();
  const double weight = simulation.sum_over_body().mass * gravity;
  const double mean = weight / 40.0;
  Pressing seen;
  while (simulation.time() < 2.0 - 1e-9) {
    simulation.step(simulation.next_step(2.0));
    seen.ringing = std::max(seen.ringing, std::abs(-simulation.contact().force[1] / weight - 1.0));
    for_contacts(simulation, [&](double pressure, double) {
      seen.unevenness = std::max(seen.unevenness, std::abs(pressure / mean - 1.0));
    });
  }
  return seen;
}

TEST(RestingBlock, PressureIsUniform) {
  if (!Simulation<2>(published_case("block", resting)).device_name().empty()) {
    GTEST_SKIP() << "it looks at nodes, which a device keeps";
  }
  Record record("Force of a resting block", "A block of 20 m between smooth walls, with geostatic stress at t = 0.",
                "its weight, spread evenly over the base", "statics");
  for (const double cell : {5.0, 2.5, 1.25}) {
    const Pressing seen = press(fmt::format("grid.cell={}; time.step={}", cell, 1e-3 * cell));
    record.expect_near(fmt::format("cells of {} m: unevenness of the base pressure", cell), seen.unevenness, 0.0,
                       1e-12);
    record.expect_near(fmt::format("cells of {} m: change of the total force in 2 s", cell), seen.ringing, 0.0, 1e-12);
  }
  const Pressing settled =
      press("mechanics.initial_stress=settle; mechanics.settle_time=6; mechanics.settle_damping=8");
  record.expect_near("settled: unevenness of the base pressure", settled.unevenness, 0.0, 1e-3);
  record.expect_near("settled: change of the total force in 2 s", settled.ringing, 0.0, 1e-3);
}

const Sets sweep{"time.end=2; time.step=0.0015; grid.max=[100,40]; material.rock.youngs_modulus=5e9",
                 "material.rock.poisson_ratio=0; material.rock.viscosity_time=0.005; body.block.max=[40,10]",
                 "mechanics.slope_shear=true; pressure.enabled=true"};

TEST(AngleSweep, SticksBelowAndSlidesAboveTheFrictionAngle) {
  Record record("Slopes near the friction angle", "A block at rest on slopes near its friction angle of 20 degrees.",
                "a = g (sin - mu cos) above it, none below", "Coulomb friction");
  Curve curve{"slope [degrees]", "acceleration [m/s2]", {}, {}, {}};
  for (const double slope : {15.0, 18.0, 19.0, 19.9, 20.1, 21.0, 22.0, 25.0, 30.0}) {
    Simulation<2> simulation(published_case("block", sweep + fmt::format("case.gravity_tilt={}", slope)));
    run_until(simulation, 1.0);  // after the elastic transient at the start
    const double before = history_value(simulation, "mean_velocity_m_s");
    run_until(simulation, 2.0);
    const double acceleration = history_value(simulation, "mean_velocity_m_s") - before;
    const double exact = physics::exact::acceleration_on_plane(slope * degree, std::tan(20.0 * degree), 9.81);
    add_point(curve, slope, acceleration, exact);
    record.expect_near(fmt::format("acceleration on {} degrees [m/s2]", slope), acceleration, exact,
                       1e-3 * exact + 1e-6);
  }
  record.draw(curve);
}

}  // namespace
}  // namespace thawslide::verification
