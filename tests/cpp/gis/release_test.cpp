// Releases: thickness, volume, area and fields at the points of the ground.
#include "gis/release.hpp"

#include <algorithm>

#include "base/raster.hpp"
#include "gis/polygons.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

TEST(ReleaseTest, VolumeIsAreaTimesThickness) {
  const std::string odd = polygon_json({{west + 301.3, south + 302.7},
                                        {west + 457.9, south + 318.2},
                                        {west + 441.1, south + 402.6},
                                        {west + 380.4, south + 351.9},
                                        {west + 322.2, south + 420.8}});
  const config::Release release = release_of(case_with_release({{"", odd}}, 7.5));
  ASSERT_EQ(release.outlines.size(), 1U);
  EXPECT_EQ(release.outlines[0].size(), 6U);
  EXPECT_EQ(release.outlines[0].front(), release.outlines[0].back());
  EXPECT_NEAR(release.area, std::abs(signed_area(release.outlines[0])), 1e-6);
  EXPECT_NEAR(volume_of(release.thickness), 7.5 * release.area, 1e-9 * 7.5 * release.area);
  EXPECT_EQ(thickness_at(release, 350.0, 335.0), 7.5);
  EXPECT_EQ(*std::max_element(release.thickness.values.begin(), release.thickness.values.end()), 7.5);
  // One point more than those with a thickness on each side: 300 .. 460 and one.
  EXPECT_NEAR(release.thickness.x, west + 295.0, 1e-6);
  EXPECT_NEAR(release.thickness.x_end(), west + 465.0, 1e-6);
  EXPECT_TRUE(release.fields.empty());
}

TEST(ReleaseTest, OverlappingOutlinesCountOnce) {
  const config::Release release =
      release_of(case_with_release({{"", box_at(300, 300, 400, 400)}, {"", box_at(350, 350, 450, 500)}}));
  EXPECT_NEAR(release.area, 10000.0 + 15000.0 - 2500.0, 1e-6);
  EXPECT_NEAR(volume_of(release.thickness), 10.0 * release.area, 1e-9 * 10.0 * release.area);
  EXPECT_EQ(thickness_at(release, 375.0, 375.0), 10.0);
}

TEST(ReleaseTest, PolygonsAreChosenByName) {
  config::Case parameters =
      case_with_release({{R"("Zone":"a")", box_at(300, 300, 400, 400)}, {R"("Zone":"b")", box_at(500, 300, 540, 400)}});
  parameters.bodies["rock"].polygons = {"b"};
  parameters.bodies["rock"].name_attribute = "zone";
  EXPECT_NEAR(release_of(parameters).area, 4000.0, 1e-6);
}

TEST(ReleaseTest, VolumeIsExactOnCellsOfAnyShapeInIntegersFromSouthToNorth) {
  ForeignRaster dem;
  dem.type = GDT_Int16;
  dem.columns = 201;
  dem.rows = 120;
  dem.transform = {west, 4.9977, 0.0, south, 0.0, 7.25};
  for (int k = 0; k < dem.columns * dem.rows; ++k) {
    dem.values.push_back(2000.0 + k / dem.columns);
  }
  config::Case parameters = case_with_release(
      {{"",
        polygon_json({{west + 301.3, south + 302.7}, {west + 457.9, south + 318.2}, {west + 322.2, south + 420.8}})}},
      3.25);
  parameters.terrain.file = foreign("dem.tif", dem);
  const config::Site site = load_site(parameters).site;
  const config::Release& release = site.releases.at("rock");
  EXPECT_EQ(release.thickness.cell_x, 4.9977);
  EXPECT_EQ(release.thickness.cell_y, 7.25);
  EXPECT_NEAR(volume_of(release.thickness), 3.25 * release.area, 1e-9 * 3.25 * release.area);
  // The points of the thickness are points of the ground, which rises by 1 m a row to the north.
  const double column = (release.thickness.x - site.ground->x) / 4.9977,
               row = (release.thickness.y - site.ground->y) / 7.25;
  EXPECT_NEAR(column, std::round(column), 1e-6);
  EXPECT_NEAR(row, std::round(row), 1e-6);
  EXPECT_EQ(site.ground->at(3, 4) - site.ground->at(3, 3), 1.0);
}

TEST(ReleaseTest, BodiesOfOneFileRepeatNoWarning) {
  config::Case parameters = plain_case(ground());
  const std::string file =
      geojson("two.geojson",
              {{R"("name":"a")", box_at(300, 300, 400, 400)}, {R"("name":"b")", box_at(500, 300, 540, 400)}}, "4326");
  for (const char* name : {"a", "b"}) {
    parameters.bodies[name] = release_body(file, 5.0);
    parameters.bodies[name].polygons = {name};
  }
  const SiteAndWarnings loaded = load_site(parameters);
  EXPECT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NEAR(volume_of(loaded.site.releases.at("a").thickness), 5e4, 1e-4);
  EXPECT_NEAR(volume_of(loaded.site.releases.at("b").thickness), 2e4, 1e-4);
}

TEST(ReleaseTest, AttributeGivesEachPolygonItsThickness) {
  config::Case parameters = case_with_release({{R"("thickness":4.0)", box_at(300, 300, 400, 400)},
                                               {R"("thickness":6.5)", box_at(400, 300, 500, 400)},
                                               {R"("thickness":4.0)", box_at(350, 350, 380, 420)}});
  parameters.bodies["rock"].thickness = {config::MapValue::From::attribute, 0.0, "Thickness"};
  const config::Release release = release_of(parameters);
  EXPECT_EQ(thickness_at(release, 350.0, 350.0), 4.0);
  EXPECT_EQ(thickness_at(release, 450.0, 350.0), 6.5);
  EXPECT_NEAR(thickness_at(release, 400.0, 350.0), 5.25, 1e-9);  // half the cell for each
  EXPECT_NEAR(release.area, 20000.0 + 600.0, 1e-6);
  EXPECT_NEAR(volume_of(release.thickness), 4.0 * 10600.0 + 6.5 * 10000.0, 1e-4);
}

TEST(ReleaseTest, ThicknessAlongTheNormalIsDividedByTheCosine) {
  config::Case parameters = case_with_release({{"", box_at(300, 300, 400, 400)}}, 8.0);
  parameters.bodies["rock"].thickness_along = config::ThicknessAlong::normal;
  EXPECT_NEAR(volume_of(release_of(parameters).thickness), 10.0 * 10000.0, 1e-6);  // the slope is 3 in 4
}

TEST(ReleaseTest, CutLowersTheGroundAndOnTopLeavesIt) {
  config::Case parameters = case_with_release({{"", box_at(302, 300, 400, 400)}}, 8.0);
  const config::Site on_top = load_site(parameters).site;
  parameters.bodies["rock"].placement = config::Placement::cut;
  const config::Site cut = load_site(parameters).site;
  const config::Release& release = cut.releases.at("rock");
  EXPECT_EQ(release.thickness.values, on_top.releases.at("rock").thickness.values);
  for_points(*cut.ground, [&](int column, int row) {
    const double x = cut.ground->x_of(column), y = cut.ground->y_of(row);
    EXPECT_EQ(on_top.ground->at(column, row), plane(x, y));
    EXPECT_NEAR(cut.ground->at(column, row) + thickness_at(release, x - west, y - south), plane(x, y), 1e-9);
  });
  EXPECT_EQ(thickness_at(release, 350.0, 350.0), 8.0);
}

TEST(ReleaseTest, TaperKeepsTheVolume) {
  config::Case parameters = case_with_release({{"", box_at(302, 303, 421, 407)}}, 8.0);
  parameters.bodies["rock"].taper = 37.0;
  const config::Release release = release_of(parameters);
  EXPECT_NEAR(volume_of(release.thickness), 8.0 * 119.0 * 104.0, 1e-9 * 8.0 * 119.0 * 104.0);
  EXPECT_NEAR(release.area, 119.0 * 104.0, 1e-6);
  EXPECT_GT(thickness_at(release, 290.0, 350.0), 0.0);
  EXPECT_EQ(thickness_at(release, 280.0, 350.0), 0.0);
}

TEST(ReleaseTest, RasterGivesTheThicknessWithinPolygons) {
  config::Case parameters = case_with_release({{"", box_at(302.5, 302.5, 402.5, 402.5)}});
  const auto wedge = [](double x, double) { return 0.1 * (x - west - 250.0); };
  // Points shifted relative to those of the ground: a linear thickness is reproduced exactly.
  parameters.bodies["rock"].thickness = {
      config::MapValue::From::raster, 0.0,
      geotiff("thickness.tif", raster_of(wedge, west + 251.0, south + 252.0, 7.0, 40, 40))};
  const config::Release release = release_of(parameters);
  EXPECT_NEAR(thickness_at(release, 305.0, 350.0), 5.5, 1e-9);
  EXPECT_NEAR(thickness_at(release, 400.0, 350.0), 15.0, 1e-9);
  EXPECT_EQ(thickness_at(release, 405.0, 350.0), 0.0);
  EXPECT_NEAR(volume_of(release.thickness), 1e4 * 0.5 * (5.25 + 15.25), 1e-3);
}

TEST(ReleaseTest, RasterAloneIsTheRelease) {
  config::Case parameters = plain_case(ground());
  Raster thickness = raster_of(
      [](double x, double y) {
        return std::abs(x - west - 400.0) < 51.0 && std::abs(y - south - 300.0) < 31.0 ? 6.0 : missing;
      },
      west, south, 5.0, 201, 161);
  parameters.bodies["rock"] = raster_body(geotiff("release.tif", thickness));
  const SiteAndWarnings loaded = load_site(parameters);
  const config::Release& release = loaded.site.releases.at("rock");
  EXPECT_NEAR(volume_of(release.thickness), 6.0 * 21 * 13 * 25.0, 1e-6);
  EXPECT_NEAR(release.area, 21 * 13 * 25.0, 1e-6);
  EXPECT_TRUE(release.outlines.empty());
  EXPECT_EQ(loaded.warnings, std::vector<std::string>{});
  thickness.crs = "";
  parameters.bodies["rock"] = raster_body(geotiff("release.tif", thickness));
  EXPECT_EQ(load_site(parameters).warnings,
            std::vector<std::string>{"release.tif specifies no coordinate reference system: that "
                                     "of the DEM, EPSG:31287, is assumed"});
}

TEST(ReleaseTest, SurfaceAloneIsTheRelease) {
  config::Case parameters = plain_case(ground());
  Raster surface = ground();
  for_points(surface, [&](int column, int row) {
    const bool inside =
        std::abs(surface.x_of(column) - west - 400.0) < 51.0 && std::abs(surface.y_of(row) - south - 300.0) < 31.0;
    surface.values[surface.index(column, row)] += inside ? 6.0 : 0.004;  // 0.004 m is within the noise tolerance
  });
  parameters.bodies["rock"] = surface_body(geotiff("before.tif", surface));
  const config::Release release = release_of(parameters);
  EXPECT_NEAR(volume_of(release.thickness), release.area * 6.0, 1e-6 * release.area);
  EXPECT_NEAR(thickness_at(release, 400.0, 300.0), 6.0, 1e-6);
  EXPECT_GT(release.area, 100.0 * 60.0);
}

TEST(ReleaseTest, FieldsFromAttributesAndRasters) {
  config::Case parameters =
      case_with_release({{R"("T":-8.0)", box_at(300, 300, 400, 400)}, {R"("T":-2.0)", box_at(400, 300, 500, 400)}});
  config::Body& body = parameters.bodies["rock"];
  body.taper = 30.0;
  body.temperature = field_of(InitialField::Over::attribute, "t");
  body.porosity =
      raster_field(geotiff("porosity.tif", raster_of([](double x, double) { return 0.1 + 0.001 * (x - west - 250.0); },
                                                     west + 240.0, south + 240.0, 10.0, 40, 40)));
  const config::Release release = release_of(parameters);
  const Raster& temperature = release.fields.at("temperature");
  const Raster& porosity = release.fields.at("porosity");
  ASSERT_EQ(temperature.values.size(), release.thickness.values.size());
  EXPECT_EQ(temperature.x, release.thickness.x);
  const auto column = [&](double x) { return static_cast<int>(std::lround((west + x - temperature.x) / 5.0)); };
  const int row = static_cast<int>(std::lround((south + 350.0 - temperature.y) / 5.0));
  EXPECT_EQ(temperature.at(column(350.0), row), -8.0);
  EXPECT_EQ(temperature.at(column(450.0), row), -2.0);
  EXPECT_NEAR(temperature.at(column(400.0), row), -5.0, 1e-9);
  EXPECT_EQ(temperature.at(column(290.0), row), -8.0) << "under the taper, as at the nearest point within";
  EXPECT_NEAR(porosity.at(column(350.0), row), 0.2, 1e-9);
  EXPECT_TRUE(
      std::none_of(temperature.values.begin(), temperature.values.end(), [](double v) { return std::isnan(v); }));
}

}  // namespace
}  // namespace thawslide::gis
