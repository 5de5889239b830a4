// Error messages for releases that cannot be used.
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

constexpr const char* at_release = "case.toml:9:11: body.rock.release: ";
constexpr const char* at_thickness = "case.toml: body.rock.thickness: ";

TEST(ReleaseFaultsTest, OutsideTheTerrainModel) {
  EXPECT_EQ(
      error_of_site(case_with_release({{"", box_at(-500, 300, -400, 400)}})),
      std::string(at_release) +
          "FOLDER/release.geojson: the release lies outside the DEM, by 500 m in the west; found: x from "
          "399500 to 399600, y from 300300 to 300400; allowed: x from 400000 to 401000, y from 300000 to 300800. "
          "Check that both have the same location and reference system (the DEM has EPSG:31287), or use a larger DEM.");
  EXPECT_NE(error_of_site(case_with_release({{"", box_at(900, 300, 1010, 400)}}))
                .find("the release lies partly outside the DEM, by 10 m in the east;"),
            std::string::npos);
}

TEST(ReleaseFaultsTest, OutsideTheDomain) {
  EXPECT_EQ(
      error_of_site(case_with_release({{"", box_at(60, 300, 200, 720)}})),
      std::string(at_release) +
          "FOLDER/release.geojson: the release lies partly outside the domain, by 40 m in the west and 20 m in the "
          "north; found: x from 400060 to 400200, y from 300300 to 300720; allowed: x from 400100 to 400900, y from "
          "300100 to 300700. Widen grid.min and grid.max.");
  config::Case parameters = case_with_release({{"", box_at(101, 300, 200, 400)}});
  EXPECT_EQ(error_of_site(parameters), "no error");
}

TEST(ReleaseFaultsTest, TaperThatReachesTooFar) {
  config::Case parameters = case_with_release({{"", box_at(111, 300, 200, 400)}});
  parameters.locations["body.rock.taper"] = "--set body.rock.taper=50";
  parameters.bodies["rock"].taper = 50.0;
  EXPECT_EQ(
      error_of_site(parameters),
      "--set body.rock.taper=50: body.rock.taper: a taper of 50 m spreads the release 25 m beyond its outline, and "
      "outside the domain by 9 m in the west; allowed: up to 30 m. Set a narrower one, or widen grid.min and "
      "grid.max.");
  parameters.bodies["rock"].taper = 30.0;
  EXPECT_EQ(error_of_site(parameters), "no error");
  parameters.bodies["rock"].taper = 30.5;
  EXPECT_NE(error_of_site(parameters).find("by 4 m in the west; allowed: up to 30 m"), std::string::npos);
  parameters.bodies["rock"].taper = 500.0;
  EXPECT_EQ(error_of_site(parameters),
            "--set body.rock.taper=50: body.rock.taper: a taper of 500 m spreads the release 250 m beyond its outline, "
            "and outside the DEM by 134 m in the west; allowed: up to 230 m. Set a narrower one, or take a "
            "larger DEM.");
}

TEST(ReleaseFaultsTest, TaperOverNodata) {
  config::Case parameters = case_with_release({{"", box_at(300, 300, 400, 400)}});
  Raster dem = ground();
  dem.values[dem.index(83, 66)] = missing;
  parameters.terrain.file = geotiff("dem.tif", dem);
  parameters.bodies["rock"].taper = 20.0;
  EXPECT_EQ(error_of_site(parameters), "no error");
  parameters.bodies["rock"].taper = 40.0;
  EXPECT_EQ(
      error_of_site(parameters),
      "case.toml: body.rock.taper: a taper of 40 m spreads the release of FOLDER/release.geojson over nodata of the "
      "DEM at 1 points, such as 400415, 300330. Set a narrower one, or fill the holes "
      "(gdal_fillnodata.py FOLDER/dem.tif filled.tif).");
}

TEST(ReleaseFaultsTest, SmallerThanACellOfTheTerrainModel) {
  config::Case parameters = case_with_release({{"", box_at(300, 300, 303, 303)}}, 20.0);
  EXPECT_EQ(error_of_site(parameters),
            std::string(at_release) +
                "FOLDER/release.geojson: the release is smaller than a cell of the DEM (9 m2; 25 m2), over which it "
                "would be distributed and become too thin. Draw it larger, or resample the DEM "
                "(gdalwarp -tr 0.8 0.8 -r bilinear FOLDER/dem.tif finer.tif).");
  parameters.terrain.resample = 0.5;
  EXPECT_EQ(error_of_site(parameters), "no error");
}

TEST(ReleaseFaultsTest, OverNodata) {
  config::Case parameters = case_with_release({{"", box_at(300, 300, 400, 400)}});
  Raster dem = ground();
  dem.values[dem.index(70, 66)] = dem.values[dem.index(71, 66)] = missing;
  parameters.terrain.file = geotiff("dem.tif", dem);
  EXPECT_EQ(error_of_site(parameters),
            std::string(at_release) +
                "FOLDER/release.geojson: the release lies over nodata of the DEM at 2 of its points, such as "
                "400350, 300330. Fill the holes (gdal_fillnodata.py FOLDER/dem.tif filled.tif), or move the release.");
}

TEST(ReleaseFaultsTest, ThicknessMissing) {
  EXPECT_EQ(error_of_site(case_with_release({{"", box_at(300, 300, 400, 400)}}, 0.0)),
            std::string(at_thickness) +
                "the thickness of the release is 0 m; needed: more than 0. Set it to metres, or to { attribute = "
                "\"thickness\" } of the polygons, { raster = FILE } or { surface = FILE }.");
}

TEST(ReleaseFaultsTest, Attributes) {
  const std::string box = box_at(300, 300, 400, 400);
  config::Case parameters = case_with_release({{R"("thick":5)", box}, {R"("thick":null)", box}});
  parameters.bodies["rock"].thickness = {config::MapValue::From::attribute, 0.0, "thickness"};
  EXPECT_EQ(error_of_site(parameters), std::string(at_thickness) +
                                           "FOLDER/release.geojson: there is no attribute 'thickness', which "
                                           "body.rock.thickness asks for; the file has: thick; did you mean 'thick'?");
  parameters.bodies["rock"].thickness.source = "thick";
  EXPECT_EQ(error_of_site(parameters),
            std::string(at_thickness) +
                "FOLDER/release.geojson: the attribute 'thick' of polygon 2 is empty; needed: a "
                "number. Fill it in.");
  geojson("release.geojson", {{R"("thick":"5 m","name":"top")", box}});
  EXPECT_EQ(error_of_site(parameters), std::string(at_thickness) +
                                           "FOLDER/release.geojson: the attribute 'thick' of polygon 1 (top) is '5 m'; "
                                           "needed: a number. Fill it in.");
  geojson("release.geojson", {{R"("thick":-2)", box}});
  EXPECT_EQ(error_of_site(parameters), std::string(at_thickness) +
                                           "FOLDER/release.geojson: the attribute 'thick' is -2 m "
                                           "somewhere; allowed: 0 and more.");
  geojson("release.geojson", {{R"("thick":0)", box}});
  EXPECT_EQ(error_of_site(parameters),
            std::string(at_thickness) +
                "FOLDER/release.geojson: the release has no volume: its thickness is 0 everywhere. Needed: a thickness "
                "in metres.");
}

TEST(ReleaseFaultsTest, PolygonsOfDifferentThicknessMayNotOverlap) {
  config::Case parameters = case_with_release({{R"("thickness":5,"name":"upper")", box_at(300, 300, 400, 400)},
                                               {R"("thickness":7)", box_at(380, 300, 500, 400)}});
  parameters.bodies["rock"].thickness = {config::MapValue::From::attribute, 0.0, "thickness"};
  EXPECT_EQ(error_of_site(parameters),
            std::string(at_thickness) +
                "FOLDER/release.geojson: polygon 1 (upper) and polygon 2 overlap by 2,000 m2 about 400390, 300350, and "
                "their 'thickness' differs: 5 and 7. Give them the same value, or draw them apart.");
}

TEST(ReleaseFaultsTest, VolumeThatMustBeConfirmed) {
  config::Case parameters = case_with_release({{"", box_at(200, 200, 800, 600)}}, 8500.0);
  EXPECT_EQ(error_of_site(parameters),
            std::string(at_release) +
                "FOLDER/release.geojson: the release has 2,040,000,000 m3, is up to 8,500 m thick, and "
                "body.rock.largest_volume allows 200,000,000 m3. Is the thickness in the wrong unit? Metres are "
                "needed. If the volume is right, confirm it by a larger "
                "body.rock.largest_volume.");
  parameters.bodies["rock"].largest_volume = 3e9;
  EXPECT_EQ(error_of_site(parameters), "no error");
}

TEST(ReleaseFaultsTest, ThicknessRasters) {
  config::Case parameters = case_with_release({{"", box_at(300, 300, 400, 400)}});
  const auto with = [&](const Raster& thickness) {
    parameters.bodies["rock"].thickness = {config::MapValue::From::raster, 0.0, geotiff("thickness.tif", thickness)};
    return error_of_site(parameters);
  };
  EXPECT_EQ(with(raster_of([](double, double) { return -1.5; }, west, south, 5.0, 201, 161)),
            std::string(at_thickness) +
                "FOLDER/thickness.tif: the thickness at 400300, 300300 is -1.5 m; allowed: 0 and more.");
  EXPECT_EQ(
      with(raster_of([](double, double) { return 1.0; }, west + 600.0, south, 5.0, 20, 20)),
      std::string(at_thickness) +
          "FOLDER/thickness.tif: the raster (x from 400600 to 400695, y from 300000 to 300095) does not reach the "
          "release (x from 400290 to 400410, y from 300290 to 300410). Check that both are in the same place and "
          "reference system.");
  EXPECT_EQ(
      with(raster_of([](double x, double) { return x > west + 500.0 ? 1.0 : 0.0; }, west, south, 5.0, 201, 161)),
      std::string(at_thickness) +
          "FOLDER/release.geojson: the release has no volume: its thickness is 0 everywhere. Needed: a thickness in "
          "metres.");
}

TEST(ReleaseFaultsTest, RasterAsTheRelease) {
  config::Case parameters = plain_case(ground());
  const auto with = [&](const Raster& thickness) {
    parameters.bodies["rock"] = raster_body(geotiff("release.tif", thickness));
    return error_of_site(parameters);
  };
  EXPECT_EQ(with(raster_of([](double, double) { return 0.0; }, west, south, 5.0, 201, 161)),
            "case.toml: body.rock.thickness: FOLDER/release.tif: the thickness is not above 0 at any point: there is "
            "no release.");
  EXPECT_EQ(with(raster_of([](double x, double) { return x > west + 300.0 ? 2.0 : -0.5; }, west + 200.0, south + 200.0,
                           5.0, 60, 40)),
            "case.toml: body.rock.thickness: FOLDER/release.tif: the thickness at 400200, 300200 is -0.5 m; allowed: 0 "
            "and more.");
  EXPECT_NE(with(raster_of([](double, double) { return 2.0; }, west, south, 5.0, 100, 100))
                .find("the release lies partly outside the domain, by 100 m in the west and 100 m in the south;"),
            std::string::npos);
  parameters.bodies["rock"] = release_body(geotiff("release.tif", ground()), 5.0);
  EXPECT_EQ(
      error_of_site(parameters),
      std::string(at_release) +
          "FOLDER/release.tif: the file is a raster; needed: polygons, in a Shapefile, GeoPackage, GeoJSON or KML. A "
          "raster of a body's thickness goes to thickness = { raster = \"FILE\" }, which needs no polygons.");
  parameters.bodies["rock"] = raster_body(geotiff("before.tif", ground()));
  parameters.bodies["rock"].thickness.from = config::MapValue::From::surface;
  EXPECT_EQ(error_of_site(parameters),
            "case.toml: body.rock.thickness: FOLDER/before.tif: the surface before the slide is at most 0.01 m above "
            "the DEM: there is no release. Are the two files swapped?");
  parameters.bodies["rock"] = raster_body(in_folder("none.tif"));
  EXPECT_EQ(error_of_site(parameters),
            "case.toml: body.rock.thickness: FOLDER/none.tif: there is no such file. Correct the path.");
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
  EXPECT_EQ(with(-3.0),
            std::string(at_thickness) +
                "FOLDER/before.tif: at 400300, 300300, within the release, the surface before the slide lies 3 "
                "m below the DEM; allowed: above it, or below by up to 0.01 m. Are the two files swapped? "
                "Else draw the release smaller, or set body.rock.surface_tolerance to the noise of the two.");
  body.surface_tolerance = 3.5;
  EXPECT_EQ(with(-3.0), std::string(at_thickness) +
                            "FOLDER/release.geojson: the release has no volume: its thickness is 0 everywhere. Needed: "
                            "a thickness in metres.");
  body.surface_tolerance = 0.01;
  body.placement = config::Placement::cut;
  EXPECT_EQ(with(12.0),
            "case.toml: body.rock.placement: a thickness from a surface before the slide to the DEM requires that the "
            "DEM is the sliding surface: nothing is cut out of it. Set \"on_top\".");
  body.placement = config::Placement::on_top;
  body.thickness_along = config::ThicknessAlong::normal;
  EXPECT_EQ(with(12.0),
            "case.toml: body.rock.thickness_along: the difference of two surfaces is vertical. Set "
            "\"vertical\", or leave the key out.");
}

TEST(ReleaseFaultsTest, FieldsOutOfRange) {
  config::Case parameters = case_with_release({{R"("t":-8,"n":0)", box_at(300, 300, 400, 400)}});
  config::Body& body = parameters.bodies["rock"];
  body.porosity.over = InitialField::Over::attribute;
  body.porosity.source = "n";
  EXPECT_EQ(error_of_site(parameters),
            "case.toml: body.rock.porosity: FOLDER/release.geojson: at 400300, 300300, within "
            "the release, the porosity is 0; allowed: above 0 and up to 0.95.");
  body.porosity = InitialField(0.3);
  body.temperature.over = InitialField::Over::raster;
  body.temperature.source =
      geotiff("t.tif", raster_of([](double, double) { return 265.0; }, west + 200.0, south + 200.0, 5.0, 80, 80));
  EXPECT_EQ(error_of_site(parameters),
            "case.toml: body.rock.temperature: FOLDER/t.tif: at 400300, 300300, within the "
            "release, the temperature is 265 C; allowed: above -273.15 C and up to 100 C.");
  body.temperature.source =
      geotiff("t.tif", raster_of([](double, double) { return -5.0; }, west + 200.0, south + 200.0, 5.0, 35, 80));
  EXPECT_EQ(error_of_site(parameters),
            "case.toml: body.rock.temperature: FOLDER/t.tif: at 400375, 300300, within the "
            "release, the temperature is missing; allowed: above -273.15 C and up to 100 C.");
}

TEST(ReleaseFaultsTest, CrossingOutlineIsReportedAtTheKey) {
  EXPECT_EQ(
      error_of_site(case_with_release({{R"("name":"scarp")", polygon_json({{west + 300, south + 300},
                                                                           {west + 400, south + 400},
                                                                           {west + 400, south + 300},
                                                                           {west + 300, south + 400}})}})),
      std::string(at_release) +
          "FOLDER/release.geojson: polygon 1 (scarp) crosses itself at or near 400350 300350. Correct its outline "
          "there (QGIS: Vector > Geometry Tools > Check Validity).");
}

}  // namespace
}  // namespace thawslide::gis
