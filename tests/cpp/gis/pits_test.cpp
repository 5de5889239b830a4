// Points of a DEM whose value indicates missing data although the file does not declare it.
#include "gis/dem_warnings.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

// A slope between 1250 and 1350 m, with a patch of another value.
Raster slope_with(double value, int columns, int rows) {
  Raster dem = raster_of([](double x, double) { return 1350.0 - 0.5 * (x - west); }, west, south, 5.0, 41, 31);
  set_points(dem, 20, 10, columns, rows, value);
  return dem;
}

std::string warning_of(const Raster& dem) { return pits_warning("folder/dem.tif", dem); }

TEST(PitsTest, HolesFilledWithAConstant) {
  EXPECT_EQ(warning_of(slope_with(0.0, 3, 5)),
            "15 points of dem.tif are exactly 0 m among heights of 1292 to 1302 m, such as (400100, 300050): a hole "
            "without data? Then declare it in the file, gdal_edit.py -a_nodata 0 folder/dem.tif, or fill it");
  EXPECT_EQ(warning_of(slope_with(0.0, 1, 1)),
            "1 point of dem.tif is exactly 0 m among heights of 1298 to 1302 m, such as (400100, 300050): a hole "
            "without data? Then declare it in the file, gdal_edit.py -a_nodata 0 folder/dem.tif, or fill it");
  EXPECT_EQ(warning_of(slope_with(-99.5, 2, 1)).substr(0, 39), "2 points of dem.tif are exactly -99.5 m");
  EXPECT_EQ(warning_of(slope_with(8000.0, 2, 2)).substr(0, 38), "4 points of dem.tif are exactly 8000 m");
  // As created by warping: beyond an edge of the DEM.
  Raster edge = slope_with(0.0, 0, 0);
  set_points(edge, 0, 0, 2, edge.rows, 0.0);
  EXPECT_EQ(warning_of(edge).substr(0, 62), "62 points of dem.tif are exactly 0 m among heights of 1345 to ");
}

TEST(PitsTest, ValidGroundCausesNoWarning) {
  EXPECT_EQ(warning_of(slope_with(0.0, 0, 0)), "");
  EXPECT_EQ(warning_of(slope_with(1230.0, 3, 5)), "") << "a lake 70 m below its shores";
  EXPECT_EQ(warning_of(slope_with(500.0, 1, 1)), "") << "a single point is noise";
  EXPECT_EQ(warning_of(raster_of([](double, double) { return 0.0; }, west, south, 5.0, 20, 20)), "");
  // Sea level below cliffs of 400 m, with a beach in one place; and the same without the beach, which is not a coast.
  const auto coast = [](bool has_beach) {
    Raster dem = raster_of([](double x, double) { return x < west + 100.0 ? 0.0 : 400.0 + 0.1 * (x - west); }, west,
                           south, 5.0, 41, 31);
    for (int column = 20; column < 41; ++column) {
      dem.values[dem.index(column, 12)] = has_beach ? 0.5 * (column - 19) : 405.0 + column;
    }
    return dem;
  };
  EXPECT_EQ(warning_of(coast(true)), "");
  EXPECT_NE(warning_of(coast(false)), "");
}

TEST(PitsTest, AThicknessInPlaceOfADemIsNamedByItsEdge) {
  const auto edged = [](double edge, double inside) {
    return raster_of(
        [=](double x, double y) { return x > west && y > south && x < 8.0 + west && y < 8.0 + south ? inside : edge; },
        west, south, 2.0, 5, 5);
  };
  EXPECT_NE(thickness_warning("folder/dem.tif", edged(0.0, 20.0)).find("is it a raster of the thickness"),
            std::string::npos);
  EXPECT_EQ(thickness_warning("dem.tif", edged(std::nan(""), 20.0)), "");
  EXPECT_EQ(thickness_warning("dem.tif", edged(0.0, 0.0)), "");
  EXPECT_EQ(thickness_warning("dem.tif", edged(1.0, 20.0)), "");
}

TEST(PitsTest, LoadingTheSiteWarnsOfThem) {
  config::Case parameters = case_with_release({{"", box_at(300, 300, 400, 400)}});
  Raster dem = ground();
  set_points(dem, 110, 70, 2, 1, 0.0);
  parameters.terrain.file = geotiff("dem.tif", dem);
  const SiteAndWarnings loaded = load_site(parameters);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_EQ(loaded.warnings[0].substr(0, 115),
            "2 points of dem.tif are exactly 0 m among heights of 1580 to 1591 m, such as (400550, 300350): a hole "
            "without data?");
}

}  // namespace
}  // namespace thawslide::gis
