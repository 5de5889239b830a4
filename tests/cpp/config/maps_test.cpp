// Keys of a DEM, of releases, of fields from maps, of maps and probes: reading and defaults.
#include <set>

#include "case_messages.hpp"
#include "config/describe.hpp"
#include "config/named_files.hpp"

namespace thawslide::config {
namespace {

namespace fs = std::filesystem;
using namespace case_messages;
using testing_support::case_from_text;

class Maps : public testing::Test {
 protected:
  void SetUp() override { write_map_files(); }

  static Case read(const std::vector<Change>& changes, const std::vector<std::string>& sets = {}) {
    return case_from_text(changed(changes, valid_case_on_dem), sets);
  }
  static std::string path_of(const std::string& name) { return (folder_of_this_test() / name).string(); }
};

TEST_F(Maps, AreSetOnTheCommandLine) {
  const std::string file = fs::relative(folder_of_this_test() / "map.tif", fs::current_path()).string();
  const Case found = read({}, {"body.slide.thickness={ surface = \"" + file + "\" }", "terrain.file=" + file});
  EXPECT_EQ(found.bodies.at("slide").thickness.from, MapValue::From::surface);
  for (const fs::path path : {found.bodies.at("slide").thickness.source, found.terrain.file}) {
    EXPECT_TRUE(fs::equivalent(path, folder_of_this_test() / "map.tif"));
    EXPECT_TRUE(path.is_absolute());
  }
}

TEST_F(Maps, AreSmoothedByANumberOrAsTheirNoiseNeeds) {
  const Case given = read({{"[terrain]", "[terrain]\nsmooth = 2.5"}});
  EXPECT_FALSE(given.terrain.smooth.is_auto);
  EXPECT_EQ(given.terrain.smooth.number, 2.5);
  EXPECT_EQ(read({{"[terrain]", "[terrain]\nsmooth = 0"}}).terrain.smooth.number, 0.0);
  EXPECT_TRUE(read({{"[terrain]", "[terrain]\nsmooth = \"auto\""}}).terrain.smooth.is_auto);
  EXPECT_TRUE(read({{"[terrain]", "[terrain]\nsmooth = 2.5"}}, {"terrain.smooth=\"auto\""}).terrain.smooth.is_auto);
}

TEST_F(Maps, SaturationAndIceContentReplaceTemperatureAndPorosity) {
  const Case found =
      read({{"thickness = 10.0",
             "thickness = 10.0\nsaturation = { depth = [0.0, 9.0], value = [0.3, 0.1] }\nice_content = 0.3"}});
  EXPECT_EQ(found.bodies.at("slide").saturation.at(9.0, 0.0), 0.1);
  EXPECT_EQ(found.bodies.at("slide").ice_content.at(0.0, 0.0), 0.3);
  for (const char* key : {"\ntemperature =", "\nporosity ="}) {
    EXPECT_EQ(resolved_toml(found, "inputs").find(key), std::string::npos) << "it follows";
  }
}

// A run copies the files listed by named_files, and its case.toml names the copies.
TEST_F(Maps, AreCopiedWithTheRun) {
  for (const char* name : {"release.shp", "before.asc", "water.tif", "section.geojson"}) {
    write_next_to_the_case(name, "");
  }
  const Case found =
      read({{"release.geojson", "release.shp"},
            {"thickness = 10.0", "thickness = { surface = \"before.asc\" }\nsaturation = { raster = \"water.tif\" }"},
            {"[basal]",
             "[body.other]\nmaterial = \"rock\"\nshape = \"release\"\nrelease = \"release.shp\"\n"
             "thickness = { attribute = \"map.tif\" }\ntemperature = { raster = \"map.tif\" }\n"
             "[maps]\npath = \"line.geojson\"\n[probe.section]\nline = \"section.geojson\"\n[basal]"}});
  std::set<std::string> names;
  for (const auto& [file, is_map] : named_files(found)) {
    EXPECT_EQ(is_map, file.filename() != "case.toml") << file;
    EXPECT_EQ(file.parent_path(), folder_of_this_test());
    EXPECT_TRUE(names.insert(file.filename().string()).second) << file << " is listed once";
  }
  EXPECT_EQ(names, (std::set<std::string>{"case.toml", "dem.tif", "release.shp", "before.asc", "water.tif", "map.tif",
                                          "line.geojson", "section.geojson"}));
  const fs::path run = folder_of_this_test() / "run";
  for (const std::string& name : names) {
    write_next_to_the_case("run/inputs/" + name, "");
  }
  const std::string resolved = resolved_toml(found, "inputs");
  write_next_to_the_case("run/case.toml", resolved);
  const Case again = read_case(run);
  EXPECT_EQ(resolved_toml(again, "inputs"), resolved);
  EXPECT_EQ(again.bodies.at("slide").release, (run / "inputs" / "release.shp").string());
  EXPECT_EQ(again.bodies.at("other").thickness.source, "map.tif") << "an attribute is not a file";
  for (const auto& [file, is_map] : named_files(again)) {
    EXPECT_TRUE(file == run / "case.toml" || file.parent_path() == run / "inputs") << file;
  }
}

TEST_F(Maps, AreOfThreeDimensions) {
  EXPECT_EQ(resolved_toml(case_from_text(valid_case), "inputs").find("[maps]"), std::string::npos);
}

}  // namespace
}  // namespace thawslide::config
