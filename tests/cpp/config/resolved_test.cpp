// The resolved case contains every key, as given or by default, and is read back to the same case.
#include <map>
#include <sstream>

#include "config/declaration.hpp"
#include "config/describe.hpp"
#include "every_key.hpp"

namespace thawslide::config {
namespace {

namespace fs = std::filesystem;
using namespace case_messages;
using testing_support::case_from_text;
using Lines = std::map<std::string, std::map<std::string, std::string>>;  // value by table and key

Lines lines_of(const std::string& text) {
  Lines lines;
  std::istringstream stream(text);
  std::string table;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line.front() == '[') {
      table = line.substr(1, line.size() - 2);
    } else if (const std::size_t equals = line.find(" = "); equals != std::string::npos && line.front() != '#') {
      const std::size_t unit = line.find("  # ");
      lines[table][line.substr(0, equals)] =
          line.substr(equals + 3, unit == std::string::npos ? unit : unit - equals - 3);
    }
  }
  return lines;
}

Case read_with_inputs(const std::string& text) {
  write_next_to_the_case("inputs/profile.csv", "distance_m,terrain_elevation_m\n0,0\n50,-1\n");
  write_next_to_the_case("inputs/logo.png", "");
  write_next_to_the_case("inputs/targets.csv", "quantity,time_s,value,unit,source\n");
  write_next_to_the_case("inputs/force.csv", "time_s,up_N,north_N,east_N\n0,0,0,0\n1,0,0,0\n");
  for (const std::string name : {"dem.tif", "path.geojson", "section.geojson", "release.shp", "thickness.tif",
                                 "saturation.tif", "before.tif", "codes.tif"}) {
    write_next_to_the_case("inputs/" + name, "");
  }
  return case_from_text(text);
}

// Name in the case of the table that the reference calls [body.NAME].
std::string own_name(const TableDeclaration& table) {
  const std::map<std::string, std::string> names{{"material", "rock"}, {"body", "block"},    {"frame", "wall"},
                                                 {"probe", "gauge"},   {"substrate", "ice"}, {"contact_pair", "seam"}};
  return table.is_named() ? table.name + "." + names.at(table.name) : table.name;
}

TEST(Resolved, WritesEveryKeyAsItWasGivenAndReadsBack) {
  Lines given, resolved;
  for (const std::string& text : {every_key, rest_in_3d, between_walls, release_on_dem, release_of_a_surface()}) {
    const std::string written = resolved_toml(read_with_inputs(text), "inputs");
    EXPECT_EQ(resolved_toml(read_with_inputs(written), "inputs"), written);
    for (const auto& [table, keys] : lines_of(text)) {
      for (const auto& [key, value] : keys) {
        given[table].emplace(key, value);
        EXPECT_EQ(lines_of(written)[table][key], value) << table << '.' << key;
      }
    }
  }
  // The texts contain every key, none with its default value.
  for (const auto& table : tables()) {
    for (const Entry& entry : table->entries()) {
      if (entry.rule->key == "based_on") {
        continue;  // a resolved case has no base case; see changed_cases_test.cpp
      }
      const std::string value = given[own_name(*table)][entry.rule->key];
      EXPECT_NE(value, "") << table->name << '.' << entry.rule->key << " is not tested";
      EXPECT_NE(value, entry.default_text) << table->name << '.' << entry.rule->key << " is tested at its default";
    }
  }
}

TEST(Resolved, WritesDefaultsAndUnitsButNoIrrelevantKeys) {
  const std::string text = resolved_toml(case_from_text(valid_case), "inputs");
  const Lines lines = lines_of(text);
  EXPECT_EQ(lines.at("phases").at("latent_heat"), "333500.0");
  EXPECT_EQ(lines.at("material.rock").at("tension_cutoff"), "inf");
  EXPECT_EQ(lines.at("grid.boundary").at("x_min"), "\"open\"");
  EXPECT_EQ(lines.at("grid.boundary").count("z_min"), 0U);       // in 3D only
  EXPECT_EQ(lines.at("basal").count("cohesion_loss_time"), 0U);  // not needed, and without a default
  EXPECT_EQ(text.find("\nthickness ="), std::string::npos);      // no band
  EXPECT_NE(text.find("\nlatent_heat = 333500.0  # J/kg, not given\n"), std::string::npos);
  EXPECT_NE(text.find("\ngravity_tilt = 0.0  # degrees, not given\n"), std::string::npos);
  EXPECT_NE(text.find("\nextend = false  # not given\n"), std::string::npos);
  EXPECT_NE(text.find("\nend = 2.0  # s\n"), std::string::npos) << "given";
}

TEST(Resolved, LamplughReadsBackToItself) {
  const Case lamplugh = read_case(fs::path(THAWSLIDE_SOURCE_DIR) / "cases" / "lamplugh");
  const std::string resolved = resolved_toml(lamplugh, "inputs");
  fs::create_directories(folder_of_this_test() / "inputs");
  for (const std::string& file : {lamplugh.terrain.file, lamplugh.report.targets, lamplugh.report.force_record}) {
    fs::copy_file(file, folder_of_this_test() / "inputs" / fs::path(file).filename(),
                  fs::copy_options::overwrite_existing);
  }
  const Case again = case_from_text(resolved);
  EXPECT_EQ(resolved_toml(again, "inputs"), resolved);
  EXPECT_EQ(again.band.thickness.table.abscissa, lamplugh.band.thickness.table.abscissa);
  EXPECT_EQ(again.terrain.file,
            (folder_of_this_test() / "inputs" / "lamplugh_profile.csv").lexically_normal().string());
  EXPECT_EQ(lines_of(resolved)["terrain"]["file"], "\"inputs/lamplugh_profile.csv\"");
}

// Numbers without a short decimal representation, a text with quotation marks, three dimensions, every kind of table.
TEST(Resolved, KeepsEveryBit) {
  const std::string text = changed({{"[time]", "[case]\ndimension = 3\ntitle = 'a \"b\" \\ c'\n[time]"},
                                    {"step = 0.001", "step = 0.00030000000000000003"},
                                    {"min = [0.0, -10.0]", "min = [0.0, 0.0, -10.0]"},
                                    {"max = [100.0, 50.0]", "max = [100.0, 50.0, 50.0]"},
                                    {"min = [0.0, 0.0]\nmax = [40.0", "min = [0.0, 0.0, 0.0]\nmax = [40.0, 30.0"},
                                    {"[basal]",
                                     "temperature = { depth = [0, 10, 10], value = [-1e-7, -2, -3] }\n"
                                     "porosity = { x = [0, 10], value = [0.1, 0.3333333333333333] }\n"
                                     "[grid.boundary]\ny_min = \"fixed\"\n"
                                     "[heat.boundary]\ny_max = { temperature = -5 }\n[basal]"}});
  const Case first = case_from_text(text);
  const std::string resolved = resolved_toml(first, "inputs");
  const Case second = case_from_text(resolved);
  EXPECT_EQ(resolved_toml(second, "inputs"), resolved);
  EXPECT_EQ(second.general.title, "a \"b\" \\ c");
  EXPECT_EQ(second.time.step, 0.00030000000000000003);
  EXPECT_EQ(second.grid.boundary, first.grid.boundary);
  EXPECT_EQ(second.heat.boundary[3].value, -5.0);
  EXPECT_EQ(second.bodies.at("block").max, (Point{40.0, 30.0, 20.0}));
  EXPECT_EQ(second.bodies.at("block").temperature.table.value, (std::vector<double>{-1e-7, -2.0, -3.0}));
  EXPECT_EQ(second.bodies.at("block").porosity.over, InitialField::Over::x);
  EXPECT_EQ(second.bodies.at("block").porosity.table.value[1], 0.3333333333333333);
}

}  // namespace
}  // namespace thawslide::config
