// The complete 25 s on the incline: the mechanical energy budget closes.
#include "../verification/incline_energy.hpp"

#include <gtest/gtest.h>

namespace thawslide::verification {
namespace {

TEST(WholeIncline, MechanicalAccountClosesInFirstOrderOfTheStep) {
  Record record(
      "Mechanical energy budget on the incline, 25 s",
      "Cases D, D-L, D-L-P and P-L of Sec. 3.3: mechanical_residual_J over the work of gravity and the size of "
      "the friction work; asserted below 1 % with each step.",
      "no energy remains except the error of time integration", "energy balance");
  expect_closed_budget(record, 25.0, 0.15);
}

}  // namespace
}  // namespace thawslide::verification
