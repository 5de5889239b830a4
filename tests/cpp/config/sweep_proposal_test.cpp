// sweep.toml of a new case: its ranges follow from the thickness of the release and the slope below it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "config/case_proposal.hpp"
#include "config/toml.hpp"

namespace thawslide::config {
namespace {

double number(const toml::table& text, const std::string& kind, const std::string& key, std::size_t index) {
  return text["sweep"][kind][key][index].value<double>().value();
}

ProposedBase base_of(double band, double steepest) {
  ProposedBase base;
  base.thickness = band;
  base.friction = steepest;
  return base;
}

toml::table sweep_of(double thickness, double steepest, double band = 0.2) {
  return toml::parse(sweep_text(thickness, base_of(band, steepest), {}, {}));
}

TEST(SweepProposal, FrictionIsAtMostThatOfTheBlock) {
  const std::string key = "basal.friction_angle";
  for (const auto& [steepest, low, high] : {std::array{50.0, 20.0, 35.0}, {30.4, 18.0, 30.0}, {12.9, 7.2, 12.0}}) {
    EXPECT_EQ(number(sweep_of(30.0, steepest), "range", key, 0), low);
    EXPECT_EQ(number(sweep_of(30.0, steepest), "range", key, 1), high);
  }
  EXPECT_LT(number(sweep_of(30.0, 0.0), "range", key, 0), number(sweep_of(30.0, 0.0), "range", key, 1));
}

TEST(SweepProposal, TheBandIsAtMostATwentiethOfTheSlide) {
  for (const auto& [thickness, band, low, high] : {std::array{90.0, 0.2, 0.1, 1.0},
                                                   {90.0, 2.0, 0.1, 2.0},
                                                   {20.0, 2.0, 0.1, 1.0},
                                                   {4.0, 0.2, 0.1, 0.2},
                                                   {1.0, 0.2, 0.025, 0.05}}) {
    const toml::table text = sweep_of(thickness, 30.0, band);
    EXPECT_NEAR(number(text, "range", "band.thickness", 0), low, 1e-9);
    EXPECT_NEAR(number(text, "range", "band.thickness", 1), high, 1e-9);
  }
}

TEST(SweepProposal, MembersAreAsStiffAsTheirWeightNeeds) {
  for (const auto& [thickness, modulus] : {std::array{2.0, 2e6}, {20.0, 2e7}, {21.0, 3e7}, {90.0, 9e7}, {300.0, 1e8}}) {
    const toml::table text = sweep_of(thickness, 30.0);
    const auto found = text["sweep"]["set"]["material.rock_ice.youngs_modulus"].value<double>();
    EXPECT_NEAR(found.value(), modulus, 1e-6 * modulus) << thickness;
  }
}

TEST(SweepProposal, MembersHaveTheCellsOfQuick) {
  EXPECT_FALSE(sweep_of(30.0, 30.0)["sweep"]["set"]["grid.cell"]);
  Proposal quick;
  quick.cell = 12.0;
  quick.min = {0.0, 24.0, 48.0};
  quick.max = {480.0, 504.0, 528.0};
  const toml::table text = toml::parse(sweep_text(30.0, base_of(0.2, 30.0), quick, {}));
  EXPECT_EQ(text["sweep"]["set"]["grid.cell"].value<double>(), 12.0);
  EXPECT_EQ(number(text, "set", "grid.min", 1), 24.0);
  EXPECT_EQ(number(text, "set", "grid.max", 2), 528.0);
}

TEST(SweepProposal, SubstratesHaveTheirRanges) {
  const std::string key = "substrate.valley_floor.friction_coefficient";
  const toml::table text =
      toml::parse(sweep_text(30.0, base_of(0.2, 30.0), {}, {{"glacier", "a.gpkg"}, {"valley_floor", "b.gpkg"}}));
  EXPECT_EQ(number(text, "range", key, 0), 0.1);
  EXPECT_EQ(number(text, "range", key, 1), 0.3);
  EXPECT_FALSE(text["sweep"]["range"]["substrate.snow.friction_coefficient"]);
}

}  // namespace
}  // namespace thawslide::config
