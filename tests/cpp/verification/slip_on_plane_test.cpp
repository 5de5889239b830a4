// Thermal pressurization of a slipping plane with material on one side: friction, heat, pore pressure and both
// diffusions together, on a slab driven over sealed ground.
#include <gtest/gtest.h>

#include <cmath>

#include "../exact/pore_water.hpp"
#include "../support/case_from_text.hpp"
#include "../support/record.hpp"
#include "base/portability.hpp"
#include "physics/pressurization.hpp"
#include "sim/simulation.hpp"

namespace thawslide::verification {
namespace {

using namespace testing_support;
using sim::Simulation;

// Poisson's ratio 0 keeps the slab one-dimensional. Mechanical cells are 1e4 times those of heat and pressure, so that
// the slab slips by a small part of a cell. The frame moves all nodes except those of the base; weak gravity keeps
// temperatures and elastic shear small.
const std::string slab = R"(
[case]
gravity = 1e-4
[time]
end = 1.0
step = 0.001
[grid]
cell = 100.0
min = [-400.0, -200.0]
max = [800.0, 1400.0]
[terrain]
type = "flat"
elevation = 0.0
[phases]
rock_expansion = 0.0
[material.rock]
law = "elastic"
youngs_modulus = 5e8
poisson_ratio = 0.0
viscosity_time = 0.01
hydraulic_conductivity = 1e-9
[body.slab]
material = "rock"
min = [0.0, 0.0]
max = [400.0, 1000.0]
temperature = 1.0
velocity = [1.0, 0.0]
[frame.driver]
min = [-400.0, 0.1]
max = [800.0, 1400.0]
axis = "x"
velocity = 1.0
[basal]
friction = "constant"
friction_angle = 11.30993247402  # mu 0.2
[heat]
advection = false
)";

// Slips by a metre on cells of a given size; returns the rms error of the strength from 0.5 to 1 m, relative to the
// initial strength.
double error_on(double cell, std::vector<std::string> sets, Curve* curve) {
  sets.insert(sets.end(),
              {fmt::format("grid.cell={}", cell), fmt::format("time.step={}", 4e-7 * cell * cell),
               fmt::format("band.thickness={}", 1e-4 * cell), fmt::format("body.slab.max=[{},1000.0]", 8.0 * cell)});
  Simulation<2> simulation(paper_case(slab, sets));
  auto& particles = simulation.particles();
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.liquid_pressure(p) = particles.pore_pressure(p) = 0.0;
  }
  const auto& phases = simulation.model().motion.phases;
  const double capacity = physics::heat_capacity(phases, 0.375, 1.0);
  const double diffusivity =
      simulation.model().band.conduction ? physics::conductivity(phases, 0.375, 1.0) / capacity : 0.0;
  const double length = physics::exact::one_sided_slip_length(
      capacity, physics::undrained_pressure_coefficient(phases, 0.375, 1.0),
      physics::hydraulic_diffusivity(phases, 0.375, 1.0, 1e-9), diffusivity, 0.2, 1.0);
  std::vector<double> differences;
  while (simulation.time() < 1.0 - 1e-9) {
    const double slip = simulation.time();
    simulation.step(simulation.next_step(1.0));
    const auto& force = simulation.contact().force;
    const double strength = std::abs(force[0] / (0.2 * force[1]));
    const double exact = physics::exact::strength_on_plane(slip, length);
    if (slip > 0.5) {
      differences.push_back(strength - exact);
    }
    if (curve != nullptr) {
      curve->x.push_back(slip);
      curve->computed.push_back(strength);
      curve->exact.push_back(exact);
    }
  }
  return root_mean_square(differences);
}

TEST(SlipOnPlane, LosesStrengthAsRiceSays) {
  Record record("Slip on a plane with thermal pressurization",
                "A melted slab driven at 1 m/s over a sealed base; pore water diffuses into it, the heat stays in the "
                "first cells.",
                "tau/tau0 = exp(d/L) erfc(sqrt(d/L)), L one-sided, without conduction",
                "Rice 2006, Eq. 9, with a quarter of his length");
  const std::vector<double> cells{100.0, 50.0, 25.0};
  std::vector<double> sizes, errors;
  Curve curve{"slip [m]", "strength over that at the start", {}, {}, {}};
  for (const double cell : cells) {
    sizes.push_back(0.1 * cell);
    errors.push_back(error_on(cell, {"heat.conduction=false"}, cell == 50.0 ? &curve : nullptr));
  }
  record.draw(curve);
  record.expect_order("cell over 1e4 [mm]", sizes, "rms error of tau/tau0, 0.5 to 1 m", errors, 1.0, 0.1);
  record.explain(
      "The heat is a fraction of a cell away from the plane, and the node averages the pressure over its cell: order "
      "1.");
}

TEST(SlipOnPlane, WithConduction) {
  Record record("Slip on a plane, heat and pore water diffuse",
                "The same slab with a conductivity of 300 W/m/K, which makes the layer of heat as thick as some cells, "
                "as the layer of pressure is.",
                "tau/tau0 = exp(d/L) erfc(sqrt(d/L)), L one-sided", "Rice 2006, Eq. 9, with a quarter of his length");
  const std::vector<double> cells{100.0, 50.0, 25.0};
  std::vector<double> sizes, errors;
  Curve curve{"slip [m]", "strength over that at the start", {}, {}, {}};
  for (const double cell : cells) {
    sizes.push_back(0.1 * cell);
    errors.push_back(error_on(cell, {"phases.rock_conductivity=300.0", "phases.water_conductivity=300.0"},
                              cell == 50.0 ? &curve : nullptr));
  }
  record.draw(curve);
  record.expect_order_at_least("cell over 1e4 [mm]", sizes, "rms error of tau/tau0, 0.5 to 1 m", errors, 1.0, 0.1);
  record.explain(
      "Order 1 is what remains when the cells are much smaller than the layer of heat; here they are about as large, "
      "and the error falls faster. Near the end the base opens for single steps, which scatters the ratio of forces. "
      "Under the weak gravity, 1e-4 m/s2, a clearance of 1e-10 m is the fall of a whole step.");
  record.expect_near("rms error of tau/tau0 on the finest cells", errors.back(), 0.0, 1e-3);
}

}  // namespace
}  // namespace thawslide::verification
