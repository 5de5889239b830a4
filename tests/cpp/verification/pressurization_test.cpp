// Thermal pressurization of a base that slips: a slab driven over sealed ground, and a rigid block on a draining band
// that arrests or runs away depending on hydraulic conductivity, as in Goren and Aharonov (2009); their numbers are not
// compared.
#include "physics/pressurization.hpp"

#include "../exact/water.hpp"
#include "sim/block/block.hpp"
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

using physics::exact::DrainedBand;

constexpr double slope = 10.0, friction = 0.3, heat_fraction = 0.9, porosity = 0.375;
constexpr double water_expansion = 2.1e-4, rock_expansion = 1e-5;

// The band melts immediately (0.1 K, without latent heat; melt as dense as ice leaves no void). It is below material
// that remains frozen and leads to air: P = 0 at its top. There is no conduction, and the ground is impermeable. The
// pressure follows friction within several hundredths of a second, the block's speed within seconds; the band has no
// additional time to reach equilibrium.
const Sets block{"case.gravity_tilt=10; time.end=120; time.step=0.0025; time.history_interval=0.1",
                 "grid.cell=2.5; grid.min=[-100,-20]; grid.max=[2000,80]",
                 "phases.ice_density=1000; phases.water_expansion=2.1e-4; phases.rock_expansion=1e-5",
                 "phases.water_expansion_law=constant; freezing.curve=linear; freezing.slope=50",
                 "material.rock.viscosity_time=0; body.slab.max=[100,5]; body.slab.temperature=-0.1",
                 "basal.friction=constant; heat.latent=false; heat.conduction=false; heat.steam=false",
                 "band.growth=none; band.load_time=0.01; band.column_step=0.0025",
                 "pressure.frozen_rows=vented; pressure.skeleton_compressibility=0"};

struct Start {
  double speed, thickness;  // initial speed of the block [m/s], thickness of the band [m]
};

// Whether a block of this initial speed doubles its speed before it stops.
bool runs_away(const Start& start, double conductivity) {
  const Sets of_start = fmt::format(
      "material.rock.hydraulic_conductivity={:.6e}; body.slab.velocity=[{},0]; band.thickness={}; "
      "basal.friction_angle={:.12f}",
      conductivity, start.speed, start.thickness, std::atan(friction) * 180.0 / pi);
  const auto rows = sim::run_block(base_case("columns", block + of_start));
  for (const auto& row : rows) {
    const double speed = value_of(row, "velocity_m_s");
    if (speed > 2.0 * start.speed || speed <= 0.0) {
      return speed > 0.0;
    }
  }
  ADD_FAILURE() << "neither by the end, k = " << conductivity;
  return false;
}

// By bisection, within 2 %.
double boundary(const Start& start, double low, double high) {
  EXPECT_TRUE(runs_away(start, low));
  EXPECT_FALSE(runs_away(start, high));
  while (high > 1.02 * low) {
    const double middle = std::sqrt(low * high);
    (runs_away(start, middle) ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

DrainedBand band_of(double thickness) {
  const config::Phases phases;
  const double capacity = porosity * phases.water_density * phases.water_heat_capacity +
                          (1.0 - porosity) * phases.rock_density * phases.rock_heat_capacity;
  return {friction,
          porosity * water_expansion + (1.0 - porosity) * rock_expansion,
          phases.water_unit_weight,
          heat_fraction,
          thickness,
          capacity};
}

TEST(ArrestOrRunaway, IsDecidedByConductivity) {
  Record record("Arrest or runaway by permeability",
                "Rigid block on a slope of 10 degrees, friction 0.3, on a band column that drains through its top, "
                "with an initial speed; k by bisection",
                "k = A v/(mu/tan a - 1) of the steady drained band, with A = mu beta_m gamma_w eta e/(3 C). With a "
                "smaller k it runs away, with a larger k it arrests",
                "closed form; after Goren and Aharonov (2009), not compared with their numbers");
  Curve curve{"speed at the start (m/s)", "k between arrest and runaway (m/s)", {}, {}, {}};
  for (const Start& start : {Start{2.0, 0.002}, Start{4.0, 0.002}, Start{6.0, 0.002}, Start{4.0, 0.004}}) {
    const double exact = band_of(start.thickness).boundary_conductivity(start.speed, slope * degree);
    EXPECT_NEAR(band_of(start.thickness).strength(start.speed, exact), std::tan(slope * degree), 1e-12);
    const double found = boundary(start, 0.5 * exact, 2.0 * exact);
    record.expect_near(fmt::format("k over closed form, {} m/s, band of {} mm", start.speed, 1e3 * start.thickness),
                       found / exact, 1.0, 0.1);
    if (start.thickness == 0.002) {
      add_point(curve, start.speed, found, exact);
    }
  }
  record.explain("The block loses speed until the band has reached its pressure: the boundary lies a little lower.");
  record.draw(curve);
}

}  // namespace
}  // namespace thawslide::verification
