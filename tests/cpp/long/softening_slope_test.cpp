// Failure of a slope of cohesive rock along internal shear bands, on cells of 20, 10 and 5 m.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../support/base_cases.hpp"
#include "../support/record.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::verification {
namespace {

using namespace testing_support;
using sim::Simulation;

const Variant slope{
    "block",
    "time.end=50; time.step=0.012; grid.cell=20; grid.min=[0,-80]; grid.max=[2000,400]; grid.boundary.x_min=roller; "
    "material.rock.law=mohr_coulomb; material.rock.youngs_modulus=1e9; material.rock.friction_angle=20; "
    "material.rock.cohesion=1.6e5; material.rock.residual_cohesion=2e4; material.rock.viscosity_time=0.0035; "
    "body.block.shape=polygon; body.block.vertices=[[0,0],[800,0],[600,200],[0,200]]; body.block.temperature=-5; "
    "body.block.porosity=0.3; mechanisms.pressurization=true"};

struct Failure {
  double displacement, front, dissipated;  // [m], [m], [J]
};

Failure fail(double cell, const std::string& softening) {
  Simulation<2> simulation(
      case_from_text(slope, {fmt::format("grid.cell={}", cell), fmt::format("time.step={}", 6e-4 * cell), softening}));
  run_until(simulation, 50.0);
  const auto row = history_row(simulation);
  EXPECT_LT(value_of(row, "mean_velocity_m_s"), 0.1) << "the slope has come to rest";
  return {value_of(row, "mean_displacement_m"), value_of(row, "front_position_m"),
          value_of(row, "plastic_J") + value_of(row, "viscous_J") + value_of(row, "friction_work_J")};
}

TEST(SofteningSlope, DissipationIsIndependentOfTheCellSize) {
  Record record("Slope that softens over a slip",
                "A rock slope of 45 degrees, 200 m high, fails along shear bands a cell wide. The cohesion falls from "
                "160 to 20 kPa over a slip of 4 m. Dissipated: plastic, viscous and basal friction work.",
                "the same on cells of 20, 10 and 5 m", "refinement of the cell");
  const std::string per_slip = "material.rock.softening_slip=4.0";
  const Failure coarse = fail(20.0, per_slip), middle = fail(10.0, per_slip), fine = fail(5.0, per_slip);
  record.expect_near("mean displacement, cells of 20 m over 10 m", coarse.displacement / middle.displacement, 1.0,
                     0.05);
  record.expect_near("mean displacement, cells of 5 m over 10 m", fine.displacement / middle.displacement, 1.0, 0.05);
  record.expect_near("front, cells of 20 m over 10 m", coarse.front / middle.front, 1.0, 0.05);
  record.expect_near("front, cells of 5 m over 10 m", fine.front / middle.front, 1.0, 0.05);
  record.expect_near("dissipated, cells of 5 m over 10 m", fine.dissipated / middle.dissipated, 1.0, 0.05);
  const double lost = 1.0 - coarse.dissipated / middle.dissipated;
  EXPECT_LT(std::abs(1.0 - fine.dissipated / middle.dissipated), 0.5 * std::abs(lost)) << "it converges";
  record.explain(fmt::format(
      "On cells of 20 m, ten across the height of the slope, {:.1f} % less is dissipated than on 10 m.", 100.0 * lost));
  // Softening strain equivalent to this slip on cells of 20 m.
  const std::string per_strain = "material.rock.softening_strain=0.11547";
  const double of_strain = fail(10.0, per_strain).dissipated / coarse.dissipated;
  EXPECT_GT(of_strain, 1.08) << "half of the slip breaks cells of half the size";
}

}  // namespace
}  // namespace thawslide::verification
