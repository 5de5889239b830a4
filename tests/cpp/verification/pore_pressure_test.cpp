// Pore pressure of melted material: undrained heating, diffusion to a drained top, and slip on a plane.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

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

// A melted column one cell wide and 1 m high, without weight.
const std::string column = R"(
[case]
gravity = 0.0
[time]
end = 700.0
step = 4.0
[grid]
cell = 0.1
min = [0.0, 0.0]
max = [1.0, 2.0]
[material.soil]
law = "elastic"
[body.column]
material = "soil"
min = [0.0, 0.0]
max = [0.1, 1.0]
temperature = 1.0
[mechanics]
enabled = false
)";

std::vector<std::string> on_cells(double cell) {
  return {fmt::format("grid.cell={}", cell), fmt::format("body.column.max=[{},1.0]", cell)};
}

TEST(UndrainedHeating, FollowsLambda) {
  Record record("Undrained heating",
                "A melted bar heated at its end; the rock's expansion is a hundred times larger than real, so that the "
                "porosity falls as it warms.",
                "P - P0 = K_L {beta_S I + (beta_L - beta_S)(T - T0)}, I = integral of dT/n",
                "Eqs. 6 and 8, integrated");
  const std::vector<double> steps{8.0, 4.0, 2.0, 1.0};
  std::vector<double> errors;
  for (const double dt : steps) {
    Simulation<2> simulation(
        paper_case(column, {"phases.rock_expansion=3e-3", "pressure.seepage=false", "time.end=8000.0",
                            "heat.boundary.y_min={flux=400.0}", fmt::format("time.step={}", dt)}));
    run_until(simulation, 8000.0);
    const auto& particles = simulation.particles();
    const auto& phases = simulation.model().motion.phases;
    double worst = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double expected =
          physics::exact::undrained_pressure_rise(particles.temperature(p) - 1.0, 0.375, phases.water_bulk_modulus,
                                                  phases.rock_expansion, phases.water_expansion);
      worst = std::max(worst, std::abs(particles.liquid_pressure(p) - expected) / 1e6);
    }
    errors.push_back(worst);
  }
  record.expect_order("step [s]", steps, "largest error of pressure [MPa]", errors, 1.0, 0.05);
}

TEST(Consolidation, OfAMeltedColumn) {
  Record record("Diffusion of pore pressure", "A melted column at 1 MPa, drained at its top, on a sealed base.",
                "sum of sin(M z/H) exp(-M^2 D t/H^2)", "Terzaghi 1943");
  const std::vector<double> cells{0.2, 0.1, 0.05, 0.025};
  std::vector<double> errors;
  Curve curve{"depth below the top [m]", "pressure [MPa]", {}, {}, {}};
  for (const double cell : cells) {
    auto sets = on_cells(cell);
    sets.push_back("material.soil.hydraulic_conductivity=1e-9");
    sets.push_back(fmt::format("time.step={}", 4.0 * cell * cell / 0.01));
    Simulation<2> simulation(paper_case(column, sets));
    auto& at_start = simulation.particles();
    for (std::size_t p = 0; p < at_start.size(); ++p) {
      at_start.liquid_pressure(p) = at_start.pore_pressure(p) = 1e6;
    }
    run_until(simulation, 700.0);
    const auto& particles = std::as_const(simulation).particles();  // reread: a device may have modified them
    const double diffusivity = physics::hydraulic_diffusivity(simulation.model().motion.phases, 0.375, 1.0, 1e-9);
    std::vector<double> differences;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double depth = 1.0 - particles.position(p, 1);
      const double exact = physics::exact::consolidation_pressure(depth, 1.0, diffusivity, 700.0);
      differences.push_back(particles.pore_pressure(p) / 1e6 - exact);
      if (cell == 0.1 && particles.position(p, 0) < 0.5 * cell) {
        curve.x.push_back(depth);
        curve.computed.push_back(particles.pore_pressure(p) / 1e6);
        curve.exact.push_back(exact);
      }
    }
    errors.push_back(root_mean_square(differences));
  }
  record.draw(curve);
  record.expect_order("cell [m]", cells, "rms error of pressure [MPa]", errors, 1.0, 0.1);
  record.explain(
      "The pressure of the free surface acts on all particles in the upper half of the top cell. The drained boundary "
      "is therefore a fraction of a cell below the top. The manufactured field above, without this effect, is of order "
      "2.");
}

}  // namespace
}  // namespace thawslide::verification
