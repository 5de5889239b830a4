// Convergence of the collapse of a column of aluminium bars as cells become smaller.
#include "../verification/bar_collapse.hpp"

namespace thawslide::verification {
namespace {

using namespace bar_collapse;

TEST(FineBarCollapse, EndsNearTheMeasuredSurface) {
  Record record = make_record("Collapse of a column of aluminium bars, finer cells");
  const std::vector<double> places = measured("surface").x;
  for (const std::string transfer : {"flip", "apic"}) {
    std::vector<double> before = surface_of(Collapse(0.02, transfer), places);
    std::vector<double> changes;
    for (const double cell : {0.01, 0.005, 0.0025}) {
      const std::vector<double> surface = expect_measured(record, cell, transfer, cell < 0.003 && transfer == "apic");
      changes.push_back(root_mean_square(differences(surface, before)));
      before = surface;
    }
    record.expect_order_at_least("cell [mm]", {20.0, 10.0, 5.0}, "rms change with half the cell [mm], " + transfer,
                                 changes, 1.0, 0.5);
  }
}

}  // namespace
}  // namespace thawslide::verification
