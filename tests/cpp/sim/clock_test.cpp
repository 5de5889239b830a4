// Clock of a run: fixed steps are counted, adaptive ones are summed.
#include "sim/solver/clock.hpp"

#include <gtest/gtest.h>

namespace thawslide::sim {
namespace {

config::Time fixed_steps(double step) {
  config::Time times;
  times.stepping = config::Stepping::fixed;
  times.step = step;
  return times;
}

TEST(ClockTest, FixedStepsAreCountedWithoutRoundOff) {
  Clock clock;
  double summed = 0.0;
  for (int k = 0; k < 100000; ++k) {
    clock.advance(0.1, fixed_steps(0.1));
    summed += 0.1;
  }
  EXPECT_EQ(clock.time, 100000 * 0.1);
  EXPECT_NE(clock.time, summed);
  EXPECT_EQ(clock.step_number, 100000);
}

TEST(ClockTest, OtherStepsAreAdded) {
  Clock clock;
  clock.advance(0.1, fixed_steps(0.1));
  clock.advance(0.05, fixed_steps(0.1));  // the last step of a part
  EXPECT_EQ(clock.time, 0.1 + 0.05);
  EXPECT_EQ(clock.last_step, 0.05);
  clock.advance(0.1, fixed_steps(0.1));
  const double from = clock.time;
  EXPECT_EQ(from, (0.1 + 0.05) + 0.1);
  for (int k = 0; k < 7; ++k) {
    clock.advance(0.3, fixed_steps(0.3));
  }
  EXPECT_EQ(clock.time, from + 7 * 0.3) << "counted from where they begin";
  Clock adaptive;
  config::Time times;
  times.stepping = config::Stepping::adaptive;
  for (int k = 0; k < 3; ++k) {
    adaptive.advance(0.1, times);
  }
  EXPECT_EQ(adaptive.time, 0.1 + 0.1 + 0.1);
  EXPECT_EQ(adaptive.fixed.from_number, 0);
}

}  // namespace
}  // namespace thawslide::sim
