// The manufactured vibration with large displacements, with one more refinement than the short tests.
#include <gtest/gtest.h>

#include "../support/record.hpp"
#include "../verification/vibration_choices.hpp"

namespace thawslide::verification {
namespace {

TEST(FineVibration, ManufacturedWithLargeDisplacements) {
  Record record("Momentum, manufactured, large displacements, fine",
                problem + "A = 0.02: stretches from 0.87 to 1.13, and particles cross cells.", solution, source);
  const std::vector<int> cells{16, 32, 64};
  const std::vector<double> sizes{1.0 / 16, 1.0 / 32, 1.0 / 64};
  for (const Choice& choice : {ugimp_flip, ugimp_apic}) {
    record.expect_order("cell [m]", sizes, choice.name + ": rms error of displacement over A",
                        errors_of(choice, 0.02, cells), 1.0, 0.25);
  }
  for (const Choice& choice : {quadratic_flip, quadratic_apic}) {
    record.expect_order_at_least("cell [m]", sizes, choice.name + ": rms error of displacement over A",
                                 errors_of(choice, 0.02, cells), 1.0, 0.1);
  }
}

}  // namespace
}  // namespace thawslide::verification
