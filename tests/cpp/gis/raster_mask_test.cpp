// Masks of rasters count as no data, in every form in which files store them.
#include "base/raster.hpp"
#include "site_case.hpp"

namespace thawslide::gis {
namespace {

using namespace site_case;

enum class MaskKind { internal, adjacent, alpha, real_alpha };

// A raster as in map_files.hpp, with points masked by `is_masked`.
std::string masked(const std::string& name, MaskKind kind, ForeignRaster what,
                   const std::function<bool(int, int)>& is_masked) {
  const bool has_alpha = kind == MaskKind::alpha || kind == MaskKind::real_alpha;
  what.bands = has_alpha ? 2 : 1;
  what.type = kind == MaskKind::alpha ? GDT_Byte : what.type;
  const std::string file = foreign(name, what);
  CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", kind == MaskKind::internal ? "YES" : "NO");
  const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
  EXPECT_EQ(has_alpha ? dataset->GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand)
                      : dataset->CreateMaskBand(GMF_PER_DATASET),
            CE_None);
  std::vector<double> opacity;
  for (int line = 0; line < what.rows; ++line) {
    for (int column = 0; column < what.columns; ++column) {
      opacity.push_back(is_masked(column, line) ? 0.0 : kind == MaskKind::real_alpha ? 0.4 : 255.0);
    }
  }
  GDALRasterBand& mask = has_alpha ? *dataset->GetRasterBand(2) : *dataset->GetRasterBand(1)->GetMaskBand();
  EXPECT_EQ(mask.RasterIO(GF_Write, 0, 0, what.columns, what.rows, opacity.data(), what.columns, what.rows, GDT_Float64,
                          0, 0, nullptr),
            CE_None);
  CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr);
  return file;
}

constexpr MaskKind kinds[] = {MaskKind::internal, MaskKind::adjacent, MaskKind::alpha, MaskKind::real_alpha};

TEST(RasterMaskTest, MaskedPointsHaveNoDataInBothDirectionsOfRowsAndInWindows) {
  const auto is_masked = [](int column, int line) { return (column + 2 * line) % 3 == 0; };
  for (const MaskKind kind : kinds) {
    for (const double direction : {-1.0, 1.0}) {
      ForeignRaster what;
      what.transform[3] = direction < 0.0 ? 300030.0 : 300000.0;
      what.transform[5] = direction * 10.0;
      SCOPED_TRACE(fmt::format("{} {}", static_cast<int>(kind), direction));
      const RasterFile file(masked("map.tif", kind, what, is_masked), Quantity::length);
      const Raster read = file.read();
      ASSERT_EQ(read.values.size(), 12U);
      for (int line = 0; line < 3; ++line) {
        for (int column = 0; column < 4; ++column) {
          const double value = read.at(column, direction < 0.0 ? 2 - line : line);
          EXPECT_EQ(std::isnan(value), is_masked(column, line)) << column << " " << line;
          EXPECT_TRUE(std::isnan(value) || value == 1.0 + column + 4.0 * line) << value;
        }
      }
      const Raster part = file.read(Rectangle{400015.0, 300005.0, 400015.0, 300005.0});
      EXPECT_EQ(part.columns, 1);
      EXPECT_EQ(part.rows, 1);
      EXPECT_EQ(std::isnan(part.at(0, 0)), is_masked(1, direction < 0.0 ? 2 : 0));
      std::filesystem::remove(in_folder("map.tif.msk"));
    }
  }
}

TEST(RasterMaskTest, NodataAndMaskBothCount) {
  for (const MaskKind kind : kinds) {
    SCOPED_TRACE(static_cast<int>(kind));
    const auto read_masked = [&](const ForeignRaster& what, const std::function<bool(int, int)>& is_masked) {
      return RasterFile(masked("map.tif", kind, what, is_masked), Quantity::length).read();
    };
    const Raster read = read_masked({.nodata = 2.0}, [](int column, int line) { return column == 3 && line == 0; });
    EXPECT_TRUE(std::isnan(read.at(1, 2)) && std::isnan(read.at(3, 2)));
    EXPECT_EQ(read.at(0, 2), 1.0);
    std::filesystem::remove(in_folder("map.tif.msk"));
    EXPECT_EQ(error_of([&] { return read_masked({}, [](int, int) { return true; }); }),
              "FOLDER/map.tif: no point holds a value, all are nodata. Check that it is the right file.");
    std::filesystem::remove(in_folder("map.tif.msk"));
  }
}

TEST(RasterMaskTest, MaskFileNextToARasterIsAGeotiff) {
  const std::string file = foreign("map.tif", {});
  text_file("map.tif.msk", "<VRTDataset rasterXSize=\"4\" rasterYSize=\"3\"></VRTDataset>");
  expect_message(error_of([&] { return RasterFile(file, Quantity::length).layout(); }));
}

// Points 10 m apart that cover the ground; residual values below the mask, which leaves columns and lines 30 to 49.
std::string leftovers(const char* name, MaskKind kind, double value) {
  const ForeignRaster what{.columns = 101,
                           .rows = 81,
                           .transform = {west - 5.0, 10.0, 0.0, south + 805.0, 0.0, -10.0},
                           .values = std::vector(101 * 81, value)};
  return masked(name, kind, what,
                [](int column, int line) { return column < 30 || column >= 50 || line < 30 || line >= 50; });
}

TEST(RasterMaskTest, ValuesBelowAMaskAreNotThickness) {
  for (const MaskKind kind : kinds) {
    config::Case parameters = plain_case(ground());
    parameters.bodies["rock"] = raster_body(leftovers("thickness.tif", kind, 10.0));
    EXPECT_NEAR(release_volume(parameters), 200.0 * 200.0 * 10.0, 1e-6);
    std::filesystem::remove(in_folder("thickness.tif.msk"));
  }
}

TEST(RasterMaskTest, MaskedTemperatureBedAndGroundAreMissing) {
  const config::Case release = case_with_release({{"", box_at(250, 250, 450, 450)}});
  config::Case parameters = release;
  parameters.bodies.at("rock").temperature = raster_field(leftovers("temperature.tif", MaskKind::internal, -5.0));
  expect_message(error_of_site(parameters));
  parameters = release;
  parameters.bed.law = config::BedLaw::strength;
  parameters.bed.depth = raster_field(leftovers("bed.tif", MaskKind::internal, 1.0));
  expect_message(error_of_site(parameters));
  parameters = release;
  const Raster heights = ground();
  ForeignRaster dem{.type = GDT_Float64,
                    .columns = heights.columns,
                    .rows = heights.rows,
                    .transform = {west - 2.5, 5.0, 0.0, south + 802.5, 0.0, -5.0}};
  for (int k = 0; k < dem.rows * dem.columns; ++k) {
    dem.values.push_back(heights.at(k % dem.columns, dem.rows - 1 - k / dem.columns));
  }
  parameters.terrain.file =
      masked("dem.tif", MaskKind::internal, dem, [](int column, int line) { return column == 60 && line == 100; });
  expect_message(error_of_site(parameters));
}

}  // namespace
}  // namespace thawslide::gis
