// What a user is told of values that are sound but unusual.
#include "config/notices.hpp"

#include "case_messages.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

std::vector<std::string> notices_of(const std::string& of_material) {
  const Case found = testing_support::case_from_text(
      changed({{"law = \"elastic\"", "friction_angle = 40.0\ncohesion = 1e6\n" + of_material}}));
  std::vector<std::string> notices_without_folder;
  for (std::string notice : notices(found)) {
    const std::string folder = testing_support::folder_of_this_test().string();
    if (const std::size_t at = notice.find(folder); at != std::string::npos) {
      notice.replace(at, folder.size(), "FOLDER");
    }
    notices_without_folder.push_back(notice);
  }
  return notices_without_folder;
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
  EXPECT_EQ(notices_of("residual_cohesion = 1e5"), none) << "the paper's";
  EXPECT_EQ(notices_of("softening_strain = 0.5"), none) << "nothing softens";
}

}  // namespace
}  // namespace thawslide::config
