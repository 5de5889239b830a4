// Manufactured momentum balance: a square that vibrates along its axes, with each shape function and transfer.
#include "manufactured_vibration.hpp"
#include "verification.hpp"

namespace thawslide::verification {
namespace {

const std::vector<int> cells{8, 16, 32};
const std::vector<double> sizes{1.0 / 8, 1.0 / 16, 1.0 / 32};

TEST(Vibration, ManufacturedWithSmallDisplacements) {
  Record record("Momentum, manufactured, small displacements", problem + "A = 1e-4: no particle leaves its cell.",
                solution, source);
  for (const Choice& choice : {ugimp_flip, ugimp_apic, quadratic_flip, quadratic_apic}) {
    record.expect_order("cell [m]", sizes, choice.name + ": rms error of displacement over A",
                        errors_of(choice, 1e-4, cells), 2.0, 0.15);
  }
  record.explain(
      "All are of order 2. The spline changes to linear shape functions at the rollers; with a node held at 0 beyond "
      "them, the order was 1.");
}

TEST(Vibration, ManufacturedWithLargeDisplacements) {
  Record record("Momentum, manufactured, large displacements",
                problem + "A = 0.02: stretches from 0.87 to 1.13, and particles cross cells.", solution, source);
  for (const Choice& choice : {ugimp_flip, ugimp_apic}) {
    record.expect_order("cell [m]", sizes, choice.name + ": rms error of displacement over A",
                        errors_of(choice, 0.02, cells), 1.0, 0.5);
  }
  for (const Choice& choice : {quadratic_flip, quadratic_apic}) {
    record.expect_order_at_least("cell [m]", sizes, choice.name + ": rms error of displacement over A",
                                 errors_of(choice, 0.02, cells), 1.0, 0.0);
  }
  record.explain(
      "uGIMP's undeformed squares overlap or leave gaps in proportion to the stretch: order 1. Splines are of order 2 "
      "until the particles' uneven spacing, an error of quadrature in first order (Steffen et al. 2010), dominates. "
      "The next refinement, which ./test --full runs, is nearer to 1.");
}

}  // namespace
}  // namespace thawslide::verification
