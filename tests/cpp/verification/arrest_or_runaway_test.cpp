// A block on a draining band arrests or runs away depending on the hydraulic conductivity k of the band, as in Goren
// and Aharonov (2009); their numbers are not compared.
#include "../exact/water.hpp"
#include "sim/block/block.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

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
