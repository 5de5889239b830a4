// Files that a case names: terrain profiles, allowed locations and names.

#include "case_messages.hpp"
#include "config/profile_csv.hpp"

namespace thawslide::config {
namespace {

namespace fs = std::filesystem;
using namespace case_messages;

// Error from reading a profile with this text.
std::string error_of_profile(const std::string& text) {
  write_next_to_the_case("profile.csv", text);
  return error_of([] { read_profile(folder_of_this_test() / "profile.csv"); });
}

TEST(Profile, IsReadWithCommentsBlankLinesMarksAndWindowsLineEnds) {
  write_next_to_the_case("profile.csv",
                         "\xEF\xBB\xBF# a comment\r\ndistance_m, terrain_elevation_m, surface_elevation_m\r\n\r\n"
                         "-10, +5.5, 5.5\r\n# between\r\n0,1e1,12\r\n20,0,0");
  const ProfileTable profile = read_profile(folder_of_this_test() / "profile.csv");
  EXPECT_EQ(profile.distance, (std::vector<double>{-10.0, 0.0, 20.0}));
  EXPECT_EQ(profile.terrain, (std::vector<double>{5.5, 10.0, 0.0}));
  EXPECT_EQ(profile.surface, (std::vector<double>{5.5, 12.0, 0.0}));
}

TEST(Profile, WithoutSurface) {
  write_next_to_the_case("profile.csv", "distance_m,terrain_elevation_m\n0,1\n1,2\n");
  EXPECT_TRUE(read_profile(folder_of_this_test() / "profile.csv").surface.empty());
}

TEST(Profile, GroundIsLinearBetweenRowsAndExtrapolatedBeyondThem) {
  const ProfileTable profile{{0.0, 10.0, 20.0}, {0.0, 5.0, 4.0}, {}};
  EXPECT_DOUBLE_EQ(profile.terrain_at(4.0), 2.0);
  EXPECT_DOUBLE_EQ(profile.terrain_at(10.0), 5.0);
  EXPECT_DOUBLE_EQ(profile.terrain_at(15.0), 4.5);
  EXPECT_DOUBLE_EQ(profile.terrain_at(-2.0), -1.0);
  EXPECT_DOUBLE_EQ(profile.terrain_at(30.0), 3.0);
}

TEST(Profile, MistakesNameTheLine) {
  const std::string header = "distance_m,terrain_elevation_m,surface_elevation_m\n";
  const std::string headers = "allowed: distance_m,terrain_elevation_m[,surface_elevation_m]";
  const std::string separated = ", separated by commas. A DEM is read with terrain.type = \"dem\".";
  const std::string number = "'; allowed: a finite number with a decimal point.";
  const std::string folds =
      "; allowed: strictly increasing distances. Sort the rows, and leave out overhangs and "
      "repeated points.";
  const std::vector<std::pair<std::string, std::string>> mistakes{
      {"", "1: the file holds no header; " + headers + "."},
      {"# only a comment\n", "1: the file holds no header; " + headers + "."},
      {"# profile\nx,z\n", "2: the header is 'x,z'; " + headers + separated},
      {"distance_m\tterrain_elevation_m\n0\t1\n",
       "1: the header is 'distance_m?terrain_elevation_m'; " + headers + separated},
      {std::string("II*\0\10\0,\0\n", 9), "1: the header is 'II*???,?'; " + headers + separated},
      {header + "0,0,0\n", "2: the profile has 1 rows; a profile needs at least 2."},
      {header + "0,0\n", "2: the row has 2 fields; the header has 3."},
      {header + "0,0,0\n1,1m,2\n", "3: terrain_elevation_m is '1m" + number},
      {header + "0,0,0\n1,,0\n", "3: terrain_elevation_m is '" + number},
      {header + "0,0,nan\n", "2: surface_elevation_m is 'nan" + number},
      {header + "0,0,0\n5,0,-1\n",
       "3: surface_elevation_m is -1, below terrain_elevation_m, 0; allowed: the same elevation or a higher one."},
      {header + "# a remark\n\n0,0,0\n5,0,0\n5,1,1\n", "6: the profile folds back: distance_m is 5 after 5" + folds},
      {header + "# a remark\n\n0,0,0\n5,0,0\n4,1,1\n", "6: the profile folds back: distance_m is 4 after 5" + folds}};
  for (const auto& [text, message] : mistakes) {
    EXPECT_EQ(error_of_profile(text), "FOLDER/profile.csv:" + message);
  }
}

TEST(Profile, MissingFile) {
  EXPECT_EQ(error_of([] { read_profile("/nowhere/profile.csv"); }),
            "/nowhere/profile.csv: the profile cannot be read. Check that the file is there and may be read.");
}

TEST(InputFiles, ThatAreFoldersAreRefused) {
  std::filesystem::create_directories(folder_of_this_test() / "data.csv");
  EXPECT_EQ(error_of_changed({{"type = \"flat\"\nelevation = 0.0", "type = \"profile\"\nfile = \"data.csv\""}}),
            "FOLDER/case.toml:10:8: terrain.file is \"data.csv\", a folder; allowed: a file.");
}

TEST(Paths, DoNotLeaveTheFolderOfTheCase) {
  const auto with_file = [](const std::string& file, const std::vector<std::string>& sets = {}) {
    return error_of_changed({{"type = \"flat\"\nelevation = 0.0", "type = \"profile\"\nfile = \"" + file + "\""}},
                            sets);
  };
  const fs::path folder = folder_of_this_test();
  fs::remove_all(folder);
  write_next_to_the_case("profile.csv", "distance_m,terrain_elevation_m\n0,0\n100,0\n");
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
  EXPECT_EQ(with_file("profile.csv", {"terrain.file=" + outside.string()}), "no error")
      << "allowed on the command line";
  fs::remove(outside);
}

}  // namespace
}  // namespace thawslide::config
