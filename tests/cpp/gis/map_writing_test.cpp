// Output for a GIS: GeoPackages that can be opened again, and styles that are valid XML.
#include <cpl_minixml.h>
#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "base/atomic_file.hpp"
#include "gis/geopackage.hpp"
#include "gis/map_style.hpp"
#include "gis/vector_file.hpp"
#include "map_files.hpp"
#include "sim/maps/map_kinds.hpp"

namespace thawslide::gis {
namespace {

using namespace map_files;

std::vector<MapLayer> layers() {
  const Polygon with_hole{{{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}}, {{{2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}}}};
  const Polygon adjacent{{{20, 0}, {29, 0}, {29, 9}, {20, 0}}, {}};
  return {
      {"affected_area", std::vector<Polygons>{{with_hole, adjacent}}, {{"area_m2", std::vector<double>{117.5}}}},
      {"front",
       std::vector<Polyline2>{{{0, 0}, {3, 4}}, {{1, 1}, {2, 2}, {3, 1}}},
       {{"time_s", std::vector<double>{10.0, missing}}, {"note", std::vector<std::string>{"first", ""}}}},
      {"probes", std::vector<std::array<double, 2>>{{5.5, 6.5}}, {{"name", std::vector<std::string>{"hut <A&B>"}}}}};
}

TEST(MapWritingTest, GeopackageCanBeReadBack) {
  const std::string file = in_folder("maps.gpkg"), ground = reference_system_named("EPSG:31287");
  write_geopackage(file, layers(), ground);
  write_geopackage(file, layers(), ground);  // an existing one is replaced
  const VectorLayer area = read_polygons(file, ground);
  EXPECT_EQ(area.warnings, std::vector<std::string>{});
  ASSERT_EQ(area.features.size(), 1U);
  EXPECT_NEAR(area_of(area.features[0].polygons), 81.0 - 4.0 + 40.5, 1e-12);
  EXPECT_EQ(area.features[0].numbers.at("area_m2"), 117.5);
  const VectorLayer front = read_lines(file, ground);
  ASSERT_EQ(front.features.size(), 2U);
  EXPECT_EQ(front.features[1].lines[0], (Polyline2{{1, 1}, {2, 2}, {3, 1}}));
  EXPECT_EQ(front.features[0].texts.at("note"), "first");
  EXPECT_EQ(front.features[1].numbers.count("time_s"), 0U);
  EXPECT_EQ(front.features[1].texts.count("note"), 0U);
  const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR));
  const std::unique_ptr<OGRFeature> probe(dataset->GetLayer(2)->GetNextFeature());
  EXPECT_EQ(probe->GetGeometryRef()->toPoint()->getX(), 5.5);
  EXPECT_EQ(probe->GetGeometryRef()->toPoint()->getY(), 6.5);
  EXPECT_STREQ(probe->GetFieldAsString("name"), "hut <A&B>");
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(file).parent_path())) {
    EXPECT_EQ(entry.path().filename(), "maps.gpkg") << "temporary file";
  }
}

TEST(MapWritingTest, LayersCarryTheirStyles) {
  std::vector<MapLayer> styled = layers();
  styled[1].style = vector_style({LayerKind::lines, {1, 2, 3}, 0.4, 1.0, "time_s"});
  write_geopackage(in_folder("maps.gpkg"), styled, "");
  const GDALDatasetUniquePtr dataset(GDALDataset::Open(in_folder("maps.gpkg").c_str(), GDAL_OF_VECTOR));
  EXPECT_EQ(dataset->GetLayerCount(), 4);
  OGRLayer& table = *dataset->GetLayerByName("layer_styles");
  ASSERT_EQ(table.GetFeatureCount(), 1);
  const std::unique_ptr<OGRFeature> row(table.GetNextFeature());
  EXPECT_STREQ(row->GetFieldAsString("f_table_name"), "front");
  EXPECT_STREQ(row->GetFieldAsString("f_geometry_column"), "geom");
  EXPECT_STREQ(row->GetFieldAsString("f_table_schema"), "");
  EXPECT_EQ(row->GetFieldAsString("styleQML"), styled[1].style);
  EXPECT_EQ(row->GetFieldAsInteger("useAsDefault"), 1);
  EXPECT_EQ(read_lines(in_folder("maps.gpkg"), "").features.size(), 2U);
}

std::string text_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// The format stores the date of the last change to a millisecond.
TEST(MapWritingTest, EqualLayersMakeEqualBytes) {
  const auto bytes = [&](const std::string& name) {
    std::vector<MapLayer> styled = layers();
    styled[1].style = vector_style({LayerKind::lines, {0, 0, 0}, 0.4, 1.0, ""});
    write_geopackage(in_folder(name), styled, reference_system_named("EPSG:31287"));
    return text_of(in_folder(name));
  };
  const std::string first = bytes("first.gpkg");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  EXPECT_GT(first.size(), 10000U);
  EXPECT_TRUE(first == bytes("second.gpkg"));
}

TEST(MapWritingTest, MissingFoldersAreReported) {
  const std::string message = error_of([] { write_geopackage(in_folder("no/such/maps.gpkg"), layers(), ""); });
  EXPECT_EQ(message.substr(0, 37), "cannot write FOLDER/no/such/maps.gpkg") << message;
}

// Returns the value of the attribute at a path of an XML file that GDAL can parse.
std::string in_xml(const std::string& file, const char* path) {
  CPLXMLNode* const root = CPLParseXMLFile(file.c_str());
  EXPECT_NE(root, nullptr);
  CPLXMLNode* const qgis = CPLGetXMLNode(root, "=qgis");
  const std::string value = qgis == nullptr ? "no root" : CPLGetXMLValue(qgis, path, "missing");
  CPLDestroyXMLNode(root);
  return value;
}

// Compares attributes of a style, each with its path and value.
void expect_in_xml(const std::string& file, const std::vector<std::pair<const char*, const char*>>& attributes) {
  for (const auto& [path, value] : attributes) {
    EXPECT_EQ(in_xml(file, path), value) << path;
  }
}

TEST(MapWritingTest, RasterStyleContainsItsClasses) {
  const std::string file = in_folder("max_pressure.qml");
  write_raster_style(file, style_of_map("max_pressure"));
  expect_in_xml(file, {{"pipe.rasterrenderer.type", "singlebandpseudocolor"},
                       {"pipe.rasterrenderer.classificationMax", "3000000"},
                       {"pipe.rasterrenderer.rasterTransparency.singleValuePixelList.pixelListEntry.max", "0"},
                       {"pipe.rasterrenderer.rastershader.colorrampshader.colorRampType", "DISCRETE"},
                       {"pipe.rasterrenderer.rastershader.colorrampshader.item.value", "3000"},
                       {"pipe.rasterrenderer.rastershader.colorrampshader.item.color", "#fcfdbf"},
                       {"pipe.rasterrenderer.rastershader.colorrampshader.item.label", "0 to 3 kPa"}});
  EXPECT_NE(text_of(file).find("value=\"inf\" label=\"above 3000 kPa\""), std::string::npos);
  write_raster_style(file, style_of_map("elevation_change"));
  expect_in_xml(file, {{"pipe.rasterrenderer.rasterTransparency", "missing"},
                       {"pipe.rasterrenderer.rastershader.colorrampshader.minimumValue", "-20"},
                       {"pipe.rasterrenderer.rastershader.colorrampshader.item.label", "below -20 m"}});
  EXPECT_NE(text_of(file).find("label=\"-0.5 to 0.5 m\" color=\"#f6f7f7\" alpha=\"0\""), std::string::npos);
}

TEST(MapWritingTest, HazardStylesHaveTheUsualLimits) {
  const std::vector<std::pair<const char*, std::vector<const char*>>> limits{
      {"max_thickness", {"0 to 0.5 m", "0.5 to 1 m", "1 to 2 m", "above 2 m"}},
      {"max_pressure", {"0 to 3 kPa", "3 to 30 kPa", "above 30 kPa"}}};
  for (const auto& [map, labels] : limits) {
    write_raster_style(in_folder("hazard.qml"), hazard_style_of_map(map));
    for (const char* label : labels) {
      EXPECT_NE(text_of(in_folder("hazard.qml")).find(fmt::format("label=\"{}\"", label)), std::string::npos) << label;
    }
  }
  EXPECT_TRUE(hazard_style_of_map("max_speed").classes.empty());
}

TEST(MapWritingTest, EveryMapHasAStyleWithIncreasingLimits) {
  for (const sim::MapKind& kind : sim::map_kinds()) {
    const RasterStyle style = style_of_map(kind.name);
    double before = style.lowest;
    for (const ColorClass& each : style.classes) {
      EXPECT_GT(each.upper, before) << kind.name;
      before = each.upper;
    }
  }
}

TEST(MapWritingTest, VectorStylesAreValid) {
  const std::string file = in_folder("style.qml");
  const auto expect = [&](const VectorStyle& style,
                          const std::vector<std::pair<const char*, const char*>>& attributes) {
    write_file_atomically(file, vector_style(style));
    expect_in_xml(file, attributes);
  };
  expect({LayerKind::polygons, {200, 30, 30}, 0.6, 0.2, ""},
         {{"renderer-v2.symbols.symbol.type", "fill"},
          {"renderer-v2.symbols.symbol.layer.Option.Option.value", "200,30,30,51"},
          {"labelsEnabled", "0"}});
  expect({LayerKind::lines, {0, 0, 0}, 0.4, 1.0, "time_s"},
         {{"renderer-v2.symbols.symbol.type", "line"}, {"labeling.settings.text-style.fieldName", "time_s"}});
  expect({LayerKind::points, {0, 0, 0}, 2.0, 1.0, "a<b"}, {{"renderer-v2.symbols.symbol.layer.class", "SimpleMarker"},
                                                           {"labeling.settings.text-style.fieldName", "a<b"}});
}

}  // namespace
}  // namespace thawslide::gis
