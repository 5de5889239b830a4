// DEMs of real mountains, read from a shared folder if it exists.
#include "gis/polygons.hpp"
#include "gis/site.hpp"
#include "gis/vector_file.hpp"
#include "map_files.hpp"

namespace thawslide::gis {
namespace {

using namespace map_files;

class SharedDataTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(shared_data() / "alr")) {
      GTEST_SKIP() << "the shared data are absent";
    }
  }

  static config::Case case_on(const std::string& dem, std::array<double, 4> domain) {
    config::Case made;
    made.file = "case.toml";
    made.terrain.kind = config::TerrainKind::dem;
    made.terrain.file = (shared_data() / dem).string();
    made.grid.cell = 10.0;
    made.grid.min = {domain[0], domain[1], 0.0};
    made.grid.max = {domain[2], domain[3], 4000.0};
    return made;
  }
};

TEST_F(SharedDataTest, TagOfFluchthornIsNamed) {
  const RasterFile file((shared_data() / "fluchthorn" / "fluchthorn.tif").string(), Quantity::length);
  EXPECT_EQ(file.layout().columns, 300);
  EXPECT_EQ(file.layout().rows, 220);
  EXPECT_EQ(file.layout().cell_x, 10.0);
  const Rectangle span = span_of_points(file.layout());
  config::Case parameters = case_on("fluchthorn/fluchthorn.tif",
                                    {span.min_x + 50.0, span.min_y + 50.0, span.max_x - 50.0, span.max_y - 50.0});
  const std::string message = error_of([&] { static_cast<void>(load_site(parameters)); });
  expect_message(message);
  expect_message(message);
  parameters.terrain.crs = "EPSG:31254";
  parameters.bodies["summit"].shape = config::BodyShape::release;
  parameters.bodies["summit"].release =
      (shared_data() / "fluchthorn" / "POLYGONS" / "scarpFluchthorn_perimeter.shp").string();
  parameters.bodies["summit"].thickness.number = 10.0;
  const SiteAndWarnings loaded = load_site(parameters);
  EXPECT_EQ(loaded.site.crs_name, "EPSG:31254");
  ASSERT_EQ(loaded.warnings.size(), 3U);
  EXPECT_EQ(loaded.warnings[1].rfind("note: fluchthorn.tif was smoothed with a standard deviation of ", 0), 0U);
  EXPECT_EQ(loaded.warnings[2],
            "scarpFluchthorn_perimeter.shp specifies no coordinate reference system: that of the DEM, EPSG:31254, is "
            "assumed");
  const config::Release& release = loaded.site.releases.at("summit");
  double volume = 0.0, sum = 0.0;
  for (const double thickness : release.thickness.values) {
    volume += thickness * 100.0;
  }
  EXPECT_NEAR(volume, 10.0 * release.area, 1e-9 * volume);
  const VectorLayer layer = read_polygons(parameters.bodies["summit"].release, loaded.site.crs);
  EXPECT_EQ(layer.features.size(), 2U);
  for (const Feature& feature : layer.features) {
    sum += area_of(feature.polygons);
  }
  EXPECT_LT(release.area, 0.999 * sum) << "the two perimeters overlap";
}

TEST_F(SharedDataTest, ReleaseOfAlrIsComputed) {
  const RasterFile file((shared_data() / "alr" / "alr.tif").string(), Quantity::length);
  const VectorLayer layer = read_polygons((shared_data() / "alr" / "release.shp").string(), file.layout().crs);
  ASSERT_EQ(layer.features.size(), 1U);
  const Rectangle about = extent_of(layer.features[0].polygons).widened(60.0, 60.0);
  config::Case parameters = case_on("alr/alr.tif", {about.min_x, about.min_y, about.max_x, about.max_y});
  config::Body& body = parameters.bodies["snow"];
  body.shape = config::BodyShape::release;
  body.release = layer.file;
  body.thickness = {config::MapValue::From::attribute, 0.0, "thickness"};
  const SiteAndWarnings loaded = load_site(parameters);
  const config::Release& release = loaded.site.releases.at("snow");
  double volume = 0.0;
  for (const double thickness : release.thickness.values) {
    volume += thickness * 25.0;
  }
  EXPECT_NEAR(release.area, area_of(layer.features[0].polygons), 1e-6);
  EXPECT_NEAR(volume, release.area, 1e-9 * volume);
  EXPECT_GT(release.area, 1e3);
  RecordProperty("area_m2", static_cast<int>(release.area));
  RecordProperty("crs", loaded.site.crs_name);
}

}  // namespace
}  // namespace thawslide::gis
