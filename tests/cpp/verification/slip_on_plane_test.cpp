// Thermal pressurization of a slipping plane with matter on one side: friction, heat, pore pressure and both
// diffusions together, on a slab driven over sealed ground.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/case_from_text.hpp"
#include "base/portability.hpp"
#include "physics/exact/pore_water.hpp"
#include "physics/pressurization.hpp"
#include "record.hpp"
#include "sim/simulation.hpp"

namespace thawslide::verification {
namespace {

using namespace testing_support;
using sim::Simulation;

// Poisson's ratio 0 keeps the slab one-dimensional. Cells are 1000 times what heat and pressure see. The frame moves
// all nodes but those of the base; weak gravity keeps temperatures low, and the porosity with them.
const std::string slab = R"(
[case]
gravity = 0.981
[time]
end = 1.0
step = 0.01
[grid]
cell = 10.0
min = [-50.0, -20.0]
max = [250.0, 200.0]
[terrain]
type = "flat"
elevation = 0.0
[material.rock]
law = "elastic"
youngs_modulus = 5e8
poisson_ratio = 0.0
viscosity_time = 0.01
hydraulic_conductivity = 1e-9
[body.slab]
material = "rock"
min = [0.0, 0.0]
max = [40.0, 160.0]
temperature = 1e-9
velocity = [1.0, 0.0]
[frame.driver]
min = [-50.0, 0.1]
max = [250.0, 200.0]
axis = "x"
velocity = 1.0
[basal]
friction = "constant"
friction_angle = 11.30993247402  # mu 0.2
[heat]
advection = false
)";

TEST(SlipOnPlane, LosesStrengthAsRiceSays) {
  Record record("Slip on a plane with thermal pressurization",
                "A melted slab driven at 1 m/s over a sealed, insulated base; heat and pore water diffuse into it.",
                "tau/tau0 = exp(d/L) erfc(sqrt(d/L)), L one-sided", "Rice 2006, Eq. 9, with a quarter of his length");
  const std::vector<double> cells{20.0, 10.0, 5.0, 2.5};
  std::vector<double> errors;
  Curve curve{"slip [m]", "strength over that at the start", {}, {}, {}};
  for (const double cell : cells) {
    Simulation<2, double> simulation(case_from_text(
        slab, {fmt::format("grid.cell={}", cell), fmt::format("time.step={}", 2.5e-5 * cell * cell),
               fmt::format("band.thickness={}", 1e-3 * cell), fmt::format("body.slab.max=[{},160.0]", 4.0 * cell)}));
    auto& particles = simulation.particles();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      particles.liquid_pressure(p) = particles.pore_pressure(p) = 0.0;
    }
    const auto& phases = simulation.model().motion.phases;
    const double length = physics::exact::one_sided_slip_length(
        physics::heat_capacity(phases, 0.375, 1.0), physics::undrained_pressure_coefficient(phases, 0.375, 1.0),
        physics::hydraulic_diffusivity(phases, 0.375, 1.0, 1e-9),
        physics::conductivity(phases, 0.375, 1.0) / physics::heat_capacity(phases, 0.375, 1.0), 0.2, 1.0);
    std::vector<double> differences;
    while (simulation.time() < 1.0 - 1e-9) {
      const double middle = simulation.time();
      simulation.step(simulation.next_step(1.0));
      const auto& force = simulation.contact().force;
      const double strength = -force[0] / (0.2 * force[1]);
      const double exact = physics::exact::strength_on_plane(middle, length);
      if (middle > 0.5) {
        differences.push_back(std::abs(strength) - exact);
      }
      if (cell == 5.0) {
        curve.x.push_back(middle);
        curve.computed.push_back(std::abs(strength));
        curve.exact.push_back(exact);
      }
    }
    errors.push_back(root_mean_square(differences));
  }
  record.draw(curve);
  record.expect_order("cell over 1000 [mm]", cells, "rms error of tau/tau0, 0.5 to 1 m", errors, 1.0, 0.9);
}

}  // namespace
}  // namespace thawslide::verification
