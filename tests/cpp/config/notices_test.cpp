// Warnings about values that are valid but unusual.
#include "config/notices.hpp"

#include <algorithm>

#include "case_messages.hpp"
#include "config/changed_defaults.hpp"
#include "config/declaration.hpp"
#include "config/describe.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;
using testing_support::case_from_text;

std::vector<std::string> notices_without_folder(const Case& parameters) {
  std::vector<std::string> all = notices(parameters);
  std::transform(all.begin(), all.end(), all.begin(), without_folder);
  return all;
}

// The case of a run folder contains every default and marks the given ones.
TEST(Notices, WarnOfADefaultOfAResolvedCase) {
  const std::string known = "pressure.frozen=none";
  const std::string text = changed({{"[basal]", "[band]\nthickness = 0.5\n[basal]"},
                                    {"law = \"elastic\"", "law = \"elastic\"\ngaps_close_first = true"}});
  for (const std::string given : {"", "hydraulic_conductivity = 0.0\n"}) {
    const std::string first = changed({{"gaps_close_first", given + "gaps_close_first"}}, text);
    const std::string resolved = resolved_toml(case_from_text(first, {known}), "inputs");
    const Case again = case_from_text(resolved);
    EXPECT_EQ(resolved_toml(again, "inputs"), resolved);
    const std::vector<std::string> found = notices(again);
    ASSERT_EQ(found.size(), given.empty() ? 1U : 0U);
    if (given.empty()) {
      EXPECT_NE(found[0].find("material.rock.hydraulic_conductivity is 0 m/s, its default: pore water cannot drain"),
                std::string::npos);
    }
  }
}

const std::vector<Change> with_band{{"[basal]", "[band]\nthickness = 0.1\n[basal]"},
                                    {"law = \"elastic\"",
                                     "friction_angle = 35.0\ncohesion = 1e6\nresidual_cohesion = 1e4\nsoftening_strain "
                                     "= 0.05\nhydraulic_conductivity = 1e-7"}};

TEST(Notices, NameTheNewKeywordsAndKeysOfFormerOnes) {
  const Case found =
      case_from_text(changed({{"[basal]", "[heat]\nadvection_form = \"as_printed\"\n[basal]"}}),
                     {"pressure.clapeyron=printed", "mechanics.transfer=blend", "mechanics.pic_share=0.25"});
  EXPECT_EQ(found.heat.advection_form, AdvectionForm::as_published);
  EXPECT_EQ(found.pressure.clapeyron, ClapeyronSign::published);
  EXPECT_EQ(found.mechanics.pic_fraction, 0.25);
  const std::vector<std::string> all = notices_without_folder(found);
  for (const char* expected :
       {"note: FOLDER/case.toml:21:18: heat.advection_form is \"as_printed\", whose name is now \"as_published\"",
        "note: --set pressure.clapeyron=printed: pressure.clapeyron is \"printed\", whose name is now \"published\"",
        "note: --set mechanics.pic_share=0.25: key 'mechanics.pic_share' is called 'mechanics.pic_fraction' now"}) {
    EXPECT_EQ(std::count(all.begin(), all.end(), expected), 1) << expected;
  }
}

TEST(Notices, ListTheDefaultsThatHaveChangedSinceEarlierVersions) {
  const Case found = case_from_text(changed(with_band));
  EXPECT_EQ(
      notices_without_folder(found),
      (std::vector<std::string>{
          "FOLDER/case.toml: defaults of these keys have changed, and the file sets none of them:\n"
          "  band.model = \"columns\"  # was \"scaled\"\n"
          "  band.thickness_change = \"conserving\"  # was \"as_published\"\n"
          "  heat.advection_form = \"conservative\"  # was \"as_published\"\n"
          "  pressure.frozen = \"none\"  # was \"ice_pressure\"\n"
          "  pressure.frozen_rows = \"sealed\"  # was \"draining\"\n"
          "  pressure.melt_contraction = true  # was false\n"
          "  pressure.skeleton_compressibility = 2e-09  # was 0.0\n"
          "  phases.water_expansion_law = \"by_temperature\"  # was \"constant\"\n"
          "  material.NAME.gaps_close_first = true  # was false\n"
          "  The comments show the earlier values; setting them restores the earlier results. Set one of the keys to "
          "silence this warning (docs/choosing-the-base.md)."}));
}

TEST(Notices, OmitChangedDefaultsIfOneIsGivenOrNoneHasAnEffect) {
  const std::vector<std::string> none;
  for (const ChangedDefault& moved : changed_defaults()) {
    const std::string table = moved.table == "material.NAME" ? "material.rock" : moved.table;
    const Case found = case_from_text(changed(with_band), {table + "." + moved.key + "=" + moved.now});
    EXPECT_EQ(notices(found), none) << moved.key;
  }
  EXPECT_EQ(notices(case_from_text(valid_case, {"heat.enabled=false"})), none);
}

// The warning agrees with the declarations about the present defaults.
TEST(Notices, NameThePresentDefaults) {
  for (const ChangedDefault& moved : changed_defaults()) {
    bool is_found = false;
    for (const auto& table : tables()) {
      for (const Entry& entry : table->entries()) {
        if ((table->is_named() ? table->name + ".NAME" : table->name) == moved.table && entry.rule->key == moved.key) {
          is_found = true;
          EXPECT_TRUE(entry.default_text == moved.now || entry.otherwise.rfind(moved.now, 0) == 0) << moved.key;
        }
      }
    }
    EXPECT_TRUE(is_found) << moved.table << "." << moved.key;
  }
}

}  // namespace
}  // namespace thawslide::config
