// The reference of the case file in its four formats.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "config/declaration.hpp"
#include "config/describe.hpp"

namespace thawslide::config {
namespace {

using Json = nlohmann::json;

// Text from a title to the beginning of the next part.
std::string section(const std::string& text, const std::string& title, const std::string& next) {
  const std::size_t begin = text.find(title);
  EXPECT_NE(begin, std::string::npos) << title;
  return begin == std::string::npos ? "" : text.substr(begin, text.find(next, begin + 1) - begin);
}

TEST(Reference, DeclaresEveryKeyOnceWithItsKeywords) {
  std::set<std::string> seen;
  for (const auto& table : tables()) {
    EXPECT_FALSE(table->text.empty()) << table->name;
    for (const Entry& entry : table->entries()) {
      EXPECT_TRUE(seen.insert(table->name + "." + entry.rule->key).second) << table->name << "." << entry.rule->key;
      EXPECT_FALSE(entry.rule->text.empty()) << table->name << "." << entry.rule->key;
      EXPECT_FALSE(entry.type.empty()) << table->name << "." << entry.rule->key;
      const int directions = (entry.required.empty() ? 0 : 1) + (entry.default_text.empty() ? 0 : 1);
      EXPECT_TRUE(directions == 1 || !entry.otherwise.empty()) << "absent " << table->name << "." << entry.rule->key;
    }
  }
  EXPECT_GT(seen.size(), 90U);
}

TEST(Reference, TextAndMarkdownContainEveryTableAndKey) {
  const std::string text = describe_text(), markdown = describe_markdown();
  for (const auto& table : tables()) {
    const std::string part = section("\n" + text, "\n" + table->title() + "  " + table->text + "\n", "\n\n");
    const std::string of_page = section(markdown, "\n## `" + table->title() + "`\n", "\n## ");
    for (const Entry& entry : table->entries()) {
      SCOPED_TRACE(table->title() + entry.rule->key);
      EXPECT_NE(part.find("\n  " + entry.rule->key + " "), std::string::npos);
      EXPECT_NE(part.find(entry.rule->text), std::string::npos);
      EXPECT_NE(of_page.find("\n| `" + entry.rule->key + "` | " + entry.rule->unit + " | "), std::string::npos);
    }
  }
}

TEST(Reference, JsonContainsEveryTableAndKeyInOrder) {
  const Json json = Json::parse(describe_json());
  ASSERT_EQ(json.size(), tables().size());
  for (std::size_t t = 0; t < json.size(); ++t) {
    const std::vector<Entry> entries = tables()[t]->entries();
    EXPECT_EQ(json[t].at("table"), tables()[t]->title());
    ASSERT_EQ(json[t].at("keys").size(), entries.size()) << tables()[t]->title();
    for (std::size_t k = 0; k < entries.size(); ++k) {
      const Json& key = json[t].at("keys")[k];
      EXPECT_EQ(key.at("key"), entries[k].rule->key);
      EXPECT_EQ(key.at("unit"), entries[k].rule->unit);
      EXPECT_EQ(key.at("text"), entries[k].rule->text);
      EXPECT_EQ(key.at("only"), entries[k].only);
      EXPECT_EQ(key.at("keywords").size(), entries[k].keywords.size());
      EXPECT_EQ(key.at("default").is_null(), entries[k].default_text.empty()) << entries[k].rule->key;
    }
  }
}

TEST(Reference, SchemaContainsEveryTableAndKey) {
  const Json schema = Json::parse(schema_json());
  EXPECT_EQ(schema.at("additionalProperties"), false);
  for (const auto& table : tables()) {
    const std::size_t dot = table->name.find('.');
    const Json* node = &schema.at("properties").at(table->name.substr(0, dot));
    if (dot != std::string::npos) {
      node = &node->at("properties").at(table->name.substr(dot + 1));
    }
    const Json& own = table->is_named() ? node->at("additionalProperties") : *node;
    EXPECT_EQ(own.at("additionalProperties"), false) << table->title();
    for (const Entry& entry : table->entries()) {
      EXPECT_TRUE(own.at("properties").contains(entry.rule->key)) << table->title() << entry.rule->key;
    }
  }
  const Json& body = schema.at("properties").at("body").at("additionalProperties").at("properties");
  EXPECT_EQ(body.at("shape").at("enum"), Json({"box", "polygon", "surface", "release"}));
  EXPECT_EQ(schema.at("properties").at("grid").at("properties").at("cell").at("exclusiveMinimum"), 0.0);
  EXPECT_TRUE(schema.at("properties").at("grid").at("properties").contains("boundary"));
  EXPECT_TRUE(schema.at("properties").at("grid").at("properties").contains("cell"))
      << "a table inside a table leaves its keys";
}

TEST(Reference, StatesUnitRangeDefaultKeywordsAndNeed) {
  const std::string text = describe_text();
  const auto expect = [&](const std::string& part) { EXPECT_NE(text.find(part), std::string::npos) << part; };
  expect(
      "  youngs_modulus            Young's modulus [Pa]\n"
      "                            a number, > 0 [Pa]; required when mechanics.enabled is true; Lei et al., Tables 2, "
      "3\n");
  expect("a number, > 0 [s]; required when time.stepping is \"fixed\"; otherwise no upper limit\n");
  expect(
      "{ raster = \"FILE\" }, > 0 and <= 0.95; default: 0.375; only when ice_content is not given; Lei et al., Eq. 1, "
      "Table 2\n");
  expect("a number, >= 0 [1/Pa]; usually 1e-09 to 1e-07 (assumption); default: 2e-09\n");
  expect("\"keep_cohesion\": mu_e max(0, N - P) + c_S: cohesion is kept\n");
  const Json all = Json::parse(describe_json());
  EXPECT_EQ(all[1]["keys"][0]["key"], "end");
  EXPECT_EQ(all[1]["keys"][0]["required"], "always");
  EXPECT_TRUE(all[1]["keys"][0]["default"].is_null());
  EXPECT_EQ(all[1]["keys"][3]["default"], "0.8");
}

TEST(Schema, SpecifiesTypesRangesKeywordsAndRequiredKeys) {
  const Json schema = Json::parse(schema_json())["properties"];
  EXPECT_EQ(schema["time"]["required"], Json::array({"end"}));
  EXPECT_EQ(schema["time"]["properties"]["end"]["exclusiveMinimum"], 0.0);
  EXPECT_EQ(schema["basal"]["properties"]["heat_fraction"]["maximum"], 1.0);
  EXPECT_EQ(schema["terrain"]["properties"]["type"]["enum"], Json::array({"none", "flat", "plane", "profile", "dem"}));
  EXPECT_EQ(schema["body"]["additionalProperties"]["required"], Json::array({"material"}));
  EXPECT_EQ(schema["body"]["additionalProperties"]["properties"]["porosity"]["anyOf"].size(), 5U);
  const Json& thickness = schema["body"]["additionalProperties"]["properties"]["thickness"]["anyOf"];
  ASSERT_EQ(thickness.size(), 4U);
  EXPECT_EQ(thickness[0]["exclusiveMinimum"], 0.0);
  EXPECT_EQ(thickness[3]["required"], Json::array({"surface"}));
  EXPECT_EQ(schema["body"]["additionalProperties"]["properties"]["polygons"]["items"]["type"], "string");
  EXPECT_EQ(schema["probe"]["additionalProperties"]["properties"]["point"]["maxItems"], 2);
  EXPECT_EQ(schema["heat"]["properties"]["boundary"]["properties"]["z_max"]["anyOf"].size(), 3U);
}

}  // namespace
}  // namespace thawslide::config
