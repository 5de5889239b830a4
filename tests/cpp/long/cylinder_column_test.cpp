// Cylindrical granular columns of three heights collapse.
#include "../verification/cylinder_column.hpp"

namespace thawslide::verification {
namespace {

using namespace cylinder_column;

TEST(CylindricalColumns, RunOutAsExperimentsDo) {
  Record record = make_record("Collapse of cylindrical granular columns");
  for (const double aspect : {0.5, 1.0, 2.0}) {
    expect_runout(record, aspect);
  }
}

}  // namespace
}  // namespace thawslide::verification
