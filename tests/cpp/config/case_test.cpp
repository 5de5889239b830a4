// The case file: places of mistakes, what --set can do, and the resolved case.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "../support/case_from_text.hpp"
#include "base/error.hpp"
#include "config/declaration.hpp"
#include "config/describe.hpp"

namespace thawslide::config {
namespace {

namespace fs = std::filesystem;
using testing_support::case_from_text;

const std::string sound = R"([time]
end = 2.0
step = 0.001
[grid]
cell = 5.0
min = [0.0, -10.0]
max = [100.0, 50.0]
[terrain]
type = "flat"
elevation = 0.0
[material.rock]
law = "elastic"
youngs_modulus = 5e8
poisson_ratio = 0.2
[body.block]
material = "rock"
shape = "box"
min = [0.0, 0.0]
max = [40.0, 20.0]
[basal]
friction_angle = 20.0
)";

// The message for the case with one text replaced by another.
std::string message_of(const std::string& from, const std::string& to, const std::vector<std::string>& sets = {}) {
  std::string text = sound;
  text.replace(text.find(from), from.size(), to);
  try {
    case_from_text(text, sets);
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

void expect_message(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
  }
}

TEST(CaseFile, MistakesHavePlaceFindingAndRemedy) {
  expect_message(message_of("cell = 5.0", "cel = 5.0"), {"case.toml:5:", "'grid.cel'", "did you mean 'cell'?"});
  expect_message(message_of("cell = 5.0", "cell = \"five\""), {"case.toml:5:8", "the text \"five\"", "> 0"});
  expect_message(message_of("cell = 5.0", "cell = -5.0"), {"case.toml:5:8", "-5", "> 0"});
  expect_message(message_of("\"elastic\"", "\"elastik\""), {"case.toml:12:7", "elastik", "did you mean 'elastic'?"});
  expect_message(message_of("material = \"rock\"", "material = \"rok\""),
                 {"case.toml:16:", "no [material.rok]", "did you mean 'rock'?"});
  expect_message(message_of("[basal]", "[phases]\nrock_density = -1.0\n[basal]"), {"rock_density", "-1", "> 0"});
  expect_message(message_of("shape = \"box\"", "shape = \"box\"\nporosity = 1.0"), {"porosity", "1", "0.95"});
  expect_message(message_of("min = [0.0, 0.0]", "min = [0.0, -5.0]"), {"below the terrain", "-5", "Lift the body"});
  expect_message(message_of("max = [40.0, 20.0]", "max = [140.0, 20.0]"), {"outside the domain", "(100, 50)"});
  expect_message(message_of("max = [100.0, 50.0]", "max = [101.0, 50.0]"), {"whole number", "20.2 cells"});
  expect_message(message_of("cell = 5.0", "cell = = 5"), {"case.toml:5:", "this is not TOML"});
  expect_message(message_of("step = 0.001\n", ""), {"time.step", "time.stepping is \"fixed\""});
}

TEST(CaseFile, SeveralMistakesComeTogetherInOrder) {
  const std::string message =
      message_of("cell = 5.0", "cell = -5.0\ncolour = 1", {"basal.friction_angle=95", "band.thicknes=0.1"});
  const auto first = message.find("case.toml:5:");
  const auto second = message.find("case.toml:6:");
  const auto third = message.find("--set basal.friction_angle=95");
  const auto fourth = message.find("--set band.thicknes=0.1");
  EXPECT_NE(fourth, std::string::npos) << message;
  EXPECT_TRUE(first < second && second < third && second < fourth) << message;
  EXPECT_NE(message.find("did you mean 'thickness'?"), std::string::npos) << message;
}

TEST(CaseFile, SetReplacesNumbersWordsArraysAndTables) {
  const Case changed = case_from_text(
      sound, {"time.end=3", "mechanics.shape_function=linear", "grid.max=[200.0, 60.0]", "heat.enabled=false",
              "band.thickness={time=[0.0, 1.0], value=[0.05, 0.5]}", "body.block.temperature=-3.5"});
  EXPECT_EQ(changed.time.end, 3.0);
  EXPECT_EQ(changed.mechanics.shape_function, ShapeFunction::linear);
  EXPECT_EQ(changed.grid.max[0], 200.0);
  EXPECT_FALSE(changed.heat.enabled);
  EXPECT_DOUBLE_EQ(changed.band.thickness.at(0.5), 0.275);
  EXPECT_EQ(changed.bodies.at("block").temperature.at(0.0, 0.0), -3.5);
}

TEST(CaseFile, DefaultsAreThoseOfTheCase) {
  const Case read = case_from_text(sound);
  const Case fresh;
  EXPECT_EQ(read.phases.latent_heat, fresh.phases.latent_heat);
  EXPECT_EQ(read.basal.clamp, FrictionClamp::keep_cohesion);
  EXPECT_EQ(read.pressure.clapeyron, ClapeyronSign::usual);
  EXPECT_EQ(read.freezing.exponent, 5.0);
  EXPECT_TRUE(read.band.thickness.value.empty());
}

TEST(CaseFile, ResolvedReadsBackToItself) {
  const Case lamplugh = read_case(std::string(THAWSLIDE_SOURCE_DIR) + "/cases/lamplugh");
  const std::string resolved = resolved_toml(lamplugh, "inputs");
  const fs::path folder = fs::path(testing::TempDir()) / "resolved";
  fs::create_directories(folder / "inputs");
  for (const std::string& file : {lamplugh.terrain.file, lamplugh.report.targets}) {
    fs::copy_file(file, folder / "inputs" / fs::path(file).filename(), fs::copy_options::overwrite_existing);
  }
  std::ofstream(folder / "case.toml") << resolved;
  EXPECT_EQ(resolved_toml(read_case(folder), "inputs"), resolved);
}

TEST(Reference, HoldsEveryKeyInEveryForm) {
  const std::string text = describe_text(), json = describe_json(), markdown = describe_markdown(),
                    schema = schema_json();
  EXPECT_TRUE(nlohmann::json::accept(json));
  EXPECT_TRUE(nlohmann::json::accept(schema));
  std::size_t keys = 0;
  for (const auto& table : tables()) {
    for (const std::string& form : {text, json, markdown}) {
      EXPECT_NE(form.find(table->title()), std::string::npos) << table->title();
    }
    for (const Entry& entry : table->entries()) {
      ++keys;
      EXPECT_NE(markdown.find("| `" + entry.rule->key + "` |"), std::string::npos) << entry.rule->key;
      EXPECT_NE(schema.find("\"" + entry.rule->key + "\""), std::string::npos) << entry.rule->key;
      EXPECT_FALSE(entry.rule->text.empty()) << entry.rule->key;
    }
  }
  EXPECT_GT(keys, 90U);
}

}  // namespace
}  // namespace thawslide::config
