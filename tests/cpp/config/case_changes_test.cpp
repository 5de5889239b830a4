#include "config/case_changes.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace thawslide::config {
namespace {

TEST(CaseChanges, NamesEachKeyThatDiffersWithBothValues) {
  const std::string before =
      "[time]\nend = 0.2\n[grid]\nmin = [0.0, -2.5]\nleaving = \"stop\"\n[case]\ntitle = \"a\"\n";
  const std::string now =
      "[time]\nend = 0.3\nstep = 1e-3\n[grid]\nmin = [0.0, -2.0]\n[case]\ntitle = \"b\"\n[report]\ntimes = [1.0]\n";
  EXPECT_EQ(differences(now, before),
            (std::vector<std::string>{"grid.leaving is missing, was 'stop'", "grid.min is [0.0, -2.0], was [0.0, -2.5]",
                                      "time.end is 0.3, was 0.2", "time.step is 0.001, was not given"}));
  EXPECT_TRUE(differences(before, before).empty());
}

TEST(CaseChanges, IgnoreOrderCommentsAndNumberFormat) {
  EXPECT_TRUE(differences("# one\n[b]\nx = 1.50\n[a]\ny = true", "[a]\ny = true\n[b]\nx = 1.5 # m").empty());
}

TEST(CaseChanges, ReportTheLineThatIsNotToml) {
  const std::vector<std::string> found = differences("[time]\nend = \n", "[time]\nend = 1.0\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].substr(0, 18), "line 2 is not TOML");
}

TEST(CaseChanges, AreLimitedToKeysThatEveryStepReads) {
  EXPECT_NO_THROW(
      require_changeable({"time.end=3", "time.stepping=adaptive", "checkpoint.interval=2", "grid.leaving=remove",
                          "basal.friction_angle=12", "basal.turbulent_friction=400", "basal.heat_fraction=0.5",
                          "mechanics.fmpm_interval=0.1", "substrate.ice.friction_coefficient=0.1"}));
  for (const char* set : {"grid.cell=3", "timeless.end=3", "time=3", "material.rock.cohesion=3", "band.thickness=0.1",
                          "grid.leavings=stop", "substrate.ice.x_min=3", "substrate.basal.cohesion_law=bonds"}) {
    EXPECT_THROW(require_changeable({"time.end=3", set}), UserError) << set;
  }
}

}  // namespace
}  // namespace thawslide::config
