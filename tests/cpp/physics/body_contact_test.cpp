// Contact of two bodies at a node: conservation and onset.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/contact.hpp"

namespace thawslide::physics {
namespace {

constexpr double mass = 3.0, other_mass = 5.0, dt = 0.01;

TEST(BodyContact, ActsOnApproachingBodiesOnly) {
  for (const double closing : {-4.0, -1e-9, 0.0}) {
    const auto impulse = body_impulse(mass, other_mass, closing, 2.0, 0.0, dt, 0.5);
    EXPECT_EQ(impulse.normal, 0.0);
    EXPECT_EQ(impulse.tangential, 0.0) << "friction needs a load";
  }
}

TEST(BodyContact, ActsAfterTheGapHasClosed) {
  // In 0.01 s, bodies that approach at 2 m/s get 0.02 m closer.
  EXPECT_EQ(body_impulse(mass, other_mass, 2.0, 0.0, 0.02, dt, 0.0).normal, 0.0);
  EXPECT_EQ(body_impulse(mass, other_mass, 2.0, 0.0, 0.5, dt, 0.0).normal, 0.0);
  for (const double gap : {0.0, 0.005, 0.015}) {
    const double normal = body_impulse(mass, other_mass, 2.0, 0.0, gap, dt, 0.0).normal;
    const double closing_after = 2.0 - normal * (1.0 / mass + 1.0 / other_mass);
    EXPECT_NEAR(closing_after * dt, gap, 1e-15) << "the step ends with the bodies edge to edge";
  }
  EXPECT_EQ(body_impulse(mass, other_mass, 2.0, 0.0, -0.3, dt, 0.0).normal,
            body_impulse(mass, other_mass, 2.0, 0.0, 0.0, dt, 0.0).normal)
      << "bodies that overlap are not pushed apart";
}

TEST(BodyContact, SticksUpToCoulombsLimit) {
  const double slip = 1.5, reduced = mass * other_mass / (mass + other_mass);
  for (const double friction : {0.0, 0.2, 0.74}) {  // 0.75 stops the sliding
    const auto slides = body_impulse(mass, other_mass, 2.0, slip, 0.0, dt, friction);
    EXPECT_DOUBLE_EQ(slides.tangential, friction * slides.normal);
    EXPECT_LT(slides.tangential, reduced * slip);
  }
  const auto sticks = body_impulse(mass, other_mass, 2.0, slip, 0.0, dt, 0.76);
  EXPECT_DOUBLE_EQ(sticks.tangential, reduced * slip);
  EXPECT_NEAR(slip - sticks.tangential * (1.0 / mass + 1.0 / other_mass), 0.0, 1e-15);
}

TEST(BodyContact, IsTheSameForEitherBody) {
  const auto one = body_impulse(mass, other_mass, 2.0, 1.5, 0.003, dt, 0.3);
  const auto other = body_impulse(other_mass, mass, 2.0, 1.5, 0.003, dt, 0.3);
  EXPECT_EQ(one.normal, other.normal);
  EXPECT_EQ(one.tangential, other.tangential);
}

}  // namespace
}  // namespace thawslide::physics
