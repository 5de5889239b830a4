// How the steps of a run end.
#include <gtest/gtest.h>

#include "../support/case_from_text.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

const std::string block = R"(
[time]
end = 1.0
step = 0.002
[grid]
cell = 10.0
min = [-50.0, -150.0]
max = [300.0, 150.0]
[material.rock]
law = "elastic"
youngs_modulus = 5e8
poisson_ratio = 0.2
[body.block]
material = "rock"
shape = "box"
min = [0.0, 0.0]
max = [100.0, 50.0]
[heat]
enabled = false
[pressure]
enabled = false
)";

TEST(TimeStep, TheLastFixedStepEndsWithTheRun) {
  Simulation<2, double> simulation(paper_case(block, {"time.step=0.003", "time.end=0.01"}));
  while (simulation.time() < 0.01) {
    simulation.step(simulation.next_step(0.01));
  }
  EXPECT_EQ(simulation.step_number(), 4);
  EXPECT_DOUBLE_EQ(simulation.time(), 0.01);
}

}  // namespace
}  // namespace thawslide::sim
