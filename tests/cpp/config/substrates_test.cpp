// Substrates in the case file.
#include "case_messages.hpp"
#include "config/notices.hpp"
#include "physics/basal/laws.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;
using testing_support::case_from_text;

const std::string coefficient = "friction = \"coefficient\"\nfriction_coefficient = 0.1\n";

std::string on_glacier(const std::string& place) { return valid_case + "[substrate.ice]\n" + place + coefficient; }

TEST(Substrates, HaveSeparateLawsAndAreas) {
  const Case found =
      case_from_text(on_glacier("x_min = 50.0\n") + "cohesion = 1e4\ncohesion_law = \"ice\"\n" +
                     "[substrate.moraine]\nx_max = 50.0\nfriction = \"constant\"\nfriction_angle = 30\n");
  ASSERT_EQ(found.substrates.size(), 2U);
  const Substrate &ice = found.substrates.at("ice"), &moraine = found.substrates.at("moraine");
  EXPECT_EQ(ice.friction, "coefficient");
  EXPECT_EQ(ice.numbers(physics::basal::friction_coefficient), 0.1);
  EXPECT_EQ(ice.numbers(physics::basal::initial_cohesion), 1e4);
  EXPECT_EQ(ice.x_min, 50.0);
  EXPECT_TRUE(std::isinf(ice.x_max));
  EXPECT_EQ(moraine.numbers(physics::basal::friction_angle), 30.0);
  EXPECT_EQ(moraine.numbers(physics::basal::initial_cohesion), 0.0) << "the value of [basal] is not inherited";
  EXPECT_EQ(found.basal.friction, "lubricated");
}

TEST(Substrates, ThatMeetHaveNoGapAndAGapCausesAWarning) {
  const auto with = [](double x_min) {
    return on_glacier("x_max = 50.0\n") + fmt::format("[substrate.snow]\nx_min = {}\n{}", x_min, coefficient);
  };
  EXPECT_TRUE(notices(case_from_text(with(50.0), {"heat.enabled=false"})).empty());
  EXPECT_EQ(
      notices(case_from_text(with(60.0), {"heat.enabled=false"})),
      std::vector<std::string>{
          "between the substrates ice and snow, from x = 50 to 60 m, there is no substrate: [basal] applies there"});
}

}  // namespace
}  // namespace thawslide::config
