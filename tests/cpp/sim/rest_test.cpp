// Runs that end when the slide has come to rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/base_cases.hpp"
#include "../support/messages.hpp"
#include "base/parallel.hpp"
#include "config/grounds.hpp"
#include "io/checkpoint.hpp"
#include "sim/records/end_state.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

// A block that friction stops: from 2 m/s by 0.2 g in about a second.
const Variant endless{
    "block",
    "time.end=5; time.step=0.002; grid.cell=1; grid.min=[0,-2]; grid.max=[20,20]; material.rock.youngs_modulus=1e8; "
    "material.rock.viscosity_time=0.005; body.block.min=[5,0]; body.block.max=[15,6]; body.block.velocity=[2,0]; "
    "basal.friction_angle=11.31; mechanisms.pressurization=true"};
const Variant block = endless + "time.stop_at_rest=0.05; time.rest_time=0.4";

// Advances until rest or until the end; returns the time.
double end_of(Simulation<2>& simulation) {
  set_thread_count(1);
  while (!simulation.ends_at_rest() && simulation.time() < 5.0 - 1e-9) {
    simulation.step(simulation.next_step(5.0));
  }
  return simulation.time();
}

TEST(Rest, EndsARunAfterItsTime) {
  Simulation<2> simulation(paper_case(block));
  const double end = end_of(simulation);
  EXPECT_TRUE(simulation.ends_at_rest());
  EXPECT_TRUE(simulation.is_at_rest());
  EXPECT_GT(end, 1.02 - 0.05 / 2.0 + 0.4);
  EXPECT_LT(end, 1.02 + 0.4 + 0.4) << "it oscillates for a while";
  const std::string text = simulation.rest_text();
  EXPECT_EQ(text.rfind("the slide is at rest: since t = ", 0), 0U) << text;
  expect_in(text, " s no more than 0.5 % of its mass has moved faster than 0.05 m/s (time.stop_at_rest)");
}

// With the default speed and the default 10 s; the run continues.
TEST(Rest, IsDetectedWithoutTheKey) {
  Simulation<2> simulation(paper_case(endless, "time.end=13"));
  while (simulation.time() < 13.0 - 1e-9) {
    simulation.step(simulation.next_step(13.0));
    EXPECT_FALSE(simulation.ends_at_rest());
    if (simulation.time() < 10.0) {
      ASSERT_FALSE(simulation.is_at_rest());
    }
  }
  EXPECT_TRUE(simulation.is_at_rest());
  EXPECT_GT(simulation.rest_since(), 0.9);
  EXPECT_LT(simulation.rest_since(), 2.0);
  EXPECT_EQ(simulation.rest_rule(),
            "for 10 s, or 0.25 s from the start, no more than 0.5 % of the mass faster than 0.05 m/s");
}

TEST(Rest, IsPartOfTheEndStateWithAWarningBeforeIt) {
  Simulation<2> simulation(paper_case(block));
  while (simulation.time() < 0.5) {
    simulation.step(simulation.next_step(5.0));
  }
  const EndState moving = end_state<2>(simulation, false);
  EXPECT_TRUE(moving.is_known);
  EXPECT_FALSE(moving.at_rest);
  EXPECT_TRUE(std::isnan(moving.rest_since));
  EXPECT_NEAR(moving.mean_velocity, 2.0 - 0.2 * 9.81 * 0.5, 0.1);
  EXPECT_EQ(when_text(moving), "at 0.5 s, not at rest");
  const std::vector<std::string> warnings = warnings_of(moving, true);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].rfind("the slide is not at rest at 0.5 s (mean velocity ", 0), 0U) << warnings[0];
  expect_in(warnings[0],
            " m/s; at rest: for 0.4 s, or 0.25 s from the start, no more than 0.5 % of the mass "
            "faster than 0.05 m/s). Volumes, areas, distances and maps are those of this time and not of a deposit. ");
  EXPECT_TRUE(warnings_of(moving, false).empty()) << "while it runs";
  EXPECT_FALSE(end_state<2>(simulation, true).is_known) << "nothing of the slide is left";
  end_of(simulation);
  const EndState still = end_state<2>(simulation, false);
  EXPECT_TRUE(still.at_rest);
  EXPECT_EQ(still.rest_since, simulation.rest_since());
  EXPECT_TRUE(warnings_of(still, true).empty());
  expect_in(when_text(still), " s, at rest");
}

TEST(Rest, IsNotDetectedBeforeTheSlideHasMoved) {
  Simulation<2> simulation(paper_case(block, {"body.block.velocity=[0.0,0.0]"}));
  EXPECT_EQ(end_of(simulation), 5.0);
  EXPECT_FALSE(simulation.ends_at_rest());
  EXPECT_TRUE(simulation.is_at_rest());
}

// A run shorter than time.rest_time, 10 s: the block settles without further motion.
TEST(Rest, IsSinceTheStartIfNothingHasMoved) {
  const auto state_at = [&](double end, const std::string& set) {
    Simulation<2> simulation(paper_case(endless, set));
    run_until(simulation, end);
    return end_state<2>(simulation, false);
  };
  const EndState still = state_at(0.5, "body.block.velocity=[0.0,0.0]");
  EXPECT_TRUE(still.at_rest);
  EXPECT_EQ(still.rest_since, 0.0);
  EXPECT_TRUE(warnings_of(still, true).empty());
  EXPECT_EQ(when_text(still), "at 0.5 s, has not moved");
  EXPECT_FALSE(state_at(0.2, "body.block.velocity=[0.0,0.0]").at_rest) << "too early to decide";
  // It comes to rest within 0.3 s, but has not been at rest since the start.
  EXPECT_FALSE(state_at(1.0, "body.block.velocity=[0.5,0.0]").at_rest);
  EXPECT_FALSE(state_at(0.5, "case.gravity_tilt=30.0").at_rest);
}

TEST(Rest, AnEscapedParticleDoesNotPreventRest) {
  const Sets escaping =
      "body.stray.material=rock; body.stray.min=[6,12]; body.stray.max=[6.5,12.5]; body.stray.velocity=[0,6]";
  Simulation<2> simulation(paper_case(block + escaping));
  const double end = end_of(simulation);
  EXPECT_LT(end, 1.8);
  double fastest = 0.0;
  for (std::size_t p = 0; p < simulation.particles().size(); ++p) {
    fastest = std::max(fastest, std::abs(simulation.particles().velocity(p, 1)));
  }
  EXPECT_GT(fastest, 5.0) << "the stray one still flies";
}

TEST(Rest, ResumedDuringTheRestTimeEndsAtTheSameTime) {
  Simulation<2> whole(paper_case(block)), parted(paper_case(block));
  const double end = end_of(whole);
  EXPECT_LT(end, 2.0);
  while (parted.time() < end - 0.2) {
    parted.step(parted.next_step(5.0));
  }
  const auto folder = folder_of_this_test();
  io::write_checkpoint<2>(folder, parted.particles(), parted.particles_at_start(), parted.scalars());
  Simulation<2> resumed(paper_case(block));
  std::vector<double> scalars;
  io::read_checkpoint<2>(io::newest_checkpoint(folder), resumed.particles(), scalars);
  resumed.restore(scalars);
  EXPECT_EQ(resumed.scalars(), parted.scalars());
  EXPECT_EQ(end_of(resumed), end);
}

// Cohesion holds a block on 25 degrees until 3 s; it slides by itself afterwards.
TEST(Rest, BeginsAfterTheLastScheduledEvent) {
  const Sets held =
      "case.gravity_tilt=25; body.block.velocity=[0,0]; basal.cohesion=1e6; basal.cohesion_law='time'; "
      "basal.cohesion_loss_time=3; heat.enabled=false; pressure.enabled=false";
  Simulation<2> simulation(paper_case(block + held));
  EXPECT_EQ(end_of(simulation), 5.0);
  EXPECT_GT(value_of(history_row(simulation), "mean_velocity_m_s"), 1.0);
  EXPECT_EQ(
      simulation.rest_rule(),
      "for 0.4 s, or 0.25 s from the start, after the last scheduled change at 3 s no more than 0.5 % of the mass "
      "faster than 0.05 m/s");
}

// The last entries of a table repeat a value until the end of the run.
TEST(Rest, IsDelayedByWhatIsScheduledAndByNothingElse) {
  const std::string lost = "cohesion_law='time'; basal.cohesion_loss_time=3", ice = "substrate.ice.";
  const std::pair<std::string, double> changes[] = {
      {"basal.cohesion=1e5; basal." + lost, 3.0},
      {"basal.cohesion=1e5; basal.residual_cohesion=1e5; basal." + lost, 0.0},
      {"basal." + lost, 0.0},
      {"basal.cohesion=1e5; basal.cohesion_law='constant'", 0.0},
      {ice + "x_min=10; " + ice + "friction_angle=11; " + ice + "cohesion=1e5; " + ice + "cohesion_law='time'; " + ice +
           "cohesion_loss_time=4",
       4.0},
      {"band.thickness={ time=[0, 1, 1, 5], value=[0.05, 0.05, 0.5, 0.5] }", 1.0},
      {"band.thickness={ time=[0, 1, 5], value=[0.05, 0.05, 0.5] }", 5.0},
      {"band.thickness={ time=[0, 5], value=[0.05, 0.05] }", 0.0},
      {"band.thickness=0.05", 0.0}};
  for (const auto& [sets, time] : changes) {
    EXPECT_EQ(config::last_scheduled_event(paper_case(block + Sets(sets))), time) << sets;
  }
}

TEST(Rest, OfABodyThatHasNotMovedIsNamedSo) {
  Simulation<2> simulation(paper_case(block + Sets("body.block.velocity=[0.5,0]")));
  end_of(simulation);
  EXPECT_TRUE(simulation.ends_at_rest());
  EXPECT_EQ(simulation.rest_text(),
            "the slide has not moved: no more than 0.5 % of its mass has travelled 1 m (time.moved_distance)");
  const std::string when = when_text(end_state<2>(simulation, false));
  EXPECT_EQ(when.substr(when.find(',')), ", has not moved");
}

}  // namespace
}  // namespace thawslide::sim
