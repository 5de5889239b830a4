// Error messages for invalid contact between bodies, and bodies bonded to each other.
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
std::string error_of(const std::string& text) { return error_of_text(valid_case + more_bodies + text); }
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

TEST(ContactOfBodies, WithoutFrictionIsRefused) {
  EXPECT_EQ(error_of("[contact]\nbetween_bodies = \"frictional\"\n"),
            "FOLDER/case.toml:30:1: key 'contact.friction_angle' is missing: it is needed when contact.between_bodies "
            "is \"frictional\". Add 'friction_angle = ...' to [contact]: friction angle between bodies that are in "
            "contact, a number, >= 0 and < 90 [degrees].");
}

TEST(ContactOfBodies, MustNameTwoBodies) {
  EXPECT_EQ(error_of(pair("slip", "[\"block\"]", bonded)),
            "FOLDER/case.toml:31:10: contact_pair.slip.bodies has 1 names of 1 bodies; allowed: the names of two. Name "
            "the two bodies, as in bodies = [\"ice\", \"rock\"].");
  EXPECT_EQ(error_of(pair("slip", "[\"block\", \"ise\"]", bonded)),
            "FOLDER/case.toml:31:10: contact_pair.slip.bodies names 'ise', and there is no [body.ise]; did you mean "
            "'ice'? Allowed: block, ice, wall.");
  EXPECT_EQ(error_of(pair("a", "[\"block\", \"ice\"]", bonded) + pair("b", "[\"ice\", \"block\"]", bonded)),
            "FOLDER/case.toml:34:10: contact_pair.b.bodies names two bodies that another [contact_pair.NAME] names "
            "too. Remove one.");
}

TEST(ContactOfBodies, ThatIsContradictoryIsRefused) {
  EXPECT_EQ(error_of(pair("slip", "[\"block\", \"ice\"]", rubs)),
            "FOLDER/case.toml:32:11: contact_pair.slip: block and ice are frictional here, but bonded through other "
            "bodies. Set contact.between_bodies = \"frictional\", and make only those pairs \"bonded\" that "
            "move as one.");
  EXPECT_EQ(error_of(frictional + pair("a", "[\"block\", \"ice\"]", bonded) + pair("b", "[\"ice\", \"wall\"]", rubs) +
                     pair("c", "[\"block\", \"wall\"]", "\"frictional\"\nfriction_angle = 12.5")),
            "FOLDER/case.toml:42:11: contact_pair.c: its friction_angle is 12.5, and that of contact_pair.b, whose "
            "bodies are bonded to these, 30; allowed: one between bodies that move as one. Give both the same.");
}

TEST(ContactOfBodies, ExcludesBandColumnsAndABed) {
  EXPECT_NE(error_of(frictional + "[band]\nmodel = \"columns\"\nthickness = 0.5\n")
                .find("contact.between_bodies: frictional contact between bodies and band.model = \"columns\" exclude "
                      "each other. Set contact.between_bodies = \"bonded\", or band.model = \"scaled\"."),
            std::string::npos);
  EXPECT_NE(error_of(frictional + "[bed]\nlaw = \"momentum\"\ndepth = 2.0\nstrength = 1e3\ndepth_per_slip = 0.5\n"
                                  "material = \"rock\"\n")
                .find("contact.between_bodies: frictional contact between bodies and an erodible bed (bed.law) exclude "
                      "each other. Set contact.between_bodies = \"bonded\", or remove [bed]."),
            std::string::npos);
}

}  // namespace
}  // namespace thawslide::config
