// Options that have no effect with band columns are refused.
#include <array>

#include "case_messages.hpp"

namespace thawslide::config {
namespace {

using namespace case_messages;

const std::string on_columns = changed({{"[basal]", "[band]\nmodel = \"columns\"\nthickness = 0.5\n[basal]"}});

TEST(Columns, RefuseOptionsOfTheHeatAndWaterOfParticles) {
  // Key, given value, its name in the message, allowed values.
  const std::vector<std::array<std::string, 4>> refused{
      {"mechanics.enabled", "false", "false", "true"},
      {"mechanics.effective_stress", "true", "true", "false"},
      {"heat.enabled", "false", "false", "true"},
      {"heat.advection", "false", "false", "true"},
      {"heat.advection_form", "as_published", "\"as_published\"", "\"conservative\""},
      {"heat.boundary.x_max", "{temperature = 5}", "not \"insulated\"", "\"insulated\""},
      {"pressure.clapeyron", "published", "\"published\"", "\"usual\""},
      {"pressure.volumetric_term", "true", "true", "false"},
      {"pressure.seepage_scaling", "published", "\"published\"", "\"consistent\""},
      {"pressure.frozen", "ice_pressure", "\"ice_pressure\"", "\"none\""},
      {"pressure.frozen_rows", "draining", "\"draining\"", "\"sealed\" or \"vented\""},
      {"pressure.melt_contraction", "false", "false", "true"},
      {"band.thickness_change", "as_published", "\"as_published\"", "\"conserving\""}};
  EXPECT_EQ(error_of_text(on_columns), "no error");
  for (const auto& [key, value, found, allowed] : refused) {
    const std::string set = key + "=" + value;
    EXPECT_EQ(error_of_text(on_columns, {set}), "--set " + set + ": band.model is \"columns\", and " + key + " is " +
                                                    found + "; allowed with it: " + allowed + ". Set " + key +
                                                    " so, or band.model = \"scaled\".");
    EXPECT_EQ(error_of_text(on_columns, {set, "band.model=scaled"}), "no error") << key;
  }
}

TEST(Columns, RefuseKeysOfTheOtherBandModel) {
  const auto error = [](const std::string& set, const std::string& more = "time.end=2.0") {
    return error_of_text(on_columns, {more, set});
  };
  for (const std::string set : {"band.region=first_layer", "band.cut_cells=equal_thickness"}) {
    EXPECT_EQ(error(set), "--set " + set + ": " + set.substr(0, set.find('=')) +
                              " has a meaning only when band.model is \"scaled\". Remove it, or change band.model.");
    EXPECT_EQ(error(set, "band.model=scaled"), "no error");
  }
  for (const std::string set : {"band.growth=inertial", "band.mixing_slip=100", "band.load_time=2.0",
                                "band.column_step=0.1", "band.ground_temperature=-5"}) {
    EXPECT_EQ(error(set, "band.model=scaled"),
              "--set " + set + ": " + set.substr(0, set.find('=')) +
                  " has a meaning only when band.model is \"columns\". Remove it, or change band.model.");
    EXPECT_EQ(error(set), "no error");
  }
}

TEST(Columns, RefuseParametersOfAnotherGrowthLaw) {
  const auto without_meaning = [](const std::string& set, const std::string& growth) {
    return "--set " + set + ": " + set.substr(0, set.find('=')) +
           " has a meaning only when band.model is \"columns\" and band.growth is \"" + growth +
           "\". Remove it, or change band.growth.";
  };
  const std::string rate = "band.growth_per_slip=0.01";
  EXPECT_EQ(error_of_text(on_columns, {rate}), without_meaning(rate, "slip"));
  EXPECT_EQ(error_of_text(on_columns, {rate, "band.growth=slip"}), "no error");
  for (const std::string set : {"band.grain_size=0.1", "band.inertial_number=0.5"}) {
    EXPECT_EQ(error_of_text(on_columns, {set}), without_meaning(set, "inertial"));
    EXPECT_EQ(error_of_text(on_columns, {set, "band.growth=inertial"}), "no error");
  }
}

}  // namespace
}  // namespace thawslide::config
