// Filling of bodies with particles.
#include <gtest/gtest.h>

#include "../support/case_from_text.hpp"
#include "base/error.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;
using Sets = std::vector<std::string>;

const std::string block = R"(
[time]
end = 1.0
step = 0.002
[grid]
cell = 10.0
min = [-50.0, -150.0]
max = [300.0, 150.0]
[material.rock]
law = "elastic"
youngs_modulus = 5e8
poisson_ratio = 0.2
[body.block]
material = "rock"
shape = "box"
min = [0.0, 0.0]
max = [100.0, 50.0]
[heat]
enabled = false
[pressure]
enabled = false
)";

TEST(Bodies, MustNotOverlapOrMissTheirVolume) {
  const auto mistake = [](const std::string& text, const Sets& sets) -> std::string {
    try {
      const Simulation<2> simulation(paper_case(text, sets));
    } catch (const UserError& error) {
      return error.what();
    }
    return "no mistake";
  };
  const std::string second =
      "[body.other]\nmaterial = \"rock\"\nshape = \"box\"\nmin = [90.0, 0.0]\nmax = [150.0, 50.0]\n";
  EXPECT_NE(mistake(block + second, {}).find("body 'block' and body 'other' both fill the place x = 92.5 m"),
            std::string::npos)
      << mistake(block + second, {});
  EXPECT_EQ(mistake(block + second, {"body.other.min=[100.0,0.0]"}), "no mistake");
  const std::string thin = mistake(block, {"body.block.min=[0.0,4.0]", "body.block.max=[100.0,8.0]"});
  EXPECT_NE(thin.find("body 'block' has a volume of 400 m3 per m, and its 20 particles, 5 m apart, 500; "
                      "allowed: within 15 %."),
            std::string::npos)
      << thin;
}

}  // namespace
}  // namespace thawslide::sim
