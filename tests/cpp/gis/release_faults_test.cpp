// Error messages for releases that cannot be used.
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

TEST(ReleaseFaultsTest, OutsideTheDemOrTheDomain) {
  for (const std::string& box :
       {box_at(-500, 300, -400, 400), box_at(900, 300, 1010, 400), box_at(60, 300, 200, 720)}) {
    expect_message(error_of_site(case_with_release({{"", box}})));
  }
  EXPECT_EQ(error_of_site(case_with_release({{"", box_at(101, 300, 200, 400)}})), "no error");
}

TEST(ReleaseFaultsTest, TaperThatReachesTooFar) {
  config::Case parameters = case_with_release({{"", box_at(111, 300, 200, 400)}});
  parameters.locations["body.rock.taper"] = "--set body.rock.taper=50";
  for (const double taper : {50.0, 30.0, 30.5, 500.0}) {
    parameters.bodies["rock"].taper = taper;
    if (taper == 30.0) {
      EXPECT_EQ(error_of_site(parameters), "no error");
    } else {
      expect_message(error_of_site(parameters));
    }
  }
}

TEST(ReleaseFaultsTest, OverNodata) {
  config::Case parameters = case_with_release({{"", box_at(300, 300, 400, 400)}});
  const auto with_hole = [&](int column, int columns, double taper) {
    Raster dem = ground();
    set_points(dem, column, 66, columns, 1, missing);
    parameters.terrain.file = geotiff("dem.tif", dem);
    parameters.bodies["rock"].taper = taper;
    return error_of_site(parameters);
  };
  expect_message(with_hole(70, 2, 0.0));
  EXPECT_EQ(with_hole(83, 1, 20.0), "no error");
  expect_message(with_hole(83, 1, 40.0));
}

TEST(ReleaseFaultsTest, SmallerThanACellOfTheTerrainModel) {
  config::Case parameters = case_with_release({{"", box_at(300, 300, 303, 303)}}, 20.0);
  expect_message(error_of_site(parameters));
  parameters.terrain.resample = 0.5;
  EXPECT_EQ(error_of_site(parameters), "no error");
}

TEST(ReleaseFaultsTest, MissingOrInvalidThickness) {
  const std::string box = box_at(300, 300, 400, 400);
  config::Case parameters = case_with_release({{R"("thick":5)", box}, {R"("thick":null)", box}});
  parameters.bodies["rock"].thickness = {config::MapValue::From::attribute, 0.0, "thickness"};
  expect_message(error_of_site(parameters));
  parameters.bodies["rock"].thickness.source = "thick";
  expect_message(error_of_site(parameters));
  for (const char* attributes : {R"("thick":"5 m","name":"top")", R"("thick":-2)", R"("thick":0)"}) {
    geojson("release.geojson", {{attributes, box}});
    expect_message(error_of_site(parameters));
  }
}

TEST(ReleaseFaultsTest, ReleaseTimesOfPolygons) {
  config::Case parameters = case_with_release({{R"("from":0.25,"name":"lower")", box_at(300, 300, 400, 400)},
                                               {R"("from":0.5,"name":"upper")", box_at(500, 300, 600, 400)}});
  parameters.time.end = 2.0;
  parameters.bodies["rock"].release_time.attribute = "from";
  expect_message(error_of_site(parameters));
  parameters.bodies["rock"].polygons = {"upper"};
  EXPECT_EQ(release_of(parameters).release_time, 0.5);
  parameters.time.end = 0.5;
  expect_message(error_of_site(parameters));
}

TEST(ReleaseFaultsTest, PolygonsOfDifferentThicknessMayNotOverlap) {
  config::Case parameters = case_with_release({{R"("thickness":5,"name":"upper")", box_at(300, 300, 400, 400)},
                                               {R"("thickness":7)", box_at(380, 300, 500, 400)}});
  parameters.bodies["rock"].thickness = {config::MapValue::From::attribute, 0.0, "thickness"};
  expect_message(error_of_site(parameters));
}

TEST(ReleaseFaultsTest, VolumeThatMustBeConfirmed) {
  config::Case parameters = case_with_release({{"", box_at(200, 200, 800, 600)}}, 8500.0);
  expect_message(error_of_site(parameters));
  parameters.bodies["rock"].largest_volume = 3e9;
  EXPECT_EQ(error_of_site(parameters), "no error");
}

TEST(ReleaseFaultsTest, ThicknessRasters) {
  config::Case parameters = case_with_release({{"", box_at(300, 300, 400, 400)}});
  const auto with = [&](const Raster& thickness) {
    parameters.bodies["rock"].thickness = {config::MapValue::From::raster, 0.0, geotiff("thickness.tif", thickness)};
    return error_of_site(parameters);
  };
  expect_message(with(raster_of([](double, double) { return -1.5; }, west, south, 5.0, 201, 161)));
  expect_message(with(raster_of([](double, double) { return 1.0; }, west + 600.0, south, 5.0, 20, 20)));
  expect_message(
      with(raster_of([](double x, double) { return x > west + 500.0 ? 1.0 : 0.0; }, west, south, 5.0, 201, 161)));
}

TEST(ReleaseFaultsTest, RasterAsTheRelease) {
  config::Case parameters = plain_case(ground());
  const auto with = [&](const Raster& thickness) {
    parameters.bodies["rock"] = raster_body(geotiff("release.tif", thickness));
    return error_of_site(parameters);
  };
  expect_message(with(raster_of([](double, double) { return 0.0; }, west, south, 5.0, 201, 161)));
  expect_message(with(raster_of([](double x, double) { return x > west + 300.0 ? 2.0 : -0.5; }, west + 200.0,
                                south + 200.0, 5.0, 60, 40)));
  expect_message(with(raster_of([](double, double) { return 2.0; }, west, south, 5.0, 100, 100)));
  parameters.bodies["rock"] = release_body(geotiff("release.tif", ground()), 5.0);
  expect_message(error_of_site(parameters));
  parameters.bodies["rock"] = surface_body(geotiff("before.tif", ground()));
  expect_message(error_of_site(parameters));
  parameters.bodies["rock"] = raster_body(in_folder("none.tif"));
  expect_message(error_of_site(parameters));
}

TEST(ReleaseFaultsTest, SurfacesBeforeTheSlide) {
  config::Case parameters = case_with_release({{"", box_at(300, 300, 400, 400)}});
  config::Body& body = parameters.bodies["rock"];
  body.thickness = {config::MapValue::From::surface, 0.0, ""};
  const auto with = [&](double above) {
    body.thickness.source = geotiff(
        "before.tif", raster_of([&](double x, double y) { return plane(x, y) + above; }, west, south, 5.0, 201, 161));
    return error_of_site(parameters);
  };
  EXPECT_EQ(with(12.0), "no error");
  expect_message(with(-3.0));
  body.surface_tolerance = 3.5;
  expect_message(with(-3.0));
}

TEST(ReleaseFaultsTest, FieldsOutOfRange) {
  config::Case parameters = case_with_release({{R"("t":-8,"n":0)", box_at(300, 300, 400, 400)}});
  config::Body& body = parameters.bodies["rock"];
  body.porosity = field_of(InitialField::Over::attribute, "n");
  expect_message(error_of_site(parameters));
  body.porosity = InitialField(0.3);
  for (const auto& [temperature, columns] : {std::pair(265.0, 80), {-5.0, 35}}) {
    body.temperature =
        raster_field(geotiff("t.tif", raster_of([&, value = temperature](double, double) { return value; },
                                                west + 200.0, south + 200.0, 5.0, columns, 80)));
    expect_message(error_of_site(parameters));
  }
}

TEST(ReleaseFaultsTest, CrossingOutlineIsReportedAtTheKey) {
  expect_message(error_of_site(case_with_release({{R"("name":"scarp")", polygon_json({{west + 300, south + 300},
                                                                                      {west + 400, south + 400},
                                                                                      {west + 400, south + 300},
                                                                                      {west + 300, south + 400}})}})));
}

}  // namespace
}  // namespace thawslide::gis
