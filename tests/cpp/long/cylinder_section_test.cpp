// Collapse of a cylindrical granular column on up to 64 cells across its radius.
#include "../verification/cylinder_section.hpp"

namespace thawslide::verification {
namespace {

using namespace cylinder_column;

TEST(FineCylinderSection, RunsOutAsExperimentsDo) {
  Record record = make_section_record("Collapse of a cylindrical granular column on fine cells");
  expect_approach(record, {16, 32, 64}, {0.40, 0.15, 0.08});
  record.expect_near("section less column in space, 16 cells",
                     runout_of_section(16, "apic") - collapse(1.0, radius / 16, "apic"), 0.0, 0.05);
}

}  // namespace
}  // namespace thawslide::verification
