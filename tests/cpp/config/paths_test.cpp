// Paths in a case: allowed locations and file names. Messages are compared completely, with their location.
#include "case_messages.hpp"

namespace thawslide::config {
namespace {

namespace fs = std::filesystem;
using namespace case_messages;

const std::string header = "distance_m,terrain_elevation_m\n";
const Change profile{"type = \"flat\"\nelevation = 0.0", "type = \"profile\"\nfile = \"profile.csv\""};

TEST(Paths, DoNotLeaveTheFolderOfTheCase) {
  const auto with_file = [](const std::string& file) {
    return error_of_changed({{"type = \"flat\"\nelevation = 0.0", "type = \"profile\"\nfile = \"" + file + "\""}});
  };
  const fs::path folder = folder_of_this_test();
  fs::remove_all(folder);
  write_next_to_the_case("profile.csv", header + "0,0\n100,0\n");
  fs::create_directories(folder / "inside");
  const fs::path outside = folder.string() + ".csv";
  fs::copy_file(folder / "profile.csv", outside, fs::copy_options::overwrite_existing);
  fs::create_symlink(outside, folder / "link.csv");
  const std::string remedy =
      ", which lies outside the folder of the case file; allowed: a file in that folder. Copy it there, or give its "
      "path with --set terrain.file=PATH.";
  for (const std::string& file : {"../" + outside.filename().string(), std::string("/nowhere/profile.csv"),
                                  "inside/../../" + outside.filename().string(), std::string("link.csv")}) {
    const std::string found = with_file(file);
    EXPECT_EQ(found, "FOLDER/case.toml:10:8: terrain.file is \"" + file + "\"" + remedy);
  }
  EXPECT_EQ(with_file("inside/../profile.csv"), "no error");
  EXPECT_EQ(with_file("no_profile.csv"),
            "FOLDER/case.toml:10:8: terrain.file is \"no_profile.csv\": no such file (FOLDER); did you mean "
            "'profile.csv'? Allowed: a file, relative to the folder of the case file.");
  EXPECT_EQ(with_file("profile.csv\\u0000"),
            "FOLDER/case.toml:10:8: terrain.file is \"profile.csv?\", a name with a zero byte; allowed: a file.");
  EXPECT_EQ(with_file("new\\nline"),
            "FOLDER/case.toml:10:8: terrain.file is \"new?line\": no such file (FOLDER); allowed: a file, relative to "
            "the folder of the case file.");
  EXPECT_EQ(error_of_changed({profile}, {"terrain.file=" + outside.string()}), "no error")
      << "allowed on the command line";
  fs::remove(outside);
}

TEST(Paths, MustNotBeEmptyIfAFileIsNeeded) {
  EXPECT_EQ(error_of_changed({{"type = \"flat\"\nelevation = 0.0", "type = \"profile\"\nfile = \"\""}}),
            "FOLDER/case.toml:10:8: terrain.file is empty, and it is needed when terrain.type is \"profile\" or "
            "\"dem\". Allowed: file of the terrain; profile: CSV file with the columns "
            "distance_m,terrain_elevation_m[,surface_elevation_m]; dem: GeoTIFF or ESRI ASCII grid, the path of a "
            "file, in quotes.");
}

}  // namespace
}  // namespace thawslide::config
