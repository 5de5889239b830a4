// sweep.toml of a new case: its ranges follow from the thickness of the release and the slope below it.
#include "config/sweep_proposal.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "config/toml.hpp"

namespace thawslide::config {
namespace {

double number(const toml::table& text, const std::string& kind, const std::string& key, std::size_t index) {
  return text["sweep"][kind][key][index].value<double>().value();
}

toml::table sweep_of(double thickness, double steepest) { return toml::parse(sweep_text(thickness, steepest, {})); }

TEST(SweepProposal, FrictionIsAtMostThatOfTheBlock) {
  const std::string key = "basal.friction_angle";
  for (const auto& [steepest, low, high] : {std::array{50.0, 20.0, 35.0}, {30.4, 18.0, 30.0}, {12.9, 7.2, 12.0}}) {
    EXPECT_EQ(number(sweep_of(30.0, steepest), "range", key, 0), low);
    EXPECT_EQ(number(sweep_of(30.0, steepest), "range", key, 1), high);
  }
  EXPECT_LT(number(sweep_of(30.0, 0.0), "range", key, 0), number(sweep_of(30.0, 0.0), "range", key, 1));
}

TEST(SweepProposal, TheBandIsAtMostATwentiethOfTheSlide) {
  for (const auto& [thickness, low, high] :
       {std::array{90.0, 0.1, 1.0}, {20.0, 0.1, 1.0}, {4.0, 0.1, 0.2}, {1.0, 0.025, 0.05}}) {
    const toml::table text = sweep_of(thickness, 30.0);
    const double median = number(text, "lognormal", "band.thickness", 0);
    const double spread = std::exp(3.0 * number(text, "lognormal", "band.thickness", 1));
    EXPECT_NEAR(median / spread, low, 0.01 * low);
    EXPECT_NEAR(median * spread, high, 0.01 * high);
  }
}

TEST(SweepProposal, MembersHaveTheCellsOfQuick) {
  EXPECT_FALSE(sweep_of(30.0, 30.0)["sweep"]["set"]);
  Proposal quick;
  quick.cell = 12.0;
  quick.min = {0.0, 24.0, 48.0};
  quick.max = {480.0, 504.0, 528.0};
  const toml::table text = toml::parse(sweep_text(30.0, 30.0, quick));
  EXPECT_EQ(text["sweep"]["set"]["grid.cell"].value<double>(), 12.0);
  EXPECT_EQ(number(text, "set", "grid.min", 1), 24.0);
  EXPECT_EQ(number(text, "set", "grid.max", 2), 528.0);
}

}  // namespace
}  // namespace thawslide::config
