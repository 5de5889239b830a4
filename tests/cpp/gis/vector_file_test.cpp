// Polygons, lines and points in files, and error messages for unusable ones.
#include "gis/vector_file.hpp"

#include <ogrsf_frmts.h>

#include "gis/geopackage.hpp"
#include "map_files.hpp"

namespace thawslide::gis {
namespace {

using namespace map_files;

std::string ground() { return reference_system_named("EPSG:31287"); }

VectorLayer polygons_of(const char* name, const std::vector<JsonFeature>& features, const std::string& epsg = "31287") {
  return read_polygons(geojson(name, features, epsg), ground());
}

std::string error_of_polygons(const std::string& file) {
  return error_of([&] { return read_polygons(file, ground()); });
}

// One box of 100 m x 50 m with its attributes, in the format of the driver.
std::string foreign_polygon(const char* driver, const std::string& name, const std::string& crs) {
  GDALAllRegister();
  const std::string file = in_folder(name);
  const GDALDatasetUniquePtr dataset(
      GetGDALDriverManager()->GetDriverByName(driver)->Create(file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  OGRSpatialReference reference;
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  if (!crs.empty()) {
    reference.SetFromUserInput(crs.c_str());
  }
  OGRLayer* layer = dataset->CreateLayer("release", crs.empty() ? nullptr : &reference, wkbPolygon, nullptr);
  OGRFieldDefn title("Name", OFTString), thickness("THICKNESS", OFTReal), class_of("class", OFTInteger);
  layer->CreateField(&title);
  layer->CreateField(&thickness);
  layer->CreateField(&class_of);
  OGRFeature feature(layer->GetLayerDefn());
  feature.SetField("Name", "north");
  feature.SetField("THICKNESS", 12.5);
  feature.SetField("class", 3);
  OGRLinearRing ring;
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {0.0, 50.0}, {100.0, 50.0}, {100.0, 0.0}, {0.0, 0.0}}) {
    ring.addPoint(400000.0 + x, 300000.0 + y);
  }
  OGRPolygon polygon;
  polygon.addRing(&ring);
  feature.SetGeometry(&polygon);
  EXPECT_EQ(layer->CreateFeature(&feature), OGRERR_NONE);
  return file;
}

TEST(VectorFileTest, EveryFormatIsRead) {
  for (const auto& [driver, name] : {std::pair{"ESRI Shapefile", "release.shp"}, {"GPKG", "release.gpkg"}}) {
    const VectorLayer layer = read_polygons(foreign_polygon(driver, name, "EPSG:31287"), ground());
    SCOPED_TRACE(name);
    ASSERT_EQ(layer.features.size(), 1U);
    const Feature& feature = layer.features.front();
    EXPECT_NEAR(area_of(feature.polygons), 5000.0, 1e-6);
    EXPECT_EQ(feature.title, "polygon 1 (north)");
    EXPECT_EQ(feature.texts.at("Name"), "north");
    EXPECT_EQ(feature.numbers.at("THICKNESS"), 12.5);
    EXPECT_EQ(feature.numbers.at("class"), 3.0);
    EXPECT_EQ(feature.numbers.count("Name"), 0U);
    EXPECT_EQ(layer.warnings, std::vector<std::string>{});
    EXPECT_EQ(attribute_named(layer, "thickness", "body.rock.thickness"), "THICKNESS");
    EXPECT_EQ(error_of([&] { return attribute_named(layer, "thicknes", "body.rock.thickness"); }),
              "FOLDER/" + std::string(name) +
                  ": there is no attribute 'thicknes', which body.rock.thickness asks for; the file has: Name, "
                  "THICKNESS, class; did you mean 'THICKNESS'?");
  }
  const VectorLayer layer = polygons_of("r.geojson", {{R"("a":1.5)", box_json(400000, 300000, 400100, 300050)}});
  EXPECT_NEAR(area_of(layer.features.front().polygons), 5000.0, 1e-6);
  EXPECT_EQ(layer.features.front().title, "polygon 1");
}

TEST(VectorFileTest, ShapefileWithoutPrjIsInTheSystemOfTheGround) {
  const std::string file = foreign_polygon("ESRI Shapefile", "bare.shp", "");
  const VectorLayer layer = read_polygons(file, ground());
  EXPECT_EQ(layer.features.front().polygons.front().outline.front()[0], 400000.0);
  EXPECT_EQ(layer.warnings, std::vector<std::string>{"bare.shp specifies no coordinate reference system: that of the "
                                                     "DEM, EPSG:31287, is assumed"});
}

TEST(VectorFileTest, OtherSystemsAreReprojectedAndReported) {
  std::vector<double> x{400000.0, 400100.0, 400100.0, 400000.0}, y{300000.0, 300000.0, 300050.0, 300050.0};
  ASSERT_TRUE(Reprojection(ground(), reference_system_named("EPSG:4326")).apply(x, y));
  const VectorLayer layer =
      polygons_of("r.geojson", {{"", polygon_json({{x[0], y[0]}, {x[1], y[1]}, {x[2], y[2]}, {x[3], y[3]}})}}, "4326");
  EXPECT_EQ(layer.warnings, std::vector<std::string>{"note: r.geojson was reprojected from EPSG:4326 to EPSG:31287"});
  EXPECT_NEAR(layer.features.front().polygons.front().outline.front()[0], 400000.0, 0.01);
  EXPECT_NEAR(area_of(layer.features.front().polygons), 5000.0, 2.0);
  const VectorLayer impossible = polygons_of("r.geojson", {{"", box_json(400000, 300000, 400100, 300050)}}, "4326");
  EXPECT_EQ(impossible.warnings,
            std::vector<std::string>{"r.geojson specifies degrees (EPSG:4326), which 400000, 300000 cannot be: the "
                                     "system of the DEM, EPSG:31287, is assumed"});
}

TEST(VectorFileTest, FeaturesAreChosenByName) {
  const std::string box = box_json(0, 0, 10, 10);
  const VectorLayer layer = polygons_of(
      "r.geojson",
      {{R"("name":"north")", box}, {R"("name":"south")", box}, {R"("name":"north")", box}, {R"("name":null)", box}});
  EXPECT_EQ(features_named(layer, {}, "name").size(), 4U);
  EXPECT_EQ(features_named(layer, {"north"}, "NAME").size(), 2U);
  EXPECT_EQ(features_named(layer, {"north", "south"}, "name").size(), 3U);
  expect_message(error_of([&] { return features_named(layer, {"suoth"}, "name"); }));
  expect_message(error_of([&] { return features_named(layer, {"north"}, "title"); }));
}

TEST(VectorFileTest, NamesAreMatchedExactlyFirstAndThenIgnoringCase) {
  const std::string box = box_json(0, 0, 10, 10);
  const VectorLayer layer =
      polygons_of("r.geojson", {{R"("Thickness":2.0,"thickness":10.0,"NAME":"old","name":"a","Density":5)", box}});
  EXPECT_EQ(attribute_named(layer, "thickness", "key"), "thickness");
  EXPECT_EQ(attribute_named(layer, "Thickness", "key"), "Thickness");
  EXPECT_EQ(attribute_named(layer, "DENSITY", "key"), "Density");
  EXPECT_EQ(layer.features.front().numbers.at("thickness"), 10.0);
  EXPECT_EQ(layer.features.front().numbers.at("Thickness"), 2.0);
  EXPECT_EQ(layer.features.front().title, "polygon 1 (a)");
  EXPECT_EQ(features_named(layer, {"a"}, "name").size(), 1U);
  EXPECT_EQ(features_named(layer, {"old"}, "NAME").size(), 1U);
  expect_message(error_of([&] { return attribute_named(layer, "THICKNESS", "body.rock.thickness"); }));
}

TEST(VectorFileTest, BooleansDatesAndTextsAreNotNumbers) {
  const std::string box = box_json(0, 0, 10, 10);
  const VectorLayer layer = polygons_of(
      "r.geojson", {{R"("is_thick":true,"is_thin":false,"day":"2016-06-28","text":"10","list":[1,2],"n":7)", box}});
  const Feature& feature = layer.features.front();
  EXPECT_EQ(feature.numbers, (std::map<std::string, double>{{"n", 7.0}}));
  EXPECT_EQ(feature.texts.at("is_thick"), "true");
  EXPECT_EQ(feature.texts.at("is_thin"), "false");
  for (const auto& [name, value] :
       {std::pair("is_thick", "true"), {"is_thin", "false"}, {"text", "10"}, {"day", "2016/06/28"}}) {
    EXPECT_EQ(error_of([&, asked = name] { return areas_by_value(layer, asked, "body.rock.thickness"); }),
              fmt::format("FOLDER/r.geojson: the attribute '{}' of polygon 1 is '{}'; needed: a number. Fill it in.",
                          name, value));
  }
}

TEST(VectorFileTest, KmlIsReadInDegrees) {
  const std::string file = text_file(
      "release.kml",
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document><Folder>"
      "<name>areas</name><Placemark><name>rock</name><Polygon><outerBoundaryIs><LinearRing><coordinates>"
      "13.333333,47.5,0 13.334333,47.5,0 13.334333,47.501,0 13.333333,47.5,0"
      "</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></Folder></Document></kml>\n");
  const VectorLayer layer = read_polygons(file, reference_system_named("EPSG:31287"));
  ASSERT_EQ(layer.features.size(), 1U);
  EXPECT_EQ(layer.features.front().title, "polygon 1 (rock)");
  const auto& corner = layer.features.front().polygons.front().outline.front();
  EXPECT_NEAR(corner[0], 400000.0, 200.0) << "the central meridian of the system";
  EXPECT_NEAR(corner[1], 400000.0, 200.0);
}

TEST(VectorFileTest, WrongFiles) {
  expect_message(error_of_polygons(text_file("lone.shp", "a Shapefile whose index is missing")));
  EXPECT_EQ(error_of_polygons(in_folder("none.shp")), "FOLDER/none.shp: there is no such file. Correct the path.");
  const std::string nonsense = error_of_polygons(text_file("bad.gpkg", "this is no GeoPackage"));
  expect_message(nonsense);
  expect_message(nonsense);
  const std::string box = box_json(0, 0, 9, 9), line = line_json({{0, 0}, {5, 5}});
  const std::string bow = polygon_json({{0, 0}, {10, 10}, {10, 0}, {0, 10}});
  for (const auto& [name, features] : std::vector<std::pair<const char*, std::vector<JsonFeature>>>{
           {"empty", {}},
           {"way", {{"", line}}},
           {"hollow", {{"", box}, {"", "null"}}},
           {"mixed", {{"", box}, {"", line}}},
           {"flat", {{R"("name":"crack")", polygon_json({{0, 0}, {5, 5}, {9, 9}})}}},
           {"two", {{"", polygon_json({{0, 0}, {5, 5}})}}},
           {"bow", {{"", box}, {R"("name":"scarp")", bow}}}}) {
    expect_message(error_of_polygons(geojson(std::string(name) + ".geojson", features)));
  }
  const Polygons area{{{{0, 0}, {1, 0}, {1, 1}, {0, 0}}, {}}};
  write_geopackage(in_folder("two.gpkg"),
                   {{"scarp", std::vector<Polygons>{area}, {}}, {"lake", std::vector<Polygons>{area}, {}}}, ground());
  expect_message(error_of_polygons(in_folder("two.gpkg")));
}

TEST(VectorFileTest, ControlCharactersInNamesAreReplacedInMessages) {
  const std::string polygon = box_json(0, 0, 9, 9);
  const VectorLayer layer = polygons_of("steering.geojson", {{R"("name": "a\u001b[2J")", polygon}});
  EXPECT_EQ(layer.features.front().title, "polygon 1 (a?[2J)");
  EXPECT_EQ(layer.features.front().texts.at("name"), "a\x1b[2J") << "values are unchanged";
  expect_message(error_of([&] { return features_named(layer, {"b"}, "name"); }));
  const VectorLayer other = polygons_of("letters.geojson", {{R"("th\u0007ick": 3)", polygon}});
  expect_message(error_of([&] { return attribute_named(other, "mass", "body.slide.thickness"); }));
}

TEST(VectorFileTest, TruncatedShapefile) {
  const std::string file = foreign_polygon("ESRI Shapefile", "cut.shp", "EPSG:31287");
  std::filesystem::resize_file(file, 120);
  // The part in between is GDAL's own message.
  const std::string message = error_of_polygons(file);
  const std::string begin = "FOLDER/cut.shp: the features cannot be read; GDAL says: ";
  const std::string end = ". The file seems to be damaged or truncated: copy it again.";
  EXPECT_EQ(message.substr(0, begin.size()), begin) << message;
  EXPECT_EQ(message.substr(message.size() - std::min(end.size(), message.size())), end) << message;
}

}  // namespace
}  // namespace thawslide::gis
