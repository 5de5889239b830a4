// Coordinate reference systems: usable ones, and error messages for the others.
#include "gis/reference_system.hpp"

#include "map_files.hpp"

namespace thawslide::gis {
namespace {

using namespace map_files;

const MapExtent metric_raster{"dem.tif", {49280.0, 193490.0, 52280.0, 195690.0}, 10.0};
const MapExtent degree_raster{"alps/dem.tif", {10.2, 46.85, 10.3, 46.95}, 1.0 / 3600.0};

std::string error_of_system(const MapExtent& raster, const std::string& of_file, const std::string& given = "") {
  return error_of([&] { return metric_system(raster, of_file.empty() ? "" : reference_system_named(of_file), given); });
}

TEST(ReferenceSystemTest, ProjectionsInMetresAreAccepted) {
  struct Row {
    const char *of_file, *given, *found;
  };
  // Heights are removed: their unit is that of the values, which are converted.
  for (const Row& row : {Row{"EPSG:31254", "", "EPSG:31254"}, Row{"EPSG:4326", "EPSG:31254", "EPSG:31254"},
                         Row{"EPSG:31254+5778", "", "EPSG:31254"}, Row{"EPSG:26910+6360", "", "EPSG:26910"}}) {
    EXPECT_EQ(name_of(metric_system(metric_raster, reference_system_named(row.of_file), row.given)), row.found);
  }
  EXPECT_EQ(name_of(metric_system(metric_raster, "", "EPSG:32632")), "EPSG:32632");
}

TEST(ReferenceSystemTest, UnusableSystemsAreRefused) {
  const MapExtent andes{"my dem.tif", {-77.7, -9.2, -77.6, -9.0}, 0.0001};
  const MapExtent in_feet{"dem.tif", {6000000.0, 2000000.0, 6010000.0, 2010000.0}, 10.0};
  struct Row {
    const MapExtent& raster;
    const char *of_file, *given;
  };
  for (const Row& row :
       {Row{metric_raster, "", "EPSG:26910+6360"}, Row{metric_raster, "", "32632"}, Row{metric_raster, "", ""},
        Row{degree_raster, "", ""}, Row{degree_raster, "EPSG:4326", ""}, Row{andes, "EPSG:4326", ""},
        Row{metric_raster, "EPSG:4326", ""}, Row{in_feet, "EPSG:2227", ""}, Row{metric_raster, "", "EPSG:99999"},
        Row{metric_raster, "EPSG:31254", "EPSG:4326"}, Row{metric_raster, "EPSG:31254", "EPSG:2227"},
        Row{metric_raster, "EPSG:4978", ""}}) {
    expect_message(error_of_system(row.raster, row.of_file, row.given));
  }
  EXPECT_EQ(error_of_system(metric_raster, "", "99999999").find("did you mean"), std::string::npos);
}

TEST(ReferenceSystemTest, FarOutsideTheAreaOfTheSystem) {
  const auto warning = [](const Rectangle& extent, const char* system) {
    return location_warning({"folder/dem.tif", extent, 10.0}, reference_system_named(system));
  };
  EXPECT_EQ(warning({500000.0, 5200000.0, 502000.0, 5201200.0}, "EPSG:32632"), "");
  EXPECT_EQ(warning({400000.0, 300000.0, 401000.0, 301000.0}, "EPSG:31287"), "");
  // Coordinates in UTM zone 32, declared as Austrian Lambert.
  EXPECT_EQ(warning({500000.0, 5200000.0, 502000.0, 5201200.0}, "EPSG:31287"),
            "the middle of dem.tif would be at longitude 20.74, latitude 85.64 in EPSG:31287, which is for longitudes "
            "9.53 to 17.17 and latitudes 46.4 to 49.02: is it the right system? If not, set terrain.crs to the one the "
            "numbers are in");
  // The far north of Norway in zone 33, as in its maps.
  EXPECT_EQ(warning({1100000.0, 7800000.0, 1101000.0, 7801000.0}, "EPSG:25833"), "");
  EXPECT_EQ(warning({2600000.0, 1200000.0, 2601000.0, 1201000.0}, "EPSG:32632").substr(0, 78),
            "the middle of dem.tif would be at longitude 27.85, latitude 10.29 in EPSG:3263")
      << "Swiss numbers";
}

// In a separate process, which has not cached the database: a proj.db of another program, which is not valid.
TEST(ReferenceSystemTest, MissingDatabaseIsNamed) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  const std::string folder = std::filesystem::path(text_file("proj.db", "no database")).parent_path().string();
  const auto report_line = [&] {
    const char* const paths[] = {folder.c_str(), nullptr};
    OSRSetPROJSearchPaths(paths);
    const std::string message = error_of([] { static_cast<void>(reference_system_named("EPSG:31254")); });
    fmt::print(stderr, "{}", message);
    std::exit(0);
  };
  EXPECT_EXIT(
      report_line(), testing::ExitedWithCode(0),
      "PROJ's database of coordinate reference systems, proj.db, cannot be used; GDAL says: .*Install it .Debian: "
      "apt-get install proj-data., or let PROJ_LIB name the folder that holds it");
}

TEST(ReferenceSystemTest, ReprojectionRoundTripIsTheIdentity) {
  const std::string lambert = reference_system_named("EPSG:31287"), degrees = reference_system_named("EPSG:4326");
  std::vector<double> x{350000.0}, y{400000.0};
  ASSERT_TRUE(Reprojection(lambert, degrees).apply(x, y));
  EXPECT_NEAR(x[0], 12.66, 0.05);  // longitude first, as in files
  EXPECT_NEAR(y[0], 47.5, 0.05);
  ASSERT_TRUE(Reprojection(degrees, lambert).apply(x, y));
  EXPECT_NEAR(x[0], 350000.0, 1e-3);
  EXPECT_NEAR(y[0], 400000.0, 1e-3);
  EXPECT_TRUE(Reprojection(lambert, lambert).changes_nothing());
  EXPECT_TRUE(Reprojection("", lambert).changes_nothing());
}

}  // namespace
}  // namespace thawslide::gis
