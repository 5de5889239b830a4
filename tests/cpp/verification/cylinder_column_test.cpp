// A cylindrical granular column collapses, in 3D and in a section; convergence as cells become smaller.
#include "cylinder_section.hpp"

namespace thawslide::verification {
namespace {

using namespace cylinder_column;

TEST(CylindricalColumn, RunoutAgreesWithExperiments) {
  Record record = make_record("Collapse of a cylindrical granular column");
  expect_runout(record, 1.0);
}

// The front is thinner than a cell. The runout is therefore shorter than that of the experiments by Lube et al., both
// in 3D and in a section (docs/laboratory.md).
TEST(CylinderSection, ApproachesTheExperimentsOnFinerCells) {
  Record record = make_section_record("Collapse of a cylindrical granular column on finer cells");
  expect_approach(record, {8, 16, 32}, {0.55, 0.40, 0.15});
  record.expect_near("section less column in space, 8 cells",
                     runout_of_section(8, "apic") - collapse(1.0, radius / 8, "apic"), 0.0, 0.06);
}

}  // namespace
}  // namespace thawslide::verification
