// Terms of a step in the budget of a run.
#include "sim/solver/budget.hpp"

#include <gtest/gtest.h>

namespace thawslide::sim {
namespace {

// Setup with gravity of 10 m/s2 downwards.
sim::Setup<2> setup_with_mechanics(bool moves) {
  sim::Setup<2> setup;
  setup.parameters.mechanics.enabled = moves;
  setup.model.motion.gravity = {0.0, -10.0};
  return setup;
}

TEST(BudgetTest, GravityActsOnTheMassPresentOfABodyThatMoves) {
  Budget<2> budget;
  budget.initial_mass = 5.0;
  budget.joined_mass = 2.0;
  budget.left_mass = 1.0;
  add_step(StepSums<2>{}, setup_with_mechanics(true), false, 0.5, budget);
  EXPECT_EQ(budget.gravity_impulse[1], -0.5 * 6.0 * 10.0);
  Budget<2> fixed;
  fixed.initial_mass = 5.0;
  add_step(StepSums<2>{}, setup_with_mechanics(false), false, 0.5, fixed);
  EXPECT_EQ(fixed.gravity_impulse[1], 0.0);
}

TEST(BudgetTest, TransfersCountOnceEach) {
  StepSums<2> sums;
  sums.particle_kinetic = 7.0;
  sums.contact.node_kinetic = 3.0;
  sums.filtered = -1.0;
  sums.mapped_back = 0.5;
  sums.between_bodies = {2.0, 0.25};
  sums.contact.loss = 4.0;
  Budget<2> budget;
  add_step(sums, setup_with_mechanics(true), false, 0.5, budget);
  EXPECT_EQ(budget.numerical, 7.0 - 3.0 - 1.0 + 0.5 + 0.25);
  EXPECT_EQ(budget.contact_loss, 4.0 + 2.0);
}

TEST(BudgetTest, FrictionHeatsTheBodyOrTheBandColumns) {
  StepSums<2> sums;
  sums.contact.friction_work = 8.0;
  sums.contact.converted = 3.0;
  sums.heat.friction = 1.0;
  sim::Setup<2> setup = setup_with_mechanics(true);
  Budget<2> of_body, of_columns;
  add_step(sums, setup, false, 0.5, of_body);
  EXPECT_EQ(of_body.friction_heat, 1.0);
  setup.model.contact.band_columns = true;
  add_step(sums, setup, false, 0.5, of_columns);
  EXPECT_EQ(of_columns.friction_heat, 8.0 - 3.0);
}

TEST(BudgetTest, WorkOnABedCountsOnlyInReach) {
  StepSums<2> sums;
  sums.contact.bed_work = 6.0;
  Budget<2> budget;
  add_step(sums, setup_with_mechanics(true), false, 0.5, budget);
  EXPECT_EQ(budget.bed_work, 0.0);
  add_step(sums, setup_with_mechanics(true), true, 0.5, budget);
  EXPECT_EQ(budget.bed_work, 6.0);
}

}  // namespace
}  // namespace thawslide::sim
