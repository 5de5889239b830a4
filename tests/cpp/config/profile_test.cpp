// Terrain profiles: what is read, and what each wrong line is told.
#include "config/profile_csv.hpp"
#include "sound_case.hpp"

namespace thawslide::config {
namespace {

std::string message_of_profile(const std::string& text) {
  write_input("profile.csv", text);
  const std::string file = (case_folder() / "profile.csv").string();
  try {
    read_profile(file);
  } catch (const UserError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.substr(0, file.size()), file);
    return message.substr(file.size());
  }
  return "no error";
}

TEST(Profile, IsReadWithCommentsBlankLinesMarksAndWindowsLineEnds) {
  write_input("profile.csv",
              "\xEF\xBB\xBF# a comment\r\ndistance_m, terrain_elevation_m, surface_elevation_m\r\n\r\n"
              "-10, +5.5, 5.5\r\n# between\r\n0,1e1,12\r\n20,0,0");
  const ProfileTable profile = read_profile(case_folder() / "profile.csv");
  EXPECT_EQ(profile.distance, (std::vector<double>{-10.0, 0.0, 20.0}));
  EXPECT_EQ(profile.terrain, (std::vector<double>{5.5, 10.0, 0.0}));
  EXPECT_EQ(profile.surface, (std::vector<double>{5.5, 12.0, 0.0}));
}

TEST(Profile, WithoutSurface) {
  write_input("profile.csv", "distance_m,terrain_elevation_m\n0,1\n1,2\n");
  EXPECT_TRUE(read_profile(case_folder() / "profile.csv").surface.empty());
}

TEST(Profile, GroundIsLinearBetweenRowsAndGoesOnBeyondThem) {
  const ProfileTable profile{{0.0, 10.0, 20.0}, {0.0, 5.0, 4.0}, {}};
  EXPECT_DOUBLE_EQ(profile.terrain_at(4.0), 2.0);
  EXPECT_DOUBLE_EQ(profile.terrain_at(10.0), 5.0);
  EXPECT_DOUBLE_EQ(profile.terrain_at(15.0), 4.5);
  EXPECT_DOUBLE_EQ(profile.terrain_at(-2.0), -1.0);
  EXPECT_DOUBLE_EQ(profile.terrain_at(30.0), 3.0);
}

TEST(Profile, MistakesNameTheLine) {
  const std::string header = "distance_m,terrain_elevation_m,surface_elevation_m\n";
  EXPECT_EQ(message_of_profile("# only a comment\n"),
            ":1: the file holds no header; allowed: distance_m,terrain_elevation_m[,surface_elevation_m].");
  EXPECT_EQ(message_of_profile(""),
            ":1: the file holds no header; allowed: distance_m,terrain_elevation_m[,surface_elevation_m].");
  EXPECT_EQ(message_of_profile("# profile\nx,z\n"),
            ":2: the header is 'x,z'; allowed: distance_m,terrain_elevation_m[,surface_elevation_m], separated by "
            "commas.");
  EXPECT_EQ(message_of_profile(header + "0,0,0\n"), ":2: the profile has 1 rows; a profile needs at least 2.");
  EXPECT_EQ(message_of_profile(header + "0,0\n"), ":2: the row has 2 fields; the header has 3.");
  EXPECT_EQ(message_of_profile(header + "0,0,0\n1,high,0\n"),
            ":3: terrain_elevation_m is 'high'; allowed: a finite number with a decimal point.");
  EXPECT_EQ(message_of_profile(header + "0,0,0\n1,,0\n").substr(0, 29), ":3: terrain_elevation_m is ''");
  EXPECT_EQ(message_of_profile(header + "0,0,nan\n").substr(0, 33), ":2: surface_elevation_m is 'nan';");
  EXPECT_EQ(
      message_of_profile(header + "0,0,0\n5,0,-1\n"),
      ":3: surface_elevation_m is -1, below terrain_elevation_m, 0; allowed: the same elevation or a higher one.");
  EXPECT_EQ(message_of_profile(header + "0,0,0\n5,0,0\n5,1,1\n"),
            ":4: the profile folds back: distance_m is 5 after 5; allowed: strictly increasing distances. Sort the "
            "rows, and leave out overhangs and repeated points.");
}

TEST(Profile, MissingFile) {
  try {
    read_profile("/nowhere/profile.csv");
    FAIL() << "there is no such file";
  } catch (const UserError& error) {
    EXPECT_STREQ(error.what(),
                 "/nowhere/profile.csv: the profile cannot be read. Check that the file is there and may be read.");
  }
}

}  // namespace
}  // namespace thawslide::config
