// Error messages for rasters that cannot be used.
#include "gis/raster_file.hpp"
#include "map_files.hpp"

namespace thawslide::gis {
namespace {

using namespace map_files;

std::string error_of_file(const std::string& file) {
  return error_of([&] { static_cast<void>(RasterFile(file, Quantity::length).read()); });
}

TEST(RasterFaultsTest, MissingFile) {
  EXPECT_EQ(error_of_file(in_folder("none.tif")), "FOLDER/none.tif: there is no such file. Correct the path.");
}

TEST(RasterFaultsTest, NoRaster) {
  const std::string message = error_of_file(text_file("dem.tif", "this is no raster"));
  EXPECT_EQ(message.substr(0, message.find(';')), "FOLDER/dem.tif: the raster cannot be opened");
  EXPECT_NE(message.find("Allowed: a GeoTIFF or an ESRI ASCII grid; check that the file is complete and readable."),
            std::string::npos)
      << message;
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

TEST(RasterFaultsTest, SeveralBands) {
  ForeignRaster what;
  what.bands = 3;
  EXPECT_EQ(error_of_file(foreign("rgb.tif", what)),
            "FOLDER/rgb.tif: the raster has 3 bands; allowed: one. Take one out: gdal_translate -b 1 FOLDER/rgb.tif "
            "one-band.tif");
}

TEST(RasterFaultsTest, Rotated) {
  ForeignRaster what;
  what.transform = {400000.0, 8.0, 6.0, 300030.0, 6.0, -8.0};
  EXPECT_EQ(error_of_file(foreign("turned.tif", what)),
            "FOLDER/turned.tif: the raster is rotated or mirrored (geotransform 400000, 8, 6, 300030, 6, -8); allowed: "
            "columns from west to east, rows from north to south or back. Straighten it: gdalwarp -r bilinear "
            "FOLDER/turned.tif straight.tif");
}

TEST(RasterFaultsTest, OriginThatIsNotANumber) {
  ForeignRaster what;
  what.transform = {400000.0, std::numeric_limits<double>::quiet_NaN(), 0.0, 300030.0, 0.0, -8.0};
  EXPECT_NE(
      error_of_file(foreign("cells.tif", what)).find("cells.tif: the raster has no valid position (geotransform "),
      std::string::npos);
  what.transform = {400000.0, 8.0, 0.0, 300030.0, 0.0, -1e308};
  EXPECT_EQ(error_of_file(foreign("height.tif", what)),
            "FOLDER/height.tif: the raster has no valid position (geotransform 400000, 8, 0, 300030, 0, -1e+308): "
            "corners and sizes of cells must be finite numbers. Export it again with georeferencing.");
}

TEST(RasterFaultsTest, WithoutAnOrigin) {
  GDALAllRegister();
  const std::string file = in_folder("picture.tif");
  GDALDatasetUniquePtr(
      GetGDALDriverManager()->GetDriverByName("GTiff")->Create(file.c_str(), 4, 3, 1, GDT_Float32, nullptr));
  EXPECT_EQ(error_of_file(file),
            "FOLDER/picture.tif: the raster is not georeferenced: its corner and the size of its cells are unknown. "
            "Export it again with georeferencing (GeoTIFF tags, or a world file next to it).");
}

TEST(RasterFaultsTest, ComplexNumbers) {
  ForeignRaster what;
  what.type = GDT_CFloat32;
  EXPECT_EQ(error_of_file(foreign("radar.tif", what)),
            "FOLDER/radar.tif: the values are of the type CFloat32; allowed: real numbers or integers.");
}

TEST(RasterFaultsTest, NodataOnly) {
  ForeignRaster what;
  what.nodata = -1.0;
  what.values.assign(12, -1.0);
  EXPECT_EQ(error_of_file(foreign("holes.tif", what)),
            "FOLDER/holes.tif: no point holds a value, all are nodata. Check that it is the right file.");
}

TEST(RasterFaultsTest, TruncatedFilesAreRefused) {
  const Raster raster = raster_of([](double x, double y) { return std::sin(x * y); }, 0.0, 0.0, 5.0, 200, 150);
  const std::string tiff = geotiff("cut.tif", raster);
  std::filesystem::resize_file(tiff, std::filesystem::file_size(tiff) / 2);
  const std::string of_tiff = error_of_file(tiff);
  EXPECT_EQ(of_tiff.substr(0, of_tiff.find(';')), "FOLDER/cut.tif: the values cannot be read") << of_tiff;
  EXPECT_EQ(of_tiff.substr(of_tiff.rfind(". The")), ". The file seems to be damaged or truncated: copy it again.");
  std::string text = "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 5\n1 2 3\n4 5 6\n7";
  const std::string message = error_of_file(text_file("cut.asc", text));
  EXPECT_EQ(message.substr(0, message.find(';')), "FOLDER/cut.asc: the values cannot be read") << message;
  EXPECT_NE(message.find("The file seems to be damaged or truncated: copy it again."), std::string::npos);
  text = "ncols 5\nnrows 2400000\nxllcorner 0\nyllcorner 0\ncellsize 5\n1 2 3\n";
  EXPECT_EQ(
      error_of_file(text_file("short.asc", text)),
      "FOLDER/short.asc: the file is too short for 5 x 2400000 values (found 63 bytes; needed 23999999 or more). The "
      "file seems to be damaged or truncated: copy it again.");
}

TEST(RasterFaultsTest, MapsThatCannotBeWrittenAreReported) {
  const Raster raster = raster_of([](double, double) { return 1.0; }, 0.0, 0.0, 5.0, 4, 4);
  const std::string message = error_of([&] {
    write_geotiff(in_folder("no/such/folder/map.tif"), raster, {"m", "thickness"});
  });
  EXPECT_EQ(message.substr(0, 45), "cannot write FOLDER/no/such/folder/map.tif: G") << message;
  EXPECT_NE(message.find("Check that the folder exists and is writable, and that the disk has free space."),
            std::string::npos);
}

}  // namespace
}  // namespace thawslide::gis
