// Points of a DEM whose value indicates missing data although the file does not declare it.
#include "gis/dem.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

// A slope between 1250 and 1350 m, with a patch of another value.
std::string warning_of(double value, int columns, int rows) {
  Raster dem = raster_of([](double x, double) { return 1350.0 - 0.5 * (x - west); }, west, south, 5.0, 41, 31);
  set_points(dem, 20, 10, columns, rows, value);
  return warning_of_zeros("folder/dem.tif", dem);
}

TEST(PitsTest, HolesFilledWithZeros) {
  EXPECT_EQ(warning_of(0.0, 3, 5),
            "15 points of dem.tif are exactly 0 m among heights of 1250 to 1350 m, such as (400100, 300050): a hole "
            "without data? Then declare it in the file, gdal_edit.py -a_nodata 0 folder/dem.tif, or fill it");
  EXPECT_EQ(warning_of(0.0, 1, 1).substr(0, 62), "1 point of dem.tif is exactly 0 m among heights of 1250 to 135");
}

TEST(PitsTest, ValidGroundCausesNoWarning) {
  EXPECT_EQ(warning_of(0.0, 0, 0), "");
  EXPECT_EQ(warning_of(500.0, 1, 1), "");
  EXPECT_EQ(warning_of_zeros("dem.tif", raster_of([](double, double) { return 0.0; }, west, south, 5.0, 20, 20)), "");
  // Sea level below cliffs of 400 m, with a beach in one place; and the same without the beach, which is not a coast.
  const auto coast = [](bool has_beach) {
    Raster dem = raster_of([](double x, double) { return x < west + 100.0 ? 0.0 : 400.0 + 0.1 * (x - west); }, west,
                           south, 5.0, 41, 31);
    if (has_beach) {
      set_points(dem, 20, 12, 1, 1, 0.5);
    }
    return warning_of_zeros("dem.tif", dem);
  };
  EXPECT_EQ(coast(true), "");
  EXPECT_NE(coast(false), "");
}

TEST(PitsTest, LoadingTheSiteWarnsOfThem) {
  config::Case parameters = case_with_release({{"", box_at(300, 300, 400, 400)}});
  Raster dem = ground();
  set_points(dem, 110, 70, 2, 1, 0.0);
  parameters.terrain.file = geotiff("dem.tif", dem);
  const SiteAndWarnings loaded = load_site(parameters);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_EQ(loaded.warnings[0].substr(0, 115),
            "2 points of dem.tif are exactly 0 m among heights of 1295 to 1955 m, such as (400550, 300350): a hole "
            "without data?");
}

}  // namespace
}  // namespace thawslide::gis
