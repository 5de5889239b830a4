// Volumes, thicknesses and support of bodies, compared with sums by hand.
#include "sim/checks/body_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../support/base_cases.hpp"
#include "../support/messages.hpp"
#include "sim/checks/body_warnings.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// A body with a step on level ground at 1 m: 8 m x 4 m next to 4 m x 2 m, as one polygon.
const Variant step{
    "block",
    "time.step=0.0005; grid.cell=1; grid.min=[0,0]; grid.max=[40,20]; terrain.elevation=1; "
    "material.rock.youngs_modulus=1e8; material.rock.viscosity_time=0; body.block.shape=polygon; "
    "body.block.vertices=[[10,1],[22,1],[22,3],[18,3],[18,5],[10,5]]; body.block.porosity=0.4; "
    "body.block.temperature={depth=[0,4],value=[-2,-10]}; basal.friction=lubricated; basal.friction_angle=30; "
    "mechanisms.pressurization=true; pressure.enabled=true"};

std::vector<BodyFigures> figures_of(const Variant& variant, const Sets& sets = {}) {
  return body_figures(Simulation<2>(case_from_text(variant, sets)));
}

// The only warning about the bodies of a case.
void expect_warning(const Sets& sets, const std::vector<BodyFigures>& bodies, const std::string& part) {
  const auto warnings = body_warnings(case_from_text(step, sets), bodies);
  ASSERT_EQ(warnings.size(), 1U);
  expect_in(warnings.front(), part);
}

TEST(BodyFigures, AreThoseOfTheBody) {
  const std::vector<BodyFigures> bodies = figures_of(step);
  ASSERT_EQ(bodies.size(), 1U);
  const BodyFigures& body = bodies.front();
  EXPECT_EQ(body.name, "block");
  EXPECT_EQ(body.particles, 160U);
  EXPECT_NEAR(body.volume, 40.0, 1e-12);
  EXPECT_NEAR(body.mass, 40.0 * (0.6 * 2750.0 + 0.4 * 917.0), 1.0) << "some of the ice is water";
  EXPECT_NEAR(body.area, 12.0, 1e-12);
  EXPECT_NEAR(body.mean_thickness, 40.0 / 12.0, 1e-12);
  EXPECT_NEAR(body.median_thickness, 4.0, 1e-12) << "half of the area is where it is thinner";
  EXPECT_NEAR(body.largest_thickness, 4.0, 1e-12);
  EXPECT_EQ(body.spacing, 0.5);
  EXPECT_NEAR(body.particles_across, 8.0, 1e-12);
  EXPECT_NEAR(body.warmest, -2.5, 1e-12) << "a quarter of a metre below the top";
  EXPECT_NEAR(body.coldest, -9.5, 1e-12);
  EXPECT_NEAR(body.clearance, 0.0, 1e-12);
  EXPECT_EQ(body.resting_fraction, 1.0);
  EXPECT_TRUE(body_warnings(case_from_text(step), bodies).empty());
}

// A heap of 5 m x 8 m with a layer of 25 m x 1 m in front of it, so soft that its weight compresses it.
TEST(BodyFigures, TheMedianIsByAreaAndTriggersAWarning) {
  const Sets sets =
      "grid.max=[50,20]; material.rock.youngs_modulus=2e6; "
      "body.block.vertices=[[5.0,1.0],[35.0,1.0],[35.0,2.0],[10.0,2.0],[10.0,9.0],[5.0,9.0]]";
  const std::vector<BodyFigures> bodies = figures_of(step, sets);
  EXPECT_NEAR(bodies.front().mean_thickness, 65.0 / 30.0, 1e-12);
  EXPECT_NEAR(bodies.front().median_thickness, 1.0, 1e-12) << "not the 8 m of most of its volume";
  EXPECT_NEAR(bodies.front().particles_across, 2.0, 1e-12);
  EXPECT_NEAR(bodies.front().max_particles_across, 16.0, 1e-12);
  const auto warnings = body_warnings(case_from_text(step, sets), bodies);
  ASSERT_EQ(warnings.size(), 2U);
  expect_in(warnings[0],
            "the weight of body block, 160,000 Pa where it is thickest, compresses it by 8 % there. "
            "Give it 4e+06 Pa or more.");
  expect_in(warnings[1],
            "grid.cell: across the median thickness of body block, 1 m, there are too few particles to "
            "resolve shear and thinning (found 2; needed 4). Set grid.cell to 0.5 m, at about 8 times "
            "the run time.");
}

// Material of this strength on a base of 30 degrees, whose friction is 0.577 of the load.
const Sets strong = "material.rock.law=mohr_coulomb; material.rock.cohesion=1e5; material.rock.residual_cohesion=0";

TEST(BodyFigures, ABrokenBodyWeakerThanItsBaseCausesAWarning) {
  const auto warnings_with = [](const Sets& others) {
    const Sets sets = strong + others;
    return body_warnings(case_from_text(step, sets), figures_of(step, sets));
  };
  const std::string slip = "material.rock.softening_slip=1.0", angle = "material.rock.friction_angle=35.0";
  const std::string residual = "material.rock.residual_friction_angle=";
  const auto warnings = warnings_with({slip, angle, residual + "25.0"});
  ASSERT_EQ(warnings.size(), 1U);
  expect_in(warnings.front(),
            "the base is stronger than the broken material of body block (shear strength 0.577 and 0.466 of the "
            "load). The slide shears above its base, the base stays cold, and the results depend on grid.cell. Set "
            "a larger material.rock.residual_friction_angle, or a basal friction of at most 0.466 (an angle of 25.0 "
            "degrees).");
  EXPECT_TRUE(warnings_with({slip, angle, residual + "30.0"}).empty()) << "an angle as large as that of the base";
  EXPECT_EQ(warnings_with({slip, angle, residual + "29.9"}).size(), 1U);
  EXPECT_TRUE(warnings_with({slip, angle, residual + "25.0", "basal.friction_angle=25.0"}).empty());
  EXPECT_TRUE(warnings_with({slip, angle, residual + "25.0", "material.rock.residual_cohesion=2e4"}).empty());
  EXPECT_EQ(warnings_with({slip, "material.rock.friction_angle=20.0"}).size(), 1U) << "friction that does not soften";
  EXPECT_TRUE(warnings_with({slip, angle, residual + "25.0", "mechanisms.deformation=false"}).empty());
  // Over a strain of 1, on cells of 1 m a slip of sqrt(3) m, the body remains unbroken while it slides.
  EXPECT_TRUE(warnings_with({"material.rock.softening_strain=1.0", angle, residual + "25.0"}).empty()) << "the paper's";
  EXPECT_TRUE(warnings_with({"material.rock.softening_slip=1.74", angle, residual + "25.0"}).empty());
  EXPECT_EQ(warnings_with({"material.rock.softening_slip=1.73", angle, residual + "25.0"}).size(), 1U);
}

// R_0 - R_f is 1e5 cos 35 + p (sin 35 - sin 30), with p the weight of 4 m.
TEST(BodyFigures, ACellTooWideForSofteningCausesAWarning) {
  const Sets sets = strong +
                    "material.rock.friction_angle=35; material.rock.residual_friction_angle=30; "
                    "material.rock.softening_slip=0.001";
  expect_warning(sets, figures_of(step, sets),
                 "material.rock.softening_slip is 0.001 m: in a cell of 1 m the strength falls faster "
                 "than the elastic strain can follow, and breaking depends on grid.cell. Set grid.cell to at "
                 "most ");
}

// If cohesion is constant and friction decreases, the radius of Mohr's circle may grow, and no energy is released.
TEST(BodyFigures, SofteningThatLosesNoStrengthIsNotReported) {
  const Sets sets =
      strong +
      "material.rock.friction_angle=35; material.rock.residual_friction_angle=20; "
      "material.rock.cohesion=1e7; material.rock.residual_cohesion=1e7; material.rock.softening_slip=0.001";
  EXPECT_TRUE(body_warnings(case_from_text(step, sets), figures_of(step, sets)).empty());
}

TEST(BodyFigures, ReportTheClearanceAboveTheGround) {
  const std::vector<BodyFigures> bodies = figures_of(step, {"terrain.elevation=-0.75"});
  EXPECT_NEAR(bodies.front().clearance, 1.75, 1e-12);
  EXPECT_EQ(bodies.front().resting_fraction, 0.0);
  expect_warning({}, bodies,
                 "body.block floats: its underside is 1.75 m above what is below it, and it falls for "
                 "0.6 s before it touches. Place it on that");
}

TEST(BodyFigures, ReportTheVolumeErrorOfTheLattice) {
  const Sets lower =
      "terrain.type=none; grid.boundary.y_min=fixed; grid.min=[0,1]; grid.max=[40,21]; "
      "body.block.vertices=[[10.0,1.0],[22.0,1.0],[22.0,3.0],[18.0,3.0],[18.0,4.8],[10.0,4.8]]";
  const std::vector<BodyFigures> bodies = figures_of(step, lower);
  EXPECT_NEAR(bodies.front().shape_volume, 38.4, 1e-12);
  EXPECT_NEAR(bodies.front().volume, 40.0, 1e-12);
  expect_warning(lower, bodies,
                 "body.block has 38.4 m3 per m of width; its particles, 0.5 m apart, have 40, 4.2 % more. "
                 "Place its corners at multiples of that distance, or use a smaller grid.cell.");
}

// A box with its lower left corner on a slope of 45 degrees: the first of its 24 columns is within half a metre of the
// ground.
TEST(BodyFigures, ReportTheFractionOfABodyThatRestsOnTheGround) {
  const std::vector<BodyFigures> bodies =
      figures_of(step, {"terrain.type=plane", "terrain.slope=45", "terrain.elevation=11"});
  EXPECT_NEAR(bodies.front().clearance, 0.25, 1e-12) << "at the middle of the first column";
  EXPECT_NEAR(bodies.front().resting_fraction, 1.0 / 24.0, 1e-12);
}

const Sets lid =
    "body.lid.material=rock; body.lid.min=[10,5]; body.lid.max=[18,7]; body.lid.particles_per_axis=4; "
    "body.lid.porosity=0.4";

TEST(BodyFigures, BodiesRestOnBodies) {
  const std::vector<BodyFigures> bodies = figures_of(step + lid);
  ASSERT_EQ(bodies.size(), 2U);
  EXPECT_EQ(bodies[1].name, "lid");
  EXPECT_NEAR(bodies[1].clearance, 0.0, 1e-12);
  EXPECT_EQ(bodies[1].resting_fraction, 1.0);
  EXPECT_NEAR(bodies[1].mean_thickness, 2.0, 1e-12);
  EXPECT_EQ(bodies[0].resting_fraction, 1.0);
  const std::vector<BodyFigures> moved = figures_of(step + lid, {"body.lid.min=[14.0,5.0]", "body.lid.max=[22.0,7.0]"});
  EXPECT_NEAR(moved[1].clearance, 0.0, 1e-12);
  EXPECT_NEAR(moved[1].resting_fraction, 0.5, 0.04) << "the other half is over the lower step";
}

TEST(BodyFigures, BodiesWithNothingBelowHaveInfiniteClearance) {
  EXPECT_TRUE(std::isinf(figures_of(step, "terrain.type=none").front().clearance));
  const Sets held = "terrain.type=none; grid.boundary.y_min=fixed; grid.min=[0,1]; grid.max=[40,21]";
  EXPECT_NEAR(figures_of(step, held).front().clearance, 0.0, 1e-12) << "the side of the domain holds";
}

// In free fall.
const Variant block{
    "free",
    "case.gravity=9.81; grid.cell=10; grid.min=[-50,-150]; grid.max=[300,150]; material.rock.youngs_modulus=5e8; "
    "material.rock.poisson_ratio=0.2; body.block.min=[0,0]; body.block.max=[100,50]; "
    "mechanics.initial_stress=geostatic"};

TEST(Bodies, MustNotOverlapOrMissTheirVolume) {
  const auto mistake = [](const Variant& variant) { return error_of([&] { Simulation<2>(paper_case(variant)); }); };
  const Sets second = "body.other.material=rock; body.other.min=[90,0]; body.other.max=[150,50]";
  expect_in(mistake(block + second), "body 'block' and body 'other' both fill the place x = 92.5 m");
  EXPECT_EQ(mistake(block + second + "body.other.min=[100,0]"), "no error");
  expect_in(mistake(block + "body.block.min=[0,4]; body.block.max=[100,8]"),
            "body 'block' has a volume of 400 m3 per m, and its 20 particles, 5 m apart, 500; "
            "allowed: within 15 %.");
}

}  // namespace
}  // namespace thawslide::sim
