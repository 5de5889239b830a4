// Rasters in files: values read equal those written, for every format, type and direction of rows; unusable files.
#include "gis/raster_file.hpp"

#include <ctime>
#include <numbers>

#include "map_files.hpp"

namespace thawslide::gis {
namespace {

using namespace map_files;

Raster read_raster(const std::string& file) { return RasterFile(file, Quantity::length).read(); }

TEST(RasterFileTest, GeotiffRoundTripKeepsEveryBit) {
  Raster raster =
      raster_of([](double x, double y) { return std::sin(x) + 1e-3 * y; }, 400005.25, 300001.5, 4.9977, 7, 5);
  raster.cell_y = 5.25;
  raster.values[raster.index(2, 1)] = missing;
  const std::string file = in_folder("map.tif");
  write_geotiff(file, raster, {"m", "largest thickness"});
  const RasterFile opened(file, Quantity::length);
  const Raster read = opened.read();
  EXPECT_EQ(read.columns, 7);
  EXPECT_EQ(read.rows, 5);
  EXPECT_NEAR(read.x, raster.x, 1e-9);
  EXPECT_NEAR(read.y, raster.y, 1e-9);
  EXPECT_EQ(read.cell_x, raster.cell_x);
  EXPECT_EQ(read.cell_y, raster.cell_y);
  EXPECT_EQ(name_of(read.crs), "EPSG:31287");
  EXPECT_EQ(opened.conversion().warning, "");
  for (std::size_t k = 0; k < raster.values.size(); ++k) {
    EXPECT_TRUE(k == raster.index(2, 1) ? std::isnan(read.values[k]) : read.values[k] == raster.values[k]) << k;
  }
}

TEST(RasterFileTest, GeotiffIsTiledAndCompressedWithADescribedBand) {
  const std::string file = in_folder("map.tif");
  write_geotiff(file, raster_of([](double, double) { return 0.5; }, 0.0, 0.0, 5.0, 300, 280), {"m/s", "largest speed"});
  const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  int columns = 0, rows = 0;
  band.GetBlockSize(&columns, &rows);
  EXPECT_EQ(columns, 256);
  EXPECT_EQ(rows, 256);
  EXPECT_EQ(band.GetRasterDataType(), GDT_Float64);
  EXPECT_EQ(band.GetNoDataValue(), -9999.0);
  EXPECT_STREQ(band.GetUnitType(), "m/s");
  EXPECT_STREQ(band.GetDescription(), "largest speed");
  EXPECT_STREQ(dataset->GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
  EXPECT_LT(std::filesystem::file_size(file), 300U * 280U);
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(file).parent_path())) {
    EXPECT_EQ(entry.path().filename(), "map.tif") << "temporary file";
  }
}

TEST(RasterFileTest, EveryTypeIsReadInBothDirectionsOfRows) {
  for (const GDALDataType type : {GDT_Byte, GDT_Int16, GDT_UInt16, GDT_Int32, GDT_Int64, GDT_Float32, GDT_Float64}) {
    for (const double direction : {-1.0, 1.0}) {
      ForeignRaster what;
      what.type = type;
      what.transform[3] = direction < 0.0 ? 300030.0 : 300000.0;
      what.transform[5] = direction * 10.0;
      what.nodata = 6.0;
      const Raster read = read_raster(foreign("dem.tif", what));
      SCOPED_TRACE(fmt::format("{} {}", GDALGetDataTypeName(type), direction));
      EXPECT_EQ(read.x, 400005.0);
      EXPECT_EQ(read.y, 300005.0);
      // The first line of the file is the northernmost one if the raster is north up.
      EXPECT_EQ(read.at(0, direction < 0.0 ? 2 : 0), 1.0);
      EXPECT_EQ(read.at(3, direction < 0.0 ? 0 : 2), 12.0);
      EXPECT_TRUE(std::isnan(read.at(1, 1)));
    }
  }
}

TEST(RasterFileTest, NodataOfFloatsAndNonFiniteValuesAreMissing) {
  constexpr double nodata = -9999.9;  // as a float, this is a different number
  const Raster read = read_raster(foreign(
      "dem.tif", {.nodata = nodata, .values = {nodata, missing, std::numeric_limits<double>::infinity(), 7.5}}));
  for (const int column : {0, 1, 2}) {
    EXPECT_TRUE(std::isnan(read.at(column, 2))) << column;
  }
  EXPECT_EQ(read.at(3, 2), 7.5);
}

TEST(RasterFileTest, StoredNumbersAreScaled) {
  const Raster read = read_raster(scaled(foreign("dem.tif", {.type = GDT_Int16, .nodata = 2.0}), 0.5, 1000.0));
  EXPECT_EQ(read.at(0, 2), 1000.5);
  EXPECT_TRUE(std::isnan(read.at(1, 2)));
  EXPECT_EQ(read.at(2, 2), 1001.5);
}

TEST(RasterFileTest, WindowIsPartOfTheWhole) {
  const Raster raster = raster_of([](double x, double y) { return x + 1000.0 * y; }, 10.0, 20.0, 5.0, 40, 30);
  const RasterFile file(geotiff("dem.tif", raster), Quantity::length);
  const Raster part = file.read(Rectangle{32.0, 41.0, 70.0, 55.0});
  EXPECT_EQ(part.x, 30.0);
  EXPECT_EQ(part.x_end(), 70.0);
  EXPECT_EQ(part.y, 40.0);
  EXPECT_EQ(part.y_end(), 55.0);
  for_points(
      part, [&](int column, int row) { EXPECT_EQ(part.at(column, row), part.x_of(column) + 1000.0 * part.y_of(row)); });
  const Raster corner = file.read(Rectangle{-100.0, -100.0, 12.0, 22.0});
  EXPECT_EQ(corner.columns, 2);
  EXPECT_EQ(corner.rows, 2);
}

TEST(RasterFileTest, AsciiGridKeepsItsDigitsAndCellSize) {
  // Integers first: a reader that infers the type from the beginning of the file would lose the fractions.
  std::string text = "ncols 3\nnrows 2\nxllcorner 400000.5\nyllcorner 300000.25\ncellsize 4.9977\nNODATA_value -9999\n";
  text += "1234 1235 -9999\n1300 2345.6789012 1302\n";
  const Raster read = read_raster(text_file("dem.asc", text));
  EXPECT_EQ(read.cell_x, 4.9977);
  EXPECT_EQ(read.cell_y, 4.9977);
  EXPECT_NEAR(read.x, 400000.5 + 0.5 * 4.9977, 1e-9);
  EXPECT_NEAR(read.y, 300000.25 + 0.5 * 4.9977, 1e-9);
  EXPECT_EQ(read.at(0, 1), 1234.0);
  EXPECT_EQ(read.at(1, 0), 2345.6789012);
  EXPECT_TRUE(std::isnan(read.at(2, 1)));
  EXPECT_EQ(read.crs, "");
}

TEST(RasterFileTest, AsciiGridByCentresWithItsPrj) {
  text_file("dem.prj", reference_system_named("EPSG:31254"));
  const std::string text = "ncols 2\nnrows 2\nxllcenter 10\nyllcenter 20\ncellsize 2.5\n1 2\n3 4\n";
  const Raster read = read_raster(text_file("dem.asc", text));
  EXPECT_EQ(read.x, 10.0);
  EXPECT_EQ(read.y, 20.0);
  EXPECT_EQ(read.at(0, 0), 3.0);
  EXPECT_EQ(name_of(read.crs), "EPSG:31254");
}

TEST(RasterFileTest, LargeModelIsReadInSeconds) {
  const int count = 3000;
  int k = 0;
  const Raster raster =
      raster_of([&](double, double) { return 2000.0 + 0.25 * (++k % 977); }, 0.0, 0.0, 10.0, count, count);
  const std::string file = geotiff("large.tif", raster);
  const auto start = std::clock();  // processor time: other processes do not delay it
  const Raster read = read_raster(file);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_EQ(read.values, raster.values);
  EXPECT_LT(seconds, 10.0);
  std::filesystem::remove(file);
}

std::string error_of_file(const std::string& file) {
  return error_of([&] { return read_raster(file); });
}

TEST(RasterFaultsTest, NoRaster) {
  EXPECT_EQ(error_of_file(in_folder("none.tif")), "FOLDER/none.tif: there is no such file. Correct the path.");
  const std::string message = error_of_file(text_file("dem.tif", "this is no raster"));
  EXPECT_EQ(message.substr(0, message.find(';')), "FOLDER/dem.tif: the raster cannot be opened");
  expect_message(message);
}

TEST(RasterFaultsTest, AsciiGridsThatGdalDoesNotOpen) {
  const std::string header = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -9999\n";
  EXPECT_EQ(
      error_of_file(text_file("mark.asc", "\xEF\xBB\xBF" + header + "1 2\n3 4\n")),
      "FOLDER/mark.asc: the file begins with a UTF-8 byte order mark, which an ASCII grid may not have. Remove it: "
      "sed -i '1s/^\\xEF\\xBB\\xBF//' FOLDER/mark.asc");
  for (const std::string first : {"nan", "NaN"}) {
    EXPECT_EQ(error_of_file(text_file("first.asc", header + first + " 2\n3 4\n")),
              "FOLDER/first.asc: the first value of the ASCII grid is nan, which GDAL does not read there. Write the "
              "number of NODATA_value in its place, for example -9999: sed -i 's/nan/-9999/gi' FOLDER/first.asc");
  }
}

TEST(RasterFaultsTest, UnusableRasters) {
  expect_message(error_of_file(foreign("rgb.tif", {.bands = 3})));
  const auto error_of_place = [](const char* name, const std::array<double, 6>& transform) {
    return error_of_file(foreign(name, {.transform = transform}));
  };
  expect_message(error_of_place("turned.tif", {400000.0, 8.0, 6.0, 300030.0, 6.0, -8.0}));
  expect_message(error_of_place("cells.tif", {400000.0, missing, 0.0, 300030.0, 0.0, -8.0}));
  expect_message(error_of_place("height.tif", {400000.0, 8.0, 0.0, 300030.0, 0.0, -1e308}));
  const std::string file = in_folder("picture.tif");  // without an origin
  GDALDatasetUniquePtr(
      GetGDALDriverManager()->GetDriverByName("GTiff")->Create(file.c_str(), 4, 3, 1, GDT_Float32, nullptr));
  expect_message(error_of_file(file));
  expect_message(error_of_file(foreign("radar.tif", {.type = GDT_CFloat32})));
  expect_message(error_of_file(foreign("holes.tif", {.nodata = -1.0, .values = std::vector(12, -1.0)})));
}

TEST(RasterFaultsTest, TruncatedFilesAreRefused) {
  const Raster raster = raster_of([](double x, double y) { return std::sin(x * y); }, 0.0, 0.0, 5.0, 200, 150);
  const std::string tiff = geotiff("cut.tif", raster);
  std::filesystem::resize_file(tiff, std::filesystem::file_size(tiff) / 2);
  const std::string of_tiff = error_of_file(tiff);
  EXPECT_EQ(of_tiff.substr(0, of_tiff.find(';')), "FOLDER/cut.tif: the values cannot be read") << of_tiff;
  EXPECT_EQ(of_tiff.substr(of_tiff.rfind(". The")), ". The file seems to be damaged or truncated: copy it again.");
  const std::string text = "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 5\n1 2 3\n4 5 6\n7";
  const std::string message = error_of_file(text_file("cut.asc", text));
  EXPECT_EQ(message.substr(0, message.find(';')), "FOLDER/cut.asc: the values cannot be read") << message;
  expect_message(message);
}

TEST(RasterFaultsTest, MapsThatCannotBeWrittenAreReported) {
  const Raster raster = raster_of([](double, double) { return 1.0; }, 0.0, 0.0, 5.0, 4, 4);
  const std::string message = error_of([&] {
    write_geotiff(in_folder("no/such/folder/map.tif"), raster, {"m", "thickness"});
  });
  EXPECT_EQ(message.substr(0, 45), "cannot write FOLDER/no/such/folder/map.tif: G") << message;
  expect_message(message);
}

}  // namespace
}  // namespace thawslide::gis
