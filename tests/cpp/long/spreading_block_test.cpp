// A cohesionless block that spreads over level ground at two elevations, and on planes.
#include "../support/following_plane.hpp"
#include "../verification/verification.hpp"

namespace thawslide::verification {
namespace {

const Variant block{
    "block",
    "time.end=16; time.step=0.09; grid.cell=20; grid.min=[-1000,-40]; grid.max=[1000,160]; "
    "material.rock.law=mohr_coulomb; material.rock.youngs_modulus=5e7; material.rock.friction_angle=35; "
    "material.rock.cohesion=0; material.rock.viscosity_time=0.004; body.block.shape=polygon; "
    "body.block.temperature=-5; body.block.porosity=0.3; basal.friction=coefficient; basal.friction_angle=; "
    "basal.friction_coefficient=0.02; "
    "mechanisms.pressurization=true"};

// Standard deviation of the mass along x after 16 s [m]. The ground lies `above` of a cell above a grid line.
double spread(double cell, double above) {
  const double ground = above * cell, top = ground + 40.0;
  Simulation<2> simulation(case_from_text(
      block, {fmt::format("grid.cell={}", cell), fmt::format("time.step={}", 4.5e-3 * cell),
              fmt::format("terrain.elevation={}", ground),
              fmt::format("body.block.vertices=[[-100.0,{0}],[100.0,{0}],[100.0,{1}],[-100.0,{1}]]", ground, top)}));
  run_until(simulation, 16.0);
  return mass_spread(simulation);
}

TEST(SpreadingBlock, SpreadingIsIndependentOfTheCellSize) {
  Record record(
      "Loose block that spreads over level ground",
      "A block of 200 m x 40 m without cohesion on a base with the friction coefficient 0.02. The ground is at an "
      "elevation of 0, or of a tenth of a cell.",
      "standard deviation of the mass along x after 16 s, that of cells of 5 m", "refinement of the cell");
  const double finest = spread(5.0, 0.0);
  record.expect_near("cells of 20 m over 5 m", spread(20.0, 0.0) / finest, 1.0, 0.02);
  record.expect_near("cells of 10 m over 5 m", spread(10.0, 0.0) / finest, 1.0, 0.005);
  record.expect_near("cells of 20 m over 5 m, ground at a tenth of a cell", spread(20.0, 0.1) / finest, 1.0, 0.02);
  record.expect_near("cells of 10 m over 5 m, ground at a tenth of a cell", spread(10.0, 0.1) / finest, 1.0, 0.005);
}

TEST(SpreadingBlock, SpreadsOnPlanesAsOnLevelGround) {
  Record record(
      "Cells that follow the ground: loose block that spreads on a plane, cells of 5 m",
      "A block of 200 m x 40 m without cohesion on a base with the friction coefficient 0.02. Gravity is "
      "normal to the plane.",
      "standard deviation of the mass along the plane after 16 s: 115.8 m, the limit on fine cells whose grid "
      "line is the ground",
      "refinement of the cell");
  for (const double degrees : {0.0, 10.0, 20.0, 30.0, 40.0}) {
    const Spread found = spread_of_block({degrees}, 5.0);
    const std::string plane = fmt::format(", plane of {} degrees", degrees);
    record.expect_near("spread over exact" + plane, found.along / 115.8, 1.0, 0.01);
    record.expect_near("growth of the volume" + plane, found.growth, 0.0, 0.03);
  }
}

}  // namespace
}  // namespace thawslide::verification
