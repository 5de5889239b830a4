// Surface and failure line of a collapsed column of aluminium bars, compared with measurements.
#include "bar_collapse.hpp"

namespace thawslide::verification {
namespace {

using namespace bar_collapse;

TEST(BarCollapse, EndsNearTheMeasuredSurface) {
  Record record = make_record("Collapse of a column of aluminium bars");
  for (const std::string transfer : {"flip", "apic"}) {
    expect_measured(record, 0.01, transfer, false);
    expect_measured(record, 0.005, transfer, transfer == "apic");
  }
}

}  // namespace
}  // namespace thawslide::verification
