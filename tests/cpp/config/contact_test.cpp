// Bodies bonded to each other, and their friction.
#include "case_messages.hpp"
#include "config/body_layers.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

const std::string more_bodies =
    "[body.ice]\nmaterial = \"rock\"\nmin = [40.0, 0.0]\nmax = [50.0, 20.0]\n"
    "[body.wall]\nmaterial = \"rock\"\nmin = [60.0, 0.0]\nmax = [70.0, 20.0]\n";
const std::string frictional = "[contact]\nbetween_bodies = \"frictional\"\nfriction_angle = 20.0\n";

std::string pair(const std::string& name, const std::string& bodies, const std::string& contact) {
  return "[contact_pair." + name + "]\nbodies = " + bodies + "\ncontact = " + contact + "\n";
}
BodyLayers layers_of(const std::string& text) {
  return body_layers(testing_support::case_from_text(valid_case + more_bodies + text));
}
const std::string bonded = "\"bonded\"", rubs = "\"frictional\"\nfriction_angle = 30.0";

TEST(ContactOfBodies, IsBondedByDefault) {
  EXPECT_EQ(layers_of("").of_body, (std::vector<std::size_t>{0, 0, 0}));
  EXPECT_EQ(layers_of(frictional).of_body, (std::vector<std::size_t>{0, 1, 2}));
}

TEST(ContactOfBodies, BondsThroughOtherBodies) {
  const std::string seam = pair("seam", "[\"block\", \"ice\"]", bonded);
  EXPECT_EQ(layers_of(frictional + seam).of_body, (std::vector<std::size_t>{0, 0, 1}));
  EXPECT_EQ(layers_of(frictional + seam + pair("other", "[\"wall\", \"ice\"]", bonded)).of_body,
            (std::vector<std::size_t>{0, 0, 0}));
}

TEST(ContactOfBodies, HasTheFrictionOfThePair) {
  const BodyLayers layers = layers_of(frictional + pair("slip", "[\"wall\", \"ice\"]", rubs));
  EXPECT_EQ(layers.friction_between(0, 1), 20.0);
  EXPECT_EQ(layers.friction_between(1, 2), 30.0);
  EXPECT_EQ(layers.friction_between(2, 1), 30.0);
}

}  // namespace
}  // namespace thawslide::config
