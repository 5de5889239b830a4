#include "physics/basal_friction.hpp"

#include <gtest/gtest.h>

#include "physics/contact.hpp"

namespace thawslide::physics {
namespace {

TEST(Lubrication, IsEquation25) {
  // Frozen at a porosity of 0.375 (n_e = 0.75): 1 - (1 - 0.875)^2 = 0.984375, times tan 40 degrees = 0.826 as in
  // Sec. 3.3.
  EXPECT_NEAR(lubrication_factor(0.75, 0.05, 0.85, 2.0), 0.984375, 1e-14);
  EXPECT_NEAR(std::tan(40.0 * pi<double> / 180.0) * lubrication_factor(0.75, 0.05, 0.85, 2.0), 0.826, 5e-4);
  EXPECT_EQ(lubrication_factor(0.04, 0.05, 0.85, 2.0), 0.0);
  EXPECT_EQ(lubrication_factor(0.90, 0.05, 0.85, 2.0), 1.0);
  EXPECT_NEAR(lubrication_factor(0.45, 0.05, 0.85, 1.5), 1.0 - std::pow(0.5, 1.5), 1e-14);
}

TEST(SlidingStrength, TheTwoClampsDifferOnlyWherePressurePassesN) {
  using enum FrictionClamp;
  EXPECT_DOUBLE_EQ(sliding_strength(0.5, 10.0, 4.0, 2.0, keep_cohesion, false), 5.0);
  EXPECT_DOUBLE_EQ(sliding_strength(0.5, 10.0, 4.0, 2.0, joint, false), 5.0);
  EXPECT_DOUBLE_EQ(sliding_strength(0.5, 10.0, 13.0, 2.0, keep_cohesion, false), 2.0);
  EXPECT_DOUBLE_EQ(sliding_strength(0.5, 10.0, 13.0, 2.0, joint, false), 0.5);
  EXPECT_DOUBLE_EQ(sliding_strength(0.5, 10.0, 15.0, 2.0, joint, false), 0.0) << "never negative";
  EXPECT_DOUBLE_EQ(sliding_strength(0.5, 10.0, 15.0, 2.0, joint, true), 2.0) << "P capped at N";
}

TEST(Cohesion, Laws) {
  EXPECT_DOUBLE_EQ(cohesion_after_slip(6e5, 1e5, 0.0, 400.0), 6e5);
  EXPECT_NEAR(cohesion_after_slip(6e5, 1e5, 400.0, 400.0), 1e5 + 5e5 * std::exp(-1.0), 1e-6);
  EXPECT_DOUBLE_EQ(cohesion_of_ice(6e5, 0.25), 4.5e5);
  EXPECT_DOUBLE_EQ(cohesion_until(6e5, 1e5, 9.99, 10.0), 6e5);
  EXPECT_DOUBLE_EQ(cohesion_until(6e5, 1e5, 10.0, 10.0), 1e5);
}

TEST(Contact, SticksBelowTheStrengthAndSlidesAboveIt) {
  const auto sticks = contact_impulse(8.0, 3.0, 2.0, 0.5, 3.0);
  EXPECT_FALSE(sticks.slides);
  EXPECT_EQ(sticks.tangential, 3.0);
  const auto slides = contact_impulse(8.0, 3.1, 2.0, 0.5, 3.0);
  EXPECT_TRUE(slides.slides);
  EXPECT_EQ(slides.tangential, 3.0);
  EXPECT_EQ(slides.normal, 8.0);
}

}  // namespace
}  // namespace thawslide::physics
