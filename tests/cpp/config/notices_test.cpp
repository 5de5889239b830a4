// What a user is told of values that are sound but unusual.
#include "config/notices.hpp"

#include "case_messages.hpp"
#include "config/declaration.hpp"
#include "config/moved_defaults.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

std::vector<std::string> without_folder(std::vector<std::string> notices) {
  const std::string folder = testing_support::folder_of_this_test().string();
  for (std::string& notice : notices) {
    if (const std::size_t at = notice.find(folder); at != std::string::npos) {
      notice.replace(at, folder.size(), "FOLDER");
    }
  }
  return notices;
}

std::vector<std::string> notices_of(const std::string& of_material) {
  const Case found = testing_support::case_from_text(
      changed({{"law = \"elastic\"", "friction_angle = 40.0\ncohesion = 1e6\n" + of_material},
               {"[basal]", "[block]\nbends = true\n[basal]"}}));
  return without_folder(notices(found));
}

TEST(Notices, TellOfBrokenMatterThatIsUnusual) {
  EXPECT_EQ(
      notices_of("residual_cohesion = 6e4\nresidual_friction_angle = 12.0\nsoftening_strain = 0.5"),
      (std::vector<std::string>{
          "FOLDER/case.toml:16:20: material.rock.softening_strain is 0.5, outside the 0.005 to 0.05 over which broken "
          "rock and ice usually lose their strength",
          "FOLDER/case.toml:15:27: material.rock.residual_friction_angle is 12 degrees, outside the 20 to 35 degrees "
          "that are usual for broken rock and ice",
          "FOLDER/case.toml:14:21: material.rock.residual_cohesion is 60000 Pa, above the 50000 Pa that broken rock "
          "and ice usually have at most"}));
}

TEST(Notices, HaveNothingAgainstUsualBrokenMatterNorThePaper) {
  const std::vector<std::string> none;
  EXPECT_EQ(notices_of("residual_cohesion = 1e4\nresidual_friction_angle = 25.0\nsoftening_strain = 0.02"), none);
  EXPECT_EQ(notices_of("residual_cohesion = 1e5\nsoftening_strain = 1.0"), none) << "the paper's";
  EXPECT_EQ(notices_of("softening_strain = 0.5"), none) << "nothing softens";
}

const std::vector<Change> with_band{
    {"[basal]", "[band]\nthickness = 0.1\n[basal]"},
    {"law = \"elastic\"",
     "friction_angle = 35.0\ncohesion = 1e6\nresidual_cohesion = 1e4\nhydraulic_conductivity = 1e-7"}};

TEST(Notices, OneTellsAFileOfEarlierVersionsWhatChanged) {
  const Case found = testing_support::case_from_text(changed(with_band));
  EXPECT_EQ(without_folder(notices(found)),
            (std::vector<std::string>{
                "FOLDER/case.toml: the file gives none of these keys, whose defaults are no longer the paper's forms:\n"
                "  band.model = \"columns\"  # was \"scaled\"\n"
                "  band.thickness_change = \"conserving\"  # was \"as_printed\"\n"
                "  heat.advection_form = \"conservative\"  # was \"as_printed\"\n"
                "  pressure.frozen = \"none\"  # was \"ice_pressure\"\n"
                "  pressure.frozen_rows = \"sealed\"  # was \"draining\"\n"
                "  pressure.melt_contraction = true  # was false\n"
                "  pressure.skeleton_compressibility = 2e-09  # was 0.0\n"
                "  phases.water_expansion_law = \"by_temperature\"  # was \"constant\"\n"
                "  material.NAME.softening_strain = 0.05  # was 1.0\n"
                "  With the values of before it gives what it gave. Give one of them, and this note goes; "
                "docs/choosing-the-base.md says why."}));
}

TEST(Notices, SayNothingOfDefaultsWhereOneIsGivenOrNoneIsFelt) {
  const std::vector<std::string> none;
  for (const MovedDefault& moved : moved_defaults()) {
    const std::string table = moved.table == "material.NAME" ? "material.rock" : moved.table;
    const Case found = testing_support::case_from_text(changed(with_band), {table + "." + moved.key + "=" + moved.now});
    EXPECT_EQ(notices(found), none) << moved.key;
  }
  EXPECT_EQ(notices(testing_support::case_from_text(sound, {"heat.enabled=false"})), none);
}

// What the notice says of the present is what the declarations say.
TEST(Notices, NameThePresentDefaults) {
  for (const MovedDefault& moved : moved_defaults()) {
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
