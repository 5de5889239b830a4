// Keys of a DEM, of releases, of fields from maps, of maps and probes: reading, defaults, errors.
#include <set>

#include "case_messages.hpp"
#include "config/describe.hpp"
#include "config/input_files.hpp"

namespace thawslide::config {
namespace {

namespace fs = std::filesystem;
using namespace case_messages;
using testing_support::case_from_text;

// The case on the DEM with additional lines below body.slide.thickness, from line 22 on.
std::string with_body_lines(const std::string& lines) {
  return changed({{"thickness = 10.0", "thickness = 10.0\n" + lines}}, valid_case_on_dem);
}

class Maps : public testing::Test {
 protected:
  void SetUp() override { write_map_files(); }

  static Case read(const std::vector<Change>& changes, const std::vector<std::string>& sets = {}) {
    return case_from_text(changed(changes, valid_case_on_dem), sets);
  }
  static std::string error_on_dem(const std::vector<Change>& changes, const std::vector<std::string>& sets = {}) {
    return error_of_text(changed(changes, valid_case_on_dem), sets);
  }
  static std::string path_of(const std::string& name) { return (folder_of_this_test() / name).string(); }
};

TEST_F(Maps, HaveDefaults) {
  const Case found = read({});
  EXPECT_EQ(found.terrain.kind, TerrainKind::dem);
  EXPECT_EQ(found.terrain.file, path_of("dem.tif"));
  EXPECT_EQ(found.terrain.crs, "");
  EXPECT_EQ(found.terrain.resample, 0.0);
  EXPECT_TRUE(found.terrain.smooth.is_auto);
  EXPECT_EQ(found.grid.leaving, Policy::stop);
  const Body& slide = found.bodies.at("slide");
  EXPECT_EQ(slide.shape, BodyShape::release);
  EXPECT_EQ(slide.release, path_of("release.geojson"));
  EXPECT_TRUE(slide.polygons.empty());
  EXPECT_EQ(slide.name_attribute, "name");
  EXPECT_EQ(slide.thickness.from, MapValue::From::number);
  EXPECT_EQ(slide.thickness.number, 10.0);
  EXPECT_EQ(slide.thickness_along, ThicknessAlong::vertical);
  EXPECT_EQ(slide.placement, Placement::on_top);
  EXPECT_EQ(slide.taper, 0.0);
  EXPECT_EQ(slide.largest_volume, 2e8);
  EXPECT_FALSE(slide.saturation.is_given());
  EXPECT_FALSE(slide.ice_content.is_given());
  EXPECT_EQ(found.maps.cell, 0.0);
  EXPECT_EQ(found.maps.arrival_thickness, 0.1);
  EXPECT_EQ(found.maps.path, "");
  EXPECT_TRUE(found.probes.empty());
}

TEST_F(Maps, AreRead) {
  const Case found = read(
      {{"[grid]", "[grid]\nleaving = \"remove\""},
       {"thickness = 10.0",
        "thickness = { attribute = \"depth_m\" }\npolygons = [\"north\", \"south\"]\nname_attribute = \"part\"\n"
        "thickness_along = \"normal\"\nplacement = \"cut\"\ntaper = 15.0\nlargest_volume = 1e9\n"
        "temperature = { raster = \"map.tif\" }\nice_content = { attribute = \"ice\" }"},
       {"[basal]",
        "[maps]\ncell = 20.0\narrival_thickness = 0.5\npath = \"line.geojson\"\n[probe.gauge]\npoint = [3.5, 4.0]\n"
        "[probe.section]\nline = \"line.geojson\"\n[basal]"}});
  const Body& slide = found.bodies.at("slide");
  EXPECT_EQ(slide.thickness.from, MapValue::From::attribute);
  EXPECT_EQ(slide.thickness.source, "depth_m");
  EXPECT_EQ(slide.polygons, (std::vector<std::string>{"north", "south"}));
  EXPECT_EQ(slide.name_attribute, "part");
  EXPECT_EQ(slide.thickness_along, ThicknessAlong::normal);
  EXPECT_EQ(slide.placement, Placement::cut);
  EXPECT_EQ(slide.taper, 15.0);
  EXPECT_EQ(slide.largest_volume, 1e9);
  EXPECT_EQ(slide.temperature.over, InitialField::Over::raster);
  EXPECT_EQ(slide.temperature.source, path_of("map.tif"));
  EXPECT_EQ(slide.ice_content.over, InitialField::Over::attribute);
  EXPECT_EQ(slide.ice_content.source, "ice");
  EXPECT_EQ(found.grid.leaving, Policy::remove);
  EXPECT_EQ(found.maps.cell, 20.0);
  EXPECT_EQ(found.maps.arrival_thickness, 0.5);
  EXPECT_EQ(found.maps.path, path_of("line.geojson"));
  EXPECT_EQ(found.probes.at("gauge").point, (Point{3.5, 4.0, 0.0}));
  EXPECT_EQ(found.probes.at("gauge").line, "");
  EXPECT_EQ(found.probes.at("section").line, path_of("line.geojson"));
}

TEST_F(Maps, AreSetOnTheCommandLine) {
  const fs::path here = fs::current_path();
  const std::string file = fs::relative(folder_of_this_test() / "map.tif", here).string();
  const Case found = read(
      {}, {"grid.leaving=remove", "terrain.crs=EPSG:31287", "terrain.resample=20", "body.slide.polygons=[\"a\"]",
           "body.slide.thickness={ surface = \"" + file + "\" }", "maps.arrival_thickness=1", "terrain.file=" + file});
  EXPECT_EQ(found.grid.leaving, Policy::remove);
  EXPECT_EQ(found.terrain.crs, "EPSG:31287");
  EXPECT_EQ(found.terrain.resample, 20.0);
  EXPECT_EQ(found.bodies.at("slide").polygons, std::vector<std::string>{"a"});
  EXPECT_EQ(found.bodies.at("slide").thickness.from, MapValue::From::surface);
  EXPECT_TRUE(fs::equivalent(found.bodies.at("slide").thickness.source, folder_of_this_test() / "map.tif"));
  EXPECT_TRUE(fs::path(found.bodies.at("slide").thickness.source).is_absolute());
  EXPECT_EQ(found.maps.arrival_thickness, 1.0);
  EXPECT_TRUE(fs::equivalent(found.terrain.file, folder_of_this_test() / "map.tif"));
}

TEST_F(Maps, OfThicknessNeedNoPolygons) {
  for (const std::string kind : {"raster", "surface"}) {
    EXPECT_EQ(error_on_dem(
                  {{"release = \"release.geojson\"\nthickness = 10.0", "thickness = { " + kind + " = \"map.tif\" }"}}),
              "no error");
  }
  for (const std::string value : {"10.0", "{ attribute = \"depth\" }"}) {
    EXPECT_EQ(error_on_dem({{"release = \"release.geojson\"\nthickness = 10.0", "thickness = " + value}}),
              "FOLDER/case.toml:17:1: key 'body.slide.release' is missing: it is needed when the shape is \"release\" "
              "and thickness is a number or an attribute. Add 'release = ...' to [body.slide]: file of the release "
              "polygons: Shapefile, GeoPackage or GeoJSON, the path of a file, in quotes.");
  }
}

TEST_F(Maps, OfThicknessReportMistakes) {
  const auto with_thickness = [](const std::string& value) {
    return error_on_dem({{"thickness = 10.0", "thickness = " + value}});
  };
  const std::string start = "FOLDER/case.toml:21:13: body.slide.thickness ";
  const std::string allowed =
      "; allowed: a number, { attribute = \"NAME\" }, { raster = \"FILE\" } or { surface = \"FILE\" }, > 0 [m].";
  EXPECT_EQ(with_thickness("0"),
            start +
                "is 0; allowed: > 0 m (release thickness: a number, an attribute of the polygons, a raster of "
                "thickness, or a raster of the surface before the event, from which the DEM is subtracted).");
  EXPECT_EQ(with_thickness("\"thick\""), start + "is the text \"thick\"" + allowed);
  EXPECT_EQ(with_thickness("{ rastr = \"map.tif\" }"), start + "is a table with the keys rastr" + allowed);
  EXPECT_EQ(with_thickness("{ raster = \"map.tif\", surface = \"map.tif\" }"),
            start + "is a table with the keys raster, surface" + allowed);
  EXPECT_EQ(with_thickness("{ attribute = 3 }"),
            "FOLDER/case.toml:21:27: body.slide.thickness has 3 as its attribute; allowed: the name of an attribute of "
            "the polygons, in quotes.");
  EXPECT_EQ(
      with_thickness("{ raster = \"\" }"),
      "FOLDER/case.toml:21:24: body.slide.thickness has the text \"\" as its raster; allowed: the path of a file, "
      "in quotes.");
  EXPECT_EQ(with_thickness("{ raster = \"no.tif\" }"),
            "FOLDER/case.toml:21:24: body.slide.thickness is \"no.tif\": no such file (FOLDER); allowed: a file, "
            "relative to the folder of the case file.");
  EXPECT_EQ(with_thickness("{ raster = \"../no.tif\" }"),
            "FOLDER/case.toml:21:24: body.slide.thickness is \"../no.tif\", which lies outside the folder of the case "
            "file; allowed: a file in that folder. Copy it there, or give its path with --set "
            "body.slide.thickness='{ raster = \"PATH\" }'.");
  EXPECT_EQ(error_on_dem({{"thickness = 10.0\n", ""}}),
            "FOLDER/case.toml:17:1: key 'body.slide.thickness' is missing: it is needed when the shape is \"release\". "
            "Add 'thickness = ...' to [body.slide]: release thickness: a number, an attribute of the polygons, a "
            "raster of thickness, or a raster of the surface before the event, from which the DEM is subtracted, a "
            "number, { attribute = \"NAME\" }, { raster = \"FILE\" } or { surface = \"FILE\" }, > 0 [m].");
}

TEST_F(Maps, OfASurfaceGiveAVerticalThicknessOnTheDem) {
  const std::vector<Change> surface{{"thickness = 10.0", "thickness = { surface = \"map.tif\" }"}};
  EXPECT_EQ(
      error_on_dem(surface, {"body.slide.thickness_along=normal"}),
      "--set body.slide.thickness_along=normal: body.slide.thickness_along is \"normal\", and body.slide.thickness "
      "is the difference of two surfaces, which is vertical. Set body.slide.thickness_along = \"vertical\".");
  EXPECT_EQ(
      error_on_dem(surface, {"body.slide.placement=cut"}),
      "--set body.slide.placement=cut: body.slide.placement is \"cut\", and body.slide.thickness is what a surface "
      "has above the DEM; that lies on the DEM. Set body.slide.placement = \"on_top\".");
}

TEST_F(Maps, AreForBodiesOfTheShapeRelease) {
  EXPECT_EQ(
      error_of_text(valid_case, {"body.block.temperature={ raster = \"" + path_of("map.tif") + "\" }"}),
      "--set body.block.temperature={ raster = \"FOLDER/map.tif\" }: body.block.temperature is a raster, and "
      "body.block.shape is not \"release\"; only a release takes it from maps. Give a number or a table over depth "
      "or x.");
  EXPECT_EQ(error_of_changed({{"shape = \"box\"", "shape = \"box\"\nporosity = { attribute = \"n\" }"}}),
            "FOLDER/case.toml:18:12: body.block.porosity is an attribute of polygons, and body.block.shape is not "
            "\"release\"; only a release takes it from maps. Give a number or a table over depth or x.");
  EXPECT_EQ(error_on_dem({{"release = \"release.geojson\"\nthickness = 10.0",
                           "thickness = { raster = \"map.tif\" }\nporosity = { attribute = \"n\" }"}}),
            "FOLDER/case.toml:21:12: body.slide.porosity is the attribute \"n\", and body.slide.release is not given; "
            "there are no polygons to have it. Give the file of polygons, or a number, a table or a raster.");
  EXPECT_EQ(error_of_changed({{"shape = \"box\"", "shape = \"box\"\ntaper = 5.0"}}),
            "FOLDER/case.toml:18:9: body.block.taper has a meaning only when the shape is \"release\". Remove it, or "
            "change body.block.shape.");
  EXPECT_EQ(error_of_text(with_body_lines("surface_tolerance = 0.5")),
            "FOLDER/case.toml:22:21: body.slide.surface_tolerance has a meaning only when the shape is \"release\" and "
            "thickness is a surface. Remove it, or change body.slide.thickness.");
  EXPECT_EQ(
      error_on_dem({{"release = \"release.geojson\"\nthickness = 10.0",
                     "thickness = { raster = \"map.tif\" }\npolygons = [\"a\"]"}}),
      "FOLDER/case.toml:21:12: body.slide.polygons has a meaning only when the shape is \"release\" and release is "
      "given. Remove it, or change body.slide.release.");
  EXPECT_EQ(error_of_text(with_body_lines("min = [0.0, 0.0, 0.0]")),
            "FOLDER/case.toml:22:7: body.slide.min has a meaning only when the shape is not \"release\". Remove it, or "
            "change body.slide.shape.");
  EXPECT_EQ(error_of_text(with_body_lines("polygons = [\"a\", 2]")),
            "FOLDER/case.toml:22:18: body.slide.polygons holds 2; allowed: an array of texts in quotes. Correct it, or "
            "leave it out for the default [].");
}

TEST_F(Maps, OfADemAreTheGroundInThreeDimensions) {
  EXPECT_EQ(
      error_of_text(changed({{"type = \"flat\"\nelevation = 0.0", "type = \"dem\"\nfile = \"dem.tif\""}})),
      "FOLDER/case.toml:9:8: terrain.type is \"dem\", and case.dimension is 2; a DEM is the ground of a 3D case. Set "
      "case.dimension = 3, or cut a 2D case out of the DEM with `thawslide section`.");
  EXPECT_EQ(error_on_dem({{"file = \"dem.tif\"\n", ""}}),
            "FOLDER/case.toml:10:1: key 'terrain.file' is missing: it is needed when terrain.type is \"profile\" or "
            "\"dem\". Add 'file = ...' to [terrain]: file of the terrain; profile: CSV file with the columns "
            "distance_m,terrain_elevation_m[,surface_elevation_m]; dem: GeoTIFF or ESRI ASCII grid, the path of a "
            "file, in quotes.");
  EXPECT_EQ(
      error_on_dem({{"[terrain]", "[terrain]\nrepresentation = \"rigid_points\""}}),
      "FOLDER/case.toml:11:18: terrain.representation is \"rigid_points\", and terrain.type is \"dem\"; rigid points "
      "stand for profiles and planes only. Set terrain.representation = \"signed_distance\", or leave it out.");
  EXPECT_EQ(error_on_dem({{"[terrain]", "[terrain]\nextend = true"}}),
            "FOLDER/case.toml:11:10: terrain.extend has a meaning only when terrain.type is not \"dem\". Remove it, or "
            "change terrain.type.");
  EXPECT_EQ(
      error_of_changed({{"elevation = 0.0", "smooth = 5.0"}}),
      "FOLDER/case.toml:10:10: terrain.smooth has a meaning only when terrain.type is \"dem\". Remove it, or change "
      "terrain.type.");
  EXPECT_EQ(
      error_on_dem({{"[terrain]", "[terrain]\ncrs = \"EPSG:31287\""}}, {"terrain.type=flat"}),
      "--set terrain.type=flat: terrain.crs has a meaning only when terrain.type is \"dem\". Remove it, or change "
      "terrain.type.\n"
      "--set terrain.type=flat: body.slide.shape is \"release\", and terrain.type is not \"dem\"; a release lies on "
      "a DEM, or in it. Set terrain.type = \"dem\" and terrain.file, or use another shape.");
  EXPECT_EQ(error_on_dem({{"type = \"dem\"", "type = \"den\"\ncrs = \"EPSG:31287\""}}).substr(0, 65),
            "FOLDER/case.toml:11:8: terrain.type is \"den\"; did you mean 'dem'?")
      << "an unknown keyword has no effect";
}

TEST_F(Maps, AllowBodiesOfOtherShapesOnADem) {
  EXPECT_EQ(error_on_dem({{"shape = \"release\"\nrelease = \"release.geojson\"\nthickness = 10.0",
                           "shape = \"box\"\nmin = [0.0, 0.0, 5.0]\nmax = [10.0, 10.0, 20.0]"}}),
            "no error")
      << "the simulation knows the position of the ground";
}

TEST_F(Maps, AreSmoothedByANumberOrAsTheirNoiseNeeds) {
  const Case given = read({{"[terrain]", "[terrain]\nsmooth = 2.5"}});
  EXPECT_FALSE(given.terrain.smooth.is_auto);
  EXPECT_EQ(given.terrain.smooth.number, 2.5);
  EXPECT_EQ(read({{"[terrain]", "[terrain]\nsmooth = 0"}}).terrain.smooth.number, 0.0);
  EXPECT_TRUE(read({{"[terrain]", "[terrain]\nsmooth = \"auto\""}}).terrain.smooth.is_auto);
  EXPECT_TRUE(read({{"[terrain]", "[terrain]\nsmooth = 2.5"}}, {"terrain.smooth=\"auto\""}).terrain.smooth.is_auto);
  EXPECT_EQ(error_on_dem({{"[terrain]", "[terrain]\nsmooth = \"aut\""}}),
            "FOLDER/case.toml:11:10: terrain.smooth is the text \"aut\"; allowed: a number, >= 0 [m], or \"auto\". "
            "Correct it, or leave it out for the default \"auto\".");
  EXPECT_EQ(error_on_dem({{"[terrain]", "[terrain]\nsmooth = \"2.5\""}}),
            "FOLDER/case.toml:11:10: terrain.smooth is the text \"2.5\"; allowed: a number, >= 0 [m], or \"auto\"; "
            "remove the quotes. Correct it, or leave it out for the default \"auto\".");
  EXPECT_EQ(error_on_dem({{"[terrain]", "[terrain]\nsmooth = -1.0"}}),
            "FOLDER/case.toml:11:10: terrain.smooth is -1; allowed: >= 0 m (standard deviation of the Gaussian filter "
            "applied to the DEM; 0: no filter; auto: determined by noise and short bumps of the DEM, no filter on "
            "smooth terrain). Correct it, or leave it out for the default \"auto\".");
}

TEST_F(Maps, SaturationReplacesTheTemperature) {
  const Case found = case_from_text(with_body_lines("saturation = { depth = [0.0, 9.0], value = [0.3, 0.1] }"));
  EXPECT_TRUE(found.bodies.at("slide").saturation.is_given());
  EXPECT_EQ(found.bodies.at("slide").saturation.at(9.0, 0.0), 0.1);
  EXPECT_EQ(resolved_toml(found, "inputs").find("\ntemperature ="), std::string::npos) << "it follows";
  EXPECT_EQ(error_of_text(with_body_lines("saturation = 0.3\ntemperature = -2.0")),
            "FOLDER/case.toml:23:15: body.slide.temperature has a meaning only when saturation is not given. Remove "
            "it, or change body.slide.saturation.");
  EXPECT_EQ(error_of_text(with_body_lines("saturation = 1.1")),
            "FOLDER/case.toml:22:14: body.slide.saturation is 1.1; allowed: between 0 and 1, ends included (liquid "
            "saturation at t = 0, instead of temperature: fraction of the pores that is filled with water).");
  EXPECT_EQ(
      error_of_text(with_body_lines("saturation = 0.0")),
      "FOLDER/case.toml:22:14: body.slide.saturation is 0, and the freezing curve does not fall so low: at -273.15 C "
      "it is 6.46e-13. Give more water, or a temperature instead.");
  EXPECT_EQ(error_of_text(with_body_lines("saturation = 0.0"), {"freezing.curve=linear"}), "no error");
  EXPECT_EQ(error_of_text(with_body_lines("saturation = 1.0")), "no error");
}

TEST_F(Maps, IceContentReplacesThePorosity) {
  const Case found = case_from_text(with_body_lines("ice_content = 0.3"));
  EXPECT_EQ(found.bodies.at("slide").ice_content.at(0.0, 0.0), 0.3);
  EXPECT_EQ(resolved_toml(found, "inputs").find("\nporosity ="), std::string::npos) << "it follows";
  EXPECT_EQ(error_of_text(with_body_lines("ice_content = 0.3\nporosity = 0.3")),
            "FOLDER/case.toml:23:12: body.slide.porosity has a meaning only when ice_content is not given. Remove it, "
            "or change body.slide.ice_content.");
  EXPECT_EQ(
      error_of_text(with_body_lines("ice_content = 0.6\nsaturation = 0.5")),
      "FOLDER/case.toml:22:15: body.slide.ice_content is 0.6, and the saturation is 0.5; the porosity, ice_content / "
      "(1 - saturation), must not exceed 0.95. Allowed with it: at most 0.475. Give less ice, or less water.");
  EXPECT_EQ(error_of_text(with_body_lines("ice_content = 0.475\nsaturation = 0.5")), "no error");
  EXPECT_EQ(
      error_of_text(with_body_lines("ice_content = 0.1\ntemperature = 0.0")),
      "FOLDER/case.toml:22:15: body.slide.ice_content is 0.1, and the saturation is 1; the porosity, ice_content / "
      "(1 - saturation), must not exceed 0.95. Allowed with it: at most 0. Give less ice, or less water.");
}

TEST_F(Maps, ProbesAreAPointOrASection) {
  const auto with_probe = [](const std::string& lines) {
    return error_of_text(valid_case_on_dem + "[probe.gauge]\n" + lines);
  };
  EXPECT_EQ(with_probe("point = [1.0, 2.0]\n"), "no error");
  EXPECT_EQ(with_probe("line = \"line.geojson\"\n"), "no error");
  EXPECT_EQ(with_probe(""),
            "FOLDER/case.toml:24:1: key 'probe.gauge.point' is missing: it is needed when line is not given. Add "
            "'point = ...' to [probe.gauge]: horizontal coordinates of the probe, an array of 2 numbers, x and y [m].");
  EXPECT_EQ(with_probe("point = [1.0, 2.0, 3.0]\n"),
            "FOLDER/case.toml:25:9: probe.gauge.point is an array of 3 numbers; allowed: 2 numbers, x and y.");
  EXPECT_EQ(
      with_probe("point = [1.0, 2.0]\nline = \"line.geojson\"\n"),
      "FOLDER/case.toml:26:8: probe.gauge.point and probe.gauge.line are both given; allowed: one of them, since a "
      "probe is a place or a cross section. Remove one, or write two probes.");
}

TEST_F(Maps, FilesOfLinesNeedADem) {
  for (const std::string lines : {"[maps]\npath = \"line.geojson\"\n", "[probe.gauge]\nline = \"line.geojson\"\n"}) {
    std::string text = valid_case_on_dem + lines;
    const auto from = text.find("shape = \"release\""), to = text.find("\n[", from);
    text.replace(from, to - from, "shape = \"box\"\nmin = [0.0, 0.0, 5.0]\nmax = [10.0, 10.0, 20.0]");
    EXPECT_EQ(error_of_text(text), "no error");
    text.replace(text.find("\"dem\"\nfile = \"dem.tif\""), 22, "\"flat\"\nelevation = 0.0");
    const std::string key = lines.find("maps") == 1 ? "maps.path" : "probe.gauge.line";
    const std::string specified =
        key + " is given, and terrain.type is not \"dem\"; a file of a line needs the coordinate";
    EXPECT_NE(error_of_text(text).find(specified), std::string::npos) << error_of_text(text);
  }
}

// A run copies the files listed by input_files, and its case.toml names the copies.
TEST_F(Maps, AreCopiedWithTheRun) {
  for (const char* name : {"dem.tif.aux.xml", "dem.tfw", "release.shp", "release.shx", "release.dbf", "release.prj",
                           "release.CPG", "release.sbn", "before.asc", "before.prj", "water.tif", "section.geojson"}) {
    write_next_to_the_case(name, "");
  }
  const Case found =
      read({{"release.geojson", "release.shp"},
            {"thickness = 10.0", "thickness = { surface = \"before.asc\" }\nsaturation = { raster = \"water.tif\" }"},
            {"[basal]",
             "[body.other]\nmaterial = \"rock\"\nshape = \"release\"\nrelease = \"release.shp\"\n"
             "thickness = { attribute = \"map.tif\" }\ntemperature = { raster = \"map.tif\" }\n"
             "[maps]\npath = \"line.geojson\"\n[probe.section]\nline = \"section.geojson\"\n[basal]"}});
  std::set<std::string> names;
  for (const fs::path& file : input_files(found)) {
    EXPECT_EQ(file.parent_path(), folder_of_this_test());
    EXPECT_TRUE(names.insert(file.filename().string()).second) << file << " is listed once";
  }
  EXPECT_EQ(names, (std::set<std::string>{"case.toml", "dem.tif", "dem.tif.aux.xml", "dem.tfw", "release.shp",
                                          "release.shx", "release.dbf", "release.prj", "release.CPG", "before.asc",
                                          "before.prj", "water.tif", "map.tif", "line.geojson", "section.geojson"}));
  const fs::path run = folder_of_this_test() / "run";
  for (const std::string& name : names) {
    write_next_to_the_case("run/inputs/" + name, "");
  }
  const std::string resolved = resolved_toml(found, "inputs");
  write_next_to_the_case("run/case.toml", resolved);
  const Case again = read_case(run);
  EXPECT_EQ(resolved_toml(again, "inputs"), resolved);
  EXPECT_EQ(again.bodies.at("slide").release, (run / "inputs" / "release.shp").string());
  EXPECT_EQ(again.bodies.at("other").thickness.source, "map.tif") << "an attribute is not a file";
  for (const fs::path& file : input_files(again)) {
    EXPECT_TRUE(file == run / "case.toml" || file.parent_path() == run / "inputs") << file;
  }
}

TEST_F(Maps, AndProbesNeedThreeDimensions) {
  EXPECT_EQ(
      error_of_text(valid_case + "[probe.gauge]\n[probe.other]\npoint = [1.0, 2.0]\n"),
      "FOLDER/case.toml:22:1: [probe.gauge] has a meaning only in three dimensions, and case.dimension is 2. Remove "
      "it.\n"
      "FOLDER/case.toml:23:1: [probe.other] has a meaning only in three dimensions, and case.dimension is 2. Remove "
      "it.");
  EXPECT_EQ(
      error_of_text(valid_case + "[maps]\ncell = 5.0\n"),
      "FOLDER/case.toml:23:8: maps.cell has a meaning only in three dimensions, and case.dimension is 2. Remove it.");
  EXPECT_EQ(resolved_toml(case_from_text(valid_case), "inputs").find("[maps]"), std::string::npos);
  EXPECT_EQ(error_of_text(valid_case, {"grid.leaving=remove"}), "no error");
}

}  // namespace
}  // namespace thawslide::config
