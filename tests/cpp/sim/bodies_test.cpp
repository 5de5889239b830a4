// Filling of bodies with particles.
#include <gtest/gtest.h>

#include "../support/base_cases.hpp"
#include "base/error.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {
namespace {

using namespace testing_support;

const Variant block{
    "free",
    "case.gravity=9.81; grid.cell=10; grid.min=[-50,-150]; grid.max=[300,150]; material.rock.youngs_modulus=5e8; "
    "material.rock.poisson_ratio=0.2; body.block.min=[0,0]; body.block.max=[100,50]; "
    "mechanics.initial_stress=geostatic"};

TEST(Bodies, MustNotOverlapOrMissTheirVolume) {
  const auto mistake = [](const Variant& block_and_more, const Sets& sets = {}) -> std::string {
    try {
      const Simulation<2> simulation(paper_case(block_and_more, sets));
    } catch (const UserError& error) {
      return error.what();
    }
    return "no mistake";
  };
  const Sets second = "body.other.material=rock; body.other.min=[90,0]; body.other.max=[150,50]";
  EXPECT_NE(mistake(block + second).find("body 'block' and body 'other' both fill the place x = 92.5 m"),
            std::string::npos)
      << mistake(block + second);
  EXPECT_EQ(mistake(block + second, {"body.other.min=[100.0,0.0]"}), "no mistake");
  const std::string thin = mistake(block, {"body.block.min=[0.0,4.0]", "body.block.max=[100.0,8.0]"});
  EXPECT_NE(thin.find("body 'block' has a volume of 400 m3 per m, and its 20 particles, 5 m apart, 500; "
                      "allowed: within 15 %."),
            std::string::npos)
      << thin;
}

}  // namespace
}  // namespace thawslide::sim
