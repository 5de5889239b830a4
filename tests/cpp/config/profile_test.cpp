// Terrain profiles: accepted formats, and messages for invalid lines.
#include "case_messages.hpp"
#include "config/profile_csv.hpp"

namespace thawslide::config {
namespace {

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
  const std::string file = "FOLDER/profile.csv:";
  const std::string header = "distance_m,terrain_elevation_m,surface_elevation_m\n";
  const std::string headers = "allowed: distance_m,terrain_elevation_m[,surface_elevation_m]";
  for (const std::string text : {"", "# only a comment\n"}) {
    EXPECT_EQ(error_of_profile(text), file + "1: the file holds no header; " + headers + ".");
  }
  EXPECT_EQ(error_of_profile("# profile\nx,z\n"),
            file + "2: the header is 'x,z'; " + headers + ", separated by commas.");
  EXPECT_EQ(error_of_profile("distance_m\tterrain_elevation_m\n0\t1\n"),
            file +
                "1: the columns are separated by tabs; allowed: commas. Replace them: sed -i 's/\\t/,/g' "
                "FOLDER/profile.csv.");
  EXPECT_EQ(error_of_profile(std::string("II*\0\10\0,\0\n", 9)),
            file +
                "1: this is not a text file; allowed: columns separated by commas under the header "
                "distance_m,terrain_elevation_m[,surface_elevation_m]. A DEM is read with terrain.type = \"dem\".");
  EXPECT_EQ(error_of_profile(header + "0,0,0\n"), file + "2: the profile has 1 rows; a profile needs at least 2.");
  EXPECT_EQ(error_of_profile(header + "0,0\n"), file + "2: the row has 2 fields; the header has 3.");
  const std::string number = "'; allowed: a finite number with a decimal point.";
  EXPECT_EQ(error_of_profile(header + "0,0,0\n1,1m,2\n"), file + "3: terrain_elevation_m is '1m" + number);
  EXPECT_EQ(error_of_profile(header + "0,0,0\n1,,0\n"), file + "3: terrain_elevation_m is '" + number);
  EXPECT_EQ(error_of_profile(header + "0,0,nan\n"), file + "2: surface_elevation_m is 'nan" + number);
  EXPECT_EQ(error_of_profile(header + "0,0,0\n5,0,-1\n"),
            file +
                "3: surface_elevation_m is -1, below terrain_elevation_m, 0; allowed: the same elevation or a "
                "higher one.");
  for (const std::string distance : {"5", "4"}) {
    EXPECT_EQ(error_of_profile(header + "# a remark\n\n0,0,0\n5,0,0\n" + distance + ",1,1\n"),
              file + "6: the profile folds back: distance_m is " + distance +
                  " after 5; allowed: strictly increasing distances. Sort the rows, and leave out overhangs and "
                  "repeated points.");
  }
}

TEST(Profile, MistakesAreReportedAtTheKeyOfTheFile) {
  write_next_to_the_case("profile.csv", "distance_m,terrain_elevation_m\n0,0\n50,10\n40,12\n100,0\n");
  EXPECT_EQ(error_of_changed({{"type = \"flat\"\nelevation = 0.0", "type = \"profile\"\nfile = \"profile.csv\""}}),
            "FOLDER/case.toml:10:8: terrain.file: FOLDER/profile.csv:4: the profile folds back: distance_m is 40 after "
            "50; allowed: strictly increasing distances. Sort the rows, and leave out overhangs and repeated points.");
}

TEST(Profile, MissingFile) {
  EXPECT_EQ(error_of([] { read_profile("/nowhere/profile.csv"); }),
            "/nowhere/profile.csv: the profile cannot be read. Check that the file is there and may be read.");
}

}  // namespace
}  // namespace thawslide::config
