// The first seconds on the incline: the mechanical energy budget closes. The complete 25 s are in tests/cpp/long.
#include "incline_energy.hpp"

#include "verification.hpp"

namespace thawslide::verification {
namespace {

TEST(InclineEnergy, ResidualIsOfFirstOrderInTheStep) {
  Record record(
      "Mechanical energy budget on the incline, the first 2 s",
      "Cases D, D-L, D-L-P and P-L of Sec. 3.3: mechanical_residual_J over the work of gravity and the size of "
      "the friction work; asserted below 1 % with each step.",
      "no energy remains except the error of time integration", "energy balance");
  expect_closed_budget(record, 2.0, 0.15);
}

}  // namespace
}  // namespace thawslide::verification
