// Thermal pressurization of a slipping plane with material on one side: friction, heat, pore pressure and both
// diffusions together, on a slab driven over sealed ground.
#include "../exact/water.hpp"
#include "physics/pressurization.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

// Poisson's ratio 0 keeps the slab one-dimensional. Mechanical cells are 1e4 times those of heat and pressure, so that
// the slab slips by a small part of a cell. The frame moves all nodes except those of the base; weak gravity keeps
// temperatures and elastic shear small.
const Sets slab{"case.gravity=1e-4; time.end=1; grid.min=[-400,-200]; grid.max=[800,1400]; phases.rock_expansion=0",
                "material.rock.youngs_modulus=5e8; material.rock.poisson_ratio=0; material.rock.viscosity_time=0.01",
                "material.rock.hydraulic_conductivity=1e-9; body.slab.temperature=1; body.slab.velocity=[1,0]",
                "frame.driver.min=[-400,0.1]; frame.driver.max=[800,1400]; frame.driver.axis=x",
                "frame.driver.velocity=1; basal.friction=constant; heat.advection=false",
                "basal.friction_angle=11.30993247402"};  // mu 0.2

// Slips by a metre on cells of a given size; returns the rms error of the strength from 0.5 to 1 m, relative to the
// initial strength.
double error_on(double cell, const Sets& sets, Curve* curve) {
  const Sets of_cell = fmt::format("grid.cell={}; time.step={}; band.thickness={}; body.slab.max=[{},1000]", cell,
                                   4e-7 * cell * cell, 1e-4 * cell, 8.0 * cell);
  Simulation<2> simulation(published_case("slab", slab + sets + of_cell));
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
      add_point(*curve, slip, strength, exact);
    }
  }
  return root_mean_square(differences);
}

const std::vector<double> sizes{10.0, 5.0, 2.5};  // cells over 1e4 [mm]

// Errors on cells of these sizes; plots the strength on the middle one.
std::vector<double> errors_on_cells(Record& record, const Sets& sets) {
  return errors_with_curve(record, sizes, 5.0, {"slip [m]", "strength over that at the start", {}, {}, {}},
                           [&](double size, Curve* curve) { return error_on(10.0 * size, sets, curve); });
}

TEST(SlipOnPlane, StrengthAgreesWithRice) {
  Record record("Slip on a plane with thermal pressurization",
                "A melted slab driven at 1 m/s over a sealed base; pore water diffuses into it, the heat stays in the "
                "first cells.",
                "tau/tau0 = exp(d/L) erfc(sqrt(d/L)), L one-sided, without conduction",
                "Rice 2006, Eq. 9, with a quarter of his length");
  const std::vector<double> errors = errors_on_cells(record, "heat.conduction=false");
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
  const std::vector<double> errors =
      errors_on_cells(record, "phases.rock_conductivity=300; phases.water_conductivity=300");
  record.expect_order_at_least("cell over 1e4 [mm]", sizes, "rms error of tau/tau0, 0.5 to 1 m", errors, 1.0, 0.1);
  record.explain(
      "Order 1 is what remains when the cells are much smaller than the layer of heat; here they are about as large, "
      "and the error falls faster. Near the end the base opens for single steps, which scatters the ratio of forces. "
      "Under the weak gravity, 1e-4 m/s2, a clearance of 1e-10 m is the fall of a whole step.");
  record.expect_near("rms error of tau/tau0 on the finest cells", errors.back(), 0.0, 1e-3);
}

}  // namespace
}  // namespace thawslide::verification
