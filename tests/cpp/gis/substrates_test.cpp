// Substrates and beds from polygons and rasters: their areas and depths, errors, warnings.
#include "sim/setup/substrates.hpp"

#include <algorithm>
#include <cmath>

#include "config/read_case.hpp"
#include "gis/site.hpp"
#include "sim/records/history.hpp"
#include "sim/simulation.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;
using testing_support::value_of;

// ---- a slide of debris on a DEM, 300 m by 100 m

// `ground`: height of the DEM at x, y [m]; `velocity`: of the debris at the start [m/s]; `more`: TOML added after
// [basal].
config::Case debris_case(const std::function<double(double, double)>& ground, double end, const std::string& velocity,
                         const std::string& more) {
  geotiff("dem.tif", raster_of(ground, west, south, 5.0, 61, 21));
  geojson("release.geojson", {{"", box_at(35.0, 35.0, 75.0, 65.0)}});
  const std::string text = config::case_messages::one_key_per_line(fmt::format(
      R"(
[case] dimension = 3
[time] end = {} | step = 0.002
[grid] cell = 5.0 | min = [{}, {}, 500.0] | max = [{}, {}, 640.0]
[terrain] type = "dem" | file = "dem.tif"
[material.debris] law = "mohr_coulomb" | youngs_modulus = 2e7 | poisson_ratio = 0.3 | friction_angle = 30.0 |
  cohesion = 0.0
[body.slide] material = "debris" | shape = "release" | release = "release.geojson" | thickness = 10.0 | velocity = {}
[heat] enabled = false
[pressure] enabled = false
[basal] friction = "constant" | friction_angle = 25.0
)",
      end, west + 10.0, south + 10.0, west + 290.0, south + 90.0, velocity));
  return config::read_case(text_file("case.toml", text + more), {});
}

sim::HistoryRow row_after(const config::Case& parameters) {
  sim::Simulation<3> simulation(parameters, load_site(parameters).site);
  testing_support::run_until(simulation, parameters.time.end);
  return sim::history_row(simulation);
}

// ---- a slide down a valley that is uniform along y except for its walls

constexpr double border = 92.5;  // along x, half-way between two nodes and at an edge of the raster's cells

double valley(double x, double y) {
  const double along = x - west, across = y - south - 50.0;
  return 600.0 - 0.5 * std::min(along, 100.0) - 0.1 * std::max(0.0, along - 100.0) + 0.004 * across * across;
}

config::Case valley_case(const std::string& substrate) {
  geojson("areas.geojson", {{R"("name":"glacier")", box_at(border, -50.0, 400.0, 150.0)},
                            {R"("name":"lake")", box_at(0.0, 0.0, 20.0, 20.0)}});
  geotiff("codes.tif", raster_of([](double x, double) { return x - west > border ? 7.0 : 2.0; }, west - 2.5,
                                 south + 2.5, 10.0, 30, 10));
  return debris_case(valley, 3.0, "[10.0, 0.0, -5.0]", substrate);
}

const std::string slippery = "friction = \"coefficient\"\nfriction_coefficient = 0.05\n";

const std::string in_glacier = "[substrate.ice]\noutline = \"areas.geojson\"\npolygons = [\"glacier\"]\n" + slippery;
const std::string at_code = "[substrate.ice]\nraster = \"codes.tif\"\ncode = 7\n" + slippery;

void expect_the_same_row(const sim::HistoryRow& row, const sim::HistoryRow& expected) {
  ASSERT_EQ(row.size(), expected.size());
  for (std::size_t k = 0; k < row.size(); ++k) {
    EXPECT_TRUE(row[k].second == expected[k].second || std::isnan(expected[k].second)) << row[k].first;
  }
}

TEST(SubstratesOfMaps, PolygonsRasterAndStripGiveTheSameBits) {
  const auto along_x =
      row_after(valley_case("[substrate.ice]\n" + fmt::format("x_min = {}\n", west + border) + slippery));
  expect_the_same_row(row_after(valley_case(in_glacier)), along_x);
  expect_the_same_row(row_after(valley_case(at_code)), along_x);
  EXPECT_GT(value_of(along_x, "front_position_m"), west + border + 20.0) << "the slide must have reached it";
  EXPECT_GT(value_of(along_x, "mean_velocity_m_s"), value_of(row_after(valley_case("")), "mean_velocity_m_s") + 0.2);
}

TEST(SubstratesOfMaps, ReportTheirArea) {
  const auto area = [](const std::string& substrate) {
    return load_site(valley_case(substrate)).site.substrates.at("ice").area;
  };
  EXPECT_NEAR(area(in_glacier), (290.0 - border) * 80.0, 1e-6);
  EXPECT_NEAR(area(at_code), 20.0 * 8.0 * 100.0, 1e-6);
}

// ---- errors and warnings, on the plane of site_case

config::Substrate in_polygons(const std::string& file, const std::vector<std::string>& names = {}) {
  config::Substrate substrate;
  substrate.outline = file;
  substrate.polygons = names;
  return substrate;
}

config::Substrate in_raster(const std::string& file, int code) {
  config::Substrate substrate;
  substrate.raster = file;
  substrate.code = code;
  return substrate;
}

config::Case plane_case() { return case_with_release({{"", box_at(300.0, 300.0, 400.0, 400.0)}}); }

std::vector<std::string> warnings_of(const config::Case& parameters) { return load_site(parameters).warnings; }

std::string codes_file(const std::function<double(double, double)>& code, int columns = 100, int rows = 80) {
  return geotiff("codes.tif", raster_of(code, west + 5.0, south + 5.0, 10.0, columns, rows));
}

// Codes that change 500 m from the first point of the ground.
config::Substrate with_codes(double in_west, double in_east, int code) {
  return in_raster(codes_file([=](double x, double) { return x < west + 500.0 ? in_west : in_east; }), code);
}

TEST(SubstratesOfMaps, OutsideTheDomainOrWithOtherCodesAreRefused) {
  config::Case made = plane_case();
  for (const config::Substrate& ice :
       {in_polygons(geojson("ice.geojson", {{"", box_at(0.0, 0.0, 90.0, 90.0)}})), with_codes(1.0, 4.0, 3)}) {
    made.substrates["ice"] = ice;
    expect_message(error_of_site(made));
  }
  made.substrates["ice"] = with_codes(1.0, 1.5, 1);
  expect_message(error_of_site(made));
}

TEST(SubstratesOfMaps, ThatOverlapAreRefusedExceptForSlivers) {
  const std::string file = geojson("areas.geojson", {{R"("name":"ice")", box_at(200.0, 200.0, 500.0, 400.0)},
                                                     {R"("name":"snow")", box_at(480.0, 200.0, 600.0, 400.0)},
                                                     {R"("name":"sliver")", box_at(499.99, 200.0, 600.0, 400.0)}});
  config::Case made = plane_case();
  made.substrates["ice"] = in_polygons(file, {"ice"});
  made.substrates["snow"] = in_polygons(file, {"snow"});
  expect_message(error_of_site(made));
  made.substrates["snow"] = in_polygons(file, {"sliver"});
  EXPECT_NEAR(load_site(made).site.substrates.at("snow").area, 100.01 * 200.0, 1e-6);
  made.substrates["snow"] = config::Substrate{};
  made.substrates["snow"].x_min = west + 450.0;
  expect_message(error_of_site(made));
  made.substrates["snow"] = in_raster(codes_file([](double x, double) { return x < west + 450.0 ? 1.0 : 4.0; }), 4);
  expect_message(error_of_site(made));
}

TEST(SubstratesOfMaps, CodesWithoutASubstrateCauseAWarning) {
  config::Case made = plane_case();
  const auto code = [](double x, double y) {
    return y > south + 600.0 ? missing : x < west + 500.0 ? 1.0 : x < west + 800.0 ? 2.0 : 3.0;
  };
  made.substrates["ice"] = in_raster(codes_file(code), 1);
  made.substrates["snow"] = in_raster(in_folder("codes.tif"), 2);
  EXPECT_EQ(warnings_of(made),
            std::vector<std::string>{"codes.tif: no substrate is given for the code 3 (10 % of its points) and points "
                                     "without data (17 % of its points): [basal] applies there"});
  made.substrates["ice"] = in_raster(codes_file([](double, double) { return 1.0; }, 60), 1);
  made.substrates.erase("snow");
  EXPECT_EQ(warnings_of(made),
            std::vector<std::string>{"codes.tif: no substrate is given for the domain beyond it (300 m in the east): "
                                     "[basal] applies there"});
}

// A raster in longitude and latitude: every place receives the code of the nearest raster point.
TEST(SubstratesOfMaps, CodesInAnotherSystemAreMappedToThePointsOfTheGround) {
  config::Case made = plane_case();
  std::vector<double> x{west, west + 1000.0}, y{south, south + 800.0};
  ASSERT_TRUE(Reprojection(reference_system_named("EPSG:31287"), reference_system_named("EPSG:4326")).apply(x, y));
  const double middle = 0.5 * (x[0] + x[1]);
  const double size_x = (x[1] - x[0]) / 200.0, size_y = (y[1] - y[0]) / 160.0;
  Raster codes = raster_of([](double, double) { return 0.0; }, x[0] - 20.0 * size_x, y[0] - 20.0 * size_y, 1.0, 240,
                           200, "EPSG:4326");
  codes.cell_x = size_x;
  codes.cell_y = size_y;
  for_points(codes, [&](int column, int row) {
    codes.values[codes.index(column, row)] = codes.x_of(column) < middle ? 1.0 : 2.0;
  });
  made.substrates["ice"] = in_raster(geotiff("codes.tif", codes), 2);
  const auto substrates = sim::make_substrates(made, load_site(made).site);
  EXPECT_EQ(substrates->at(350.0, 300.0), 0);
  EXPECT_EQ(substrates->at(450.0, 300.0), 1);
}

config::Case slide_over_bed(const std::string& depth) {
  return debris_case([](double x, double) { return 600.0 - 0.2 * (x - west); }, 1.0, "[10.0, 0.0, -2.0]",
                     "[bed]\nlaw = \"strength\"\nstrength = 0.0\ndepth_per_slip = 0.2\nmaterial = \"debris\"\n"
                     "porosity = 0.4\ndepth = " +
                         depth + "\n");
}

// A slide over a bed of a raster.
config::Case slide_over_raster(const std::function<double(double, double)>& depth, int columns = 31) {
  geotiff("depth.tif", raster_of(depth, west, south, 10.0, columns, 11));
  return slide_over_bed("{ raster = \"depth.tif\" }");
}

double uniform_depth(double, double) { return 1.5; }

TEST(BedOfMaps, UniformRasterIsEqualToTheNumber) {
  const double of_number = value_of(row_after(slide_over_bed("1.5")), "entrained_mass_kg");
  const double of_raster = value_of(row_after(slide_over_raster(uniform_depth)), "entrained_mass_kg");
  EXPECT_GT(of_number, 1e5);
  EXPECT_NEAR(of_raster / of_number, 1.0, 1e-6);
}

TEST(BedOfMaps, MissingOrInvalidDepthsAreRefused) {
  expect_message(error_of_site(slide_over_raster(uniform_depth, 20)));
  expect_message(error_of_site(slide_over_raster([](double x, double) { return x > west + 100.0 ? 6.0 : 0.0; })));
  expect_message(error_of_site(slide_over_raster([](double, double) { return -0.5; })));
}

// ---- beds in polygons

// A slide over a bed in the polygons of bed.geojson, whose depth is a number or their attribute `depth`.
config::Case slide_over_polygons(const std::vector<JsonFeature>& polygons, const std::string& more = "",
                                 const std::string& depth = "{ attribute = \"depth\" }") {
  geojson("bed.geojson", polygons);
  return slide_over_bed(depth + "\noutline = \"bed.geojson\"\n" + more);
}

double bed_volume_of(const config::Case& parameters) {
  const sim::Simulation<3> simulation(parameters, load_site(parameters).site);
  return simulation.bed()->sums().initial / simulation.bed()->material().density;
}

// A triangle, a rectangle, and one that the domain cuts off; their sides are not those of cells.
TEST(BedOfMaps, VolumeOfPolygonsIsExactForAnyCell) {
  config::Case made = slide_over_polygons(
      {{R"("depth":1.25)",
        polygon_json({{west + 47.3, south + 21.7}, {west + 130.3, south + 21.7}, {west + 47.3, south + 62.7}})},
       {R"("depth":0.75)", box_at(151.2, 20.0, 203.4, 61.7)},
       {R"("depth":2)", box_at(251.3, 68.0, 400.0, 150.0)}});
  const double expected = 1.25 * 0.5 * 83.0 * 41.0 + 0.75 * 52.2 * 41.7 + 2.0 * (290.0 - 251.3) * (90.0 - 68.0);
  for (const double cell : {4.0, 5.0, 10.0}) {
    made.grid.cell = cell;
    EXPECT_NEAR(bed_volume_of(made) / expected, 1.0, 1e-11) << cell;
  }
}

TEST(BedOfMaps, PolygonsWithOneDepthCountOnce) {
  const std::vector<JsonFeature> overlapping{{R"("name":"a")", box_at(50.0, 20.0, 120.0, 80.0)},
                                             {R"("name":"b")", box_at(100.0, 20.0, 150.0, 80.0)}};
  EXPECT_NEAR(bed_volume_of(slide_over_polygons(overlapping, "", "1.5")), 1.5 * 100.0 * 60.0, 1e-8);
  EXPECT_NEAR(bed_volume_of(slide_over_polygons(overlapping, "polygons = [\"b\"]\n", "1.5")), 1.5 * 50.0 * 60.0, 1e-8);
}

// The points of the raster are those at which the bed of a cell is sampled; borders of the polygons are half-way
// between two of them.
TEST(BedOfMaps, PolygonsGiveTheSameBitsAsARasterOfTheirDepths) {
  const auto depth = [](double x, double y) {
    const double along = x - west, across = y - south;
    return across < 35.0 || across > 70.0 ? 0.0 : along > 60.0 && along < 95.0 ? 1.5 : along > 95.0 ? 0.5 : 0.0;
  };
  const auto change_dem = [](config::Case made) {
    made.terrain.file = geotiff("fine.tif", raster_of([](double x, double) { return 600.0 - 0.2 * (x - west); },
                                                      west + 0.625, south + 0.625, 1.25, 240, 80));
    return made;
  };
  geotiff("depth.tif", raster_of(depth, west + 0.625, south + 0.625, 1.25, 240, 80));
  const auto of_raster = row_after(change_dem(slide_over_bed("{ raster = \"depth.tif\" }")));
  const auto of_polygons = row_after(change_dem(slide_over_polygons(
      {{R"("depth":1.5)", box_at(60.0, 35.0, 95.0, 70.0)}, {R"("depth":0.5)", box_at(95.0, 35.0, 400.0, 70.0)}})));
  expect_the_same_row(of_polygons, of_raster);
  const double initial = value_of(of_polygons, "bed_mass_kg") + value_of(of_polygons, "entrained_mass_kg");
  EXPECT_GT(value_of(of_polygons, "entrained_mass_kg"), 1e4);
  EXPECT_LT(std::abs(value_of(of_polygons, "bed_residual_kg")), 1e-12 * initial);
}

TEST(BedOfMaps, InvalidPolygonsAreRefused) {
  const std::string here = box_at(50.0, 20.0, 120.0, 80.0);
  for (const std::vector<JsonFeature>& polygons : std::vector<std::vector<JsonFeature>>{
           {{R"("name":"fan", "depth":-0.5)", here}},
           {{R"("name":"fan", "depth":6)", here}},
           {{R"("name":"fan")", here}},
           {{R"("depth":"deep")", here}},
           {{R"("depth":1)", box_at(300.0, 0.0, 400.0, 50.0)}},
           {{R"("depth":1)", here}, {R"("depth":2)", box_at(110.0, 20.0, 150.0, 80.0)}}}) {
    expect_message(error_of_site(slide_over_polygons(polygons)));
  }
  expect_message(error_of_site(slide_over_polygons({{R"("name":"fan")", here}}, "polygons = [\"fn\"]\n", "1.0")));
}

}  // namespace
}  // namespace thawslide::gis
