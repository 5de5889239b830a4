// A column of aluminium bars collapses: surface and failure line as measured.
#include "bar_collapse.hpp"

namespace thawslide::verification {
namespace {

using namespace bar_collapse;

TEST(BarCollapse, EndsNearTheMeasuredSurface) {
  Record record = make_record("Collapse of a column of aluminium bars");
  expect_measured(record, 0.01, "flip", {3.0, 9.0, 50.0, 7.0}, false);
  expect_measured(record, 0.005, "flip", {3.2, 8.0, 30.0, 8.0}, false);
  expect_measured(record, 0.01, "apic", {4.5, 13.0, 100.0, 6.0}, false);
  expect_measured(record, 0.005, "apic", {2.0, 5.0, 40.0, 6.0}, true);
}

}  // namespace
}  // namespace thawslide::verification
