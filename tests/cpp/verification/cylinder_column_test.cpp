// A cylindrical granular column collapses.
#include "cylinder_column.hpp"

namespace thawslide::verification {
namespace {

using namespace cylinder_column;

TEST(CylindricalColumn, RunsOutAsExperimentsDo) {
  Record record = make_record("Collapse of a cylindrical granular column");
  expect_runout(record, 1.0);
}

}  // namespace
}  // namespace thawslide::verification
