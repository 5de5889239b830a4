// Map files that the tests of the gis module write.
#pragma once

#include <cpl_conv.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "../config/case_messages.hpp"
#include "base/raster.hpp"
#include "config/case.hpp"
#include "gis/raster_file.hpp"
#include "gis/reference_system.hpp"

namespace thawslide::gis::map_files {

using config::case_messages::error_of;

// Compares a message with the next one of this test in messages.txt.
inline void expect_message(const std::string& found) {
  static std::string run_of_test;
  static std::ifstream lines;
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  const std::string name = fmt::format("{}.{}", test.test_suite_name(), test.name());
  if (const std::string run = fmt::format("{} {}", name, test.result()->start_timestamp()); run != run_of_test) {
    lines = std::ifstream(std::filesystem::path(THAWSLIDE_SOURCE_DIR) / "tests/cpp/gis/messages.txt");
    run_of_test = run;
  }
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind(name + ": ", 0) == 0) {
      EXPECT_EQ(found, line.substr(name.size() + 2));
      return;
    }
    if (line.rfind(name + "~ ", 0) == 0) {
      EXPECT_NE(found.find(line.substr(name.size() + 2)), std::string::npos) << found << " does not contain " << line;
      return;
    }
  }
  ADD_FAILURE() << "messages.txt has no more messages of " << name << "; found " << found;
}

inline constexpr double missing = std::numeric_limits<double>::quiet_NaN();

inline std::string in_folder(const std::string& name) {
  const std::filesystem::path folder = config::case_messages::folder_of_this_test();
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

inline std::string text_file(const std::string& name, const std::string& text) {
  std::ofstream(in_folder(name), std::ios::binary) << text;
  return in_folder(name);
}

// Calls `work` with the column and the row of each point.
template <class Work>
void for_points(const Raster& raster, const Work& work) {
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      work(column, row);
    }
  }
}

// Heights z(x, y) at points, the first of them at x, y.
inline Raster raster_of(const std::function<double(double, double)>& z, double x, double y, double cell, int columns,
                        int rows, const std::string& crs = "EPSG:31287") {
  Raster raster;
  raster.x = x;
  raster.y = y;
  raster.cell_x = raster.cell_y = cell;
  raster.columns = columns;
  raster.rows = rows;
  raster.crs = crs.empty() ? "" : reference_system_named(crs);
  for_points(raster, [&](int column, int row) { raster.values.push_back(z(raster.x_of(column), raster.y_of(row))); });
  return raster;
}

// Sets points of a rectangle: from a column and row on, and their numbers.
inline void set_points(Raster& raster, int column, int row, int columns, int rows, double value) {
  for (int k = 0; k < columns * rows; ++k) {
    raster.values[raster.index(column + k % columns, row + k / columns)] = value;
  }
}

// Adds white noise of an rms [m] to all points.
inline Raster with_noise(Raster raster, double rms, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, rms);
  for (double& value : raster.values) {
    value += normal(random);
  }
  return raster;
}

inline std::string geotiff(const std::string& name, const Raster& raster) {
  write_geotiff(in_folder(name), raster, {"", "test"});
  return in_folder(name);
}

// A GeoTIFF as written by other programs: any type, bands, geotransform and tag; all values 1, 2, 3, ... row by row
// from the first line of the file.
struct ForeignRaster {
  GDALDataType type = GDT_Float32;
  int bands = 1, columns = 4, rows = 3;
  std::array<double, 6> transform{400000.0, 10.0, 0.0, 300030.0, 0.0, -10.0};
  std::string crs = "EPSG:31287";
  double nodata = missing;
  std::string unit = "";
  std::vector<double> values = {};
};

inline std::string foreign(const std::string& name, const ForeignRaster& what) {
  GDALAllRegister();
  const std::string file = in_folder(name);
  const GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), what.columns, what.rows, what.bands, what.type, nullptr));
  std::array<double, 6> transform = what.transform;
  dataset->SetGeoTransform(transform.data());
  if (!what.crs.empty()) {
    OGRSpatialReference reference;
    reference.SetFromUserInput(what.crs.c_str());
    dataset->SetSpatialRef(&reference);
  }
  std::vector<double> values = what.values;
  while (values.size() < static_cast<std::size_t>(what.columns) * static_cast<std::size_t>(what.rows)) {
    values.push_back(static_cast<double>(values.size() + 1));
  }
  for (int band = 1; band <= what.bands; ++band) {
    if (!std::isnan(what.nodata)) {
      dataset->GetRasterBand(band)->SetNoDataValue(what.nodata);
    }
    dataset->GetRasterBand(band)->SetUnitType(what.unit.c_str());
    EXPECT_EQ(dataset->GetRasterBand(band)->RasterIO(GF_Write, 0, 0, what.columns, what.rows, values.data(),
                                                     what.columns, what.rows, GDT_Float64, 0, 0, nullptr),
              CE_None);
  }
  return file;
}

// Gives the stored numbers a scale and an offset.
inline std::string scaled(const std::string& file, double scale, double offset) {
  const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
  dataset->GetRasterBand(1)->SetScale(scale);
  dataset->GetRasterBand(1)->SetOffset(offset);
  return file;
}

// Features of a GeoJSON file: properties and geometry as JSON.
struct JsonFeature {
  std::string properties, geometry;
};

inline std::string polygon_json(const std::vector<std::array<double, 2>>& corners) {
  std::string text = R"({"type":"Polygon","coordinates":[[)";
  for (std::size_t k = 0; k <= corners.size(); ++k) {
    const auto& corner = corners[k % corners.size()];
    text += fmt::format("{}[{},{}]", k == 0 ? "" : ",", corner[0], corner[1]);
  }
  return text + "]]}";
}

inline std::string box_json(double min_x, double min_y, double max_x, double max_y) {
  return polygon_json({{min_x, min_y}, {max_x, min_y}, {max_x, max_y}, {min_x, max_y}});
}

inline std::string line_json(const std::vector<std::array<double, 2>>& corners) {
  std::string text = R"({"type":"LineString","coordinates":[)";
  for (std::size_t k = 0; k < corners.size(); ++k) {
    text += fmt::format("{}[{},{}]", k == 0 ? "" : ",", corners[k][0], corners[k][1]);
  }
  return text + "]}";
}

inline std::string geojson(const std::string& name, const std::vector<JsonFeature>& features,
                           const std::string& epsg = "31287") {
  std::string text =
      R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::)" + epsg +
      R"("}},"features":[)";
  for (std::size_t k = 0; k < features.size(); ++k) {
    text += fmt::format(R"({}{{"type":"Feature","properties":{{{}}},"geometry":{}}})", k == 0 ? "" : ",",
                        features[k].properties, features[k].geometry);
  }
  return text_file(name, text + "]}");
}

}  // namespace thawslide::gis::map_files
