// Front, runout and drop height are those of bodies that have moved; a body at rest is no part of them.
#include <gtest/gtest.h>

#include "../support/base_cases.hpp"
#include "sim/direction.hpp"
#include "sim/records/end_state.hpp"
#include "sim/records/history.hpp"
#include "sim/records/run_records.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

constexpr double steps_of_test = 500;

// A body of 10 m at 5 m/s, and bodies at rest: ahead of it, behind it, or both. None touches another.
const Variant moving{"block",
                     "time.step=0.002; grid.cell=1; grid.min=[-60,-2]; grid.max=[120,20]; "
                     "material.rock.youngs_modulus=1e8; material.rock.viscosity_time=0.005; body.block.min=[5,0]; "
                     "body.block.max=[15,6]"};
const Sets ahead = "body.old.material='rock'; body.old.min=[80,0]; body.old.max=[100,10]";
const Sets behind = "body.back.material='rock'; body.back.min=[-50,0]; body.back.max=[-30,10]";

struct Ends {
  double front, runout;
};

Ends ends_after(const Variant& variant) {
  Simulation<2> simulation(paper_case(variant));
  for (int k = 0; k < steps_of_test; ++k) {
    simulation.step(0.002);
  }
  const HistoryRow row = history_row(simulation);
  return {value_of(row, "front_position_m"), value_of(row, "runout_m")};
}

TEST(MovedMass, DoesNotContainBodiesAtRest) {
  for (const double velocity : {5.0, -5.0}) {
    const Variant slide = moving + Sets(fmt::format("body.block.velocity=[{},0]", velocity));
    const Ends alone = ends_after(slide);
    EXPECT_NEAR(alone.front, velocity > 0.0 ? 15.0 + 3.2 : 5.0 - 3.2, 0.5);
    EXPECT_NEAR(alone.runout, 13.2, 0.5);
    for (const Sets& others : {ahead, behind, ahead + behind}) {
      const Ends with_others = ends_after(slide + others);
      EXPECT_NEAR(with_others.front, alone.front, 1e-6) << others.back();
      EXPECT_NEAR(with_others.runout, alone.runout, 1e-6) << others.back();
    }
  }
}

TEST(MovedMass, IsAllMassWhileNothingHasMovedThatFar) {
  Simulation<2> simulation(paper_case(moving + Sets("body.block.velocity=[5,0]") + ahead));
  EXPECT_TRUE(simulation.moved_mass().all);
  EXPECT_EQ(simulation.moved_mass().mass, static_cast<double>(simulation.sum_over_body().mass));
  EXPECT_NEAR(value_of(history_row(simulation), "front_position_m"), 99.5, 0.5);
  for (int k = 0; k < steps_of_test; ++k) {
    simulation.step(0.002);
  }
  const MovedMass moved = simulation.moved_mass();
  EXPECT_FALSE(moved.all);
  EXPECT_TRUE(moved.has(0));
  EXPECT_FALSE(moved.has(1));
}

TEST(MovedMass, BeginsAtTheDistanceOfTheCase) {
  const Sets sets = Sets("body.block.velocity=[5,0]; time.moved_distance=50") + ahead;
  EXPECT_NEAR(ends_after(moving + sets).front, 99.5, 0.5);
}

// Drop height and travel distance in space, with a higher body at rest behind.
TEST(MovedMass, HasTheTopAndTheRearOfItsOwnBodies) {
  const auto figures_with = [](const Sets& others) {
    Simulation<3> simulation(
        slide_in_space(Sets("case.gravity_tilt=0.0; body.box.velocity=[16,0,0]; material.rock.cohesion=1e6") + others));
    config::Site site;
    site.path = {{-4.0, 5.0}, {50.0, 5.0}};
    RunRecords<3> records(simulation, site);
    records.start(simulation);
    for (int k = 0; k < 100; ++k) {
      simulation.step(0.002);
      records.after_step(simulation);
    }
    return *records.figures(simulation, [](double, double) { return 0.0; });
  };
  const RunFigures alone = figures_with({});
  EXPECT_NEAR(alone.drop_height, 3.0, 0.01);
  const RunFigures with_others = figures_with(
      "body.tower.material='rock'; body.tower.min=[20.0, 3.0, 0.0]; body.tower.max=[24.0, 7.0, 8.0]; "
      "body.tower.porosity=0.375; body.tower.temperature=-0.5");
  EXPECT_NEAR(with_others.travel_distance, alone.travel_distance, 0.05);
  EXPECT_NEAR(with_others.drop_height, alone.drop_height, 1e-9);
}

TEST(MovedMass, BodiesBeyondTheLastOfASetCountTogether) {
  mpm::BodySet set;
  set.add(3);
  set.add(700);
  EXPECT_TRUE(set.contains(3));
  EXPECT_FALSE(set.contains(4));
  EXPECT_FALSE(set.contains(67));
  EXPECT_TRUE(set.contains(255));
  EXPECT_TRUE(set.contains(300));
}

}  // namespace
}  // namespace thawslide::sim
