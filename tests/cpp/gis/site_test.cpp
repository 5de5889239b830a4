// Ground of a case, its path and its probes; points of a DEM whose value indicates missing data although the file does
// not declare it.
#include "gis/site.hpp"

#include "gis/dem.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

TEST(SiteTest, GroundIsCroppedToTheDomainAndSomeCells) {
  const SiteAndWarnings loaded = load_site(plain_case(ground()));
  const Raster& raster = *loaded.site.ground;
  // 3 cells of the grid and 2 of the DEM: 40 m, plus one point.
  EXPECT_NEAR(raster.x, west + 60.0, 5.0 + 1e-6);
  EXPECT_NEAR(raster.x_end(), west + 940.0, 5.0 + 1e-6);
  EXPECT_NEAR(raster.y, south + 60.0, 5.0 + 1e-6);
  EXPECT_NEAR(raster.y_end(), south + 740.0, 5.0 + 1e-6);
  for_points(raster, [&](int column, int row) {
    ASSERT_EQ(raster.at(column, row), plane(raster.x_of(column), raster.y_of(row)));
  });
  EXPECT_EQ(loaded.site.crs_name, "EPSG:31287");
  EXPECT_EQ(name_of(loaded.site.crs), "EPSG:31287");
  EXPECT_EQ(raster.crs, loaded.site.crs);
  EXPECT_EQ(loaded.warnings, std::vector<std::string>{});
  EXPECT_TRUE(loaded.site.releases.empty());
}

TEST(SiteTest, CroppingChangesNoValueOfResampledAndSmoothedGround) {
  const auto hills = [](double x, double y) { return 2000.0 + 40.0 * std::sin(0.03 * x) * std::cos(0.05 * y); };
  for (const double distance : {0.0, 3.0, 12.5}) {
    config::Case small = plain_case(raster_of(hills, west, south, 5.0, 201, 161));
    small.terrain.resample = distance;
    small.terrain.smooth = {.number = 8.0};
    config::Case large = small;
    large.grid.min = {west + 50.0, south + 50.0, 0.0};
    large.grid.max = {west + 950.0, south + 750.0, 3000.0};
    const SiteAndWarnings loaded = load_site(small), more = load_site(large);
    const Raster &part = *loaded.site.ground, &whole = *more.site.ground;
    EXPECT_EQ(part.cell_x, distance > 0.0 ? distance : 5.0);
    const auto column = static_cast<int>(std::lround((part.x - whole.x) / part.cell_x));
    const auto row = static_cast<int>(std::lround((part.y - whole.y) / part.cell_y));
    ASSERT_GT(column, 0);
    for (int k = 0; k < std::min(part.columns, part.rows); ++k) {
      EXPECT_NEAR(part.at(k, k), whole.at(column + k, row + k), 1e-9) << distance;
    }
    std::vector<std::string> warnings;
    if (distance > 0.0) {
      warnings.push_back(
          fmt::format("note: dem.tif was resampled from points 5 m x 5 m apart to points {:g} m apart", distance));
    }
    warnings.emplace_back("note: dem.tif was smoothed with a standard deviation of 8 m");
    EXPECT_EQ(loaded.warnings, warnings);
  }
}

TEST(SiteTest, KeyOverridesTheFile) {
  config::Case parameters = plain_case(ground("EPSG:4326"));
  parameters.terrain.crs = "EPSG:31254";
  const SiteAndWarnings loaded = load_site(parameters);
  EXPECT_EQ(loaded.site.crs_name, "EPSG:31254");
  EXPECT_EQ(loaded.warnings,
            std::vector<std::string>{
                "note: dem.tif is read as EPSG:31254, as set by terrain.crs; the file specifies EPSG:4326"});
}

TEST(SiteTest, WrongTagIsReportedAtTheKey) {
  expect_message(error_of_site(plain_case(ground("EPSG:4326"))));
  config::Case parameters = plain_case(ground(""));
  parameters.terrain.crs = "EPSG:31278x";
  EXPECT_EQ(error_of_site(parameters).substr(0, 62), "case.toml: terrain.crs: 'EPSG:31278x' is not a known coordinat");
}

TEST(SiteTest, DomainBeyondTheTerrainModel) {
  config::Case parameters = plain_case(ground());
  parameters.locations["grid.min"] = "case.toml:3:1";
  const auto with = [&](const config::Point& least, const config::Point& greatest, double distance) {
    parameters.grid.min = least;
    parameters.grid.max = greatest;
    parameters.terrain.resample = distance;
    return error_of_site(parameters);
  };
  const config::Point least{west - 12.5, south + 100.0, 0.0}, greatest{west + 900.0, south + 840.0, 3000.0};
  expect_message(with(least, greatest, 0.0));
  expect_message(with(least, greatest, 20.0));
  parameters.locations["terrain.resample"] = "case.toml:4:1";
  expect_message(with(least, greatest, 1e-7));
  expect_message(with({0.0, 0.0, 0.0}, {100.0, 50.0, 3000.0}, 0.0));
  EXPECT_EQ(with({west, south, 0.0}, {west + 1000.0, south + 800.0, 0.0}, 0.0), "no error");
  EXPECT_EQ(load_site(parameters).site.ground->columns, 201);
}

TEST(SiteTest, ImplausibleElevationsAndUnits) {
  Raster dem = ground();
  dem.values[dem.index(100, 80)] = -32768.0;
  const config::Case parameters = plain_case(dem);
  expect_message(error_of_site(parameters));
  write_geotiff(parameters.terrain.file, ground(), {"chains", "elevation"});
  expect_message(error_of_site(parameters));
}

TEST(SiteTest, PathAndProbes) {
  config::Case parameters = plain_case(ground());
  const std::string line = line_json({{west + 150.0, south + 200.0}, {west + 800.0, south + 210.5}});
  parameters.maps.path = geojson("path.geojson", {{"", line}});
  parameters.probes["hut"].point = {west + 300.0, south + 400.0, 0.0};
  parameters.probes["section"].line = geojson("section.geojson", {{"", line}});
  const config::Site site = load_site(parameters).site;
  EXPECT_EQ(site.path, (config::Polyline2{{west + 150.0, south + 200.0}, {west + 800.0, south + 210.5}}));
  EXPECT_EQ(site.probes.at("hut"), (config::Polyline2{{west + 300.0, south + 400.0}}));
  EXPECT_EQ(site.probes.at("section"), site.path);
  parameters.maps.path = geojson("path.geojson", {{"", line}, {"", line}});
  expect_message(error_of_site(parameters));
  parameters.maps.path = geojson("path.geojson", {{"", line_json({{0, 0}, {10, 10}})}});
  expect_message(error_of_site(parameters));
}

TEST(SiteTest, WithoutATerrainModelThereIsNoGround) {
  config::Case parameters;
  parameters.file = "case.toml";
  parameters.terrain.kind = config::TerrainKind::flat;
  const config::Site site = load_site(parameters).site;
  EXPECT_EQ(site.ground, nullptr);
  EXPECT_EQ(site.crs_name, "");
}

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
