// Map files in GDAL's own memory, generated from a target's input.
#pragma once

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "target.hpp"

namespace thawslide::fuzz {

inline const std::string memory = "/vsimem/";

// Formats that read from a network or from other programs are excluded: they do not depend on a file's bytes.
inline void prepare_gdal() {
  static const bool done = [] {
    CPLSetConfigOption("GDAL_SKIP", "HTTP WMS WCS WMTS DAAS EEDA EEDAI PLMosaic NGW STACIT STACTA ESRIC OGCAPI");
    CPLSetConfigOption("OGR_SKIP", "WFS,CSW,Elastic,AmigoCloud,CARTO,PLScenes,PostgreSQL,MySQL,ODBC,PGeo,OAPIF");
    GDALAllRegister();
    return true;
  }();
  static_cast<void>(done);
}

inline std::string in_memory(const std::string& name, const std::string& bytes) {
  const std::string file = memory + name;
  auto* copy = static_cast<GByte*>(CPLMalloc(bytes.size() + 1));
  bytes.copy(reinterpret_cast<char*>(copy), bytes.size());
  VSIFCloseL(VSIFileFromMemBuffer(file.c_str(), copy, bytes.size(), TRUE));
  return file;
}

// A number as in files: mostly a few eighths, sometimes one that makes sums overflow.
inline double number_from(Provider& bytes, double low, double high) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const std::array<double, 10> odd{0.0,    -0.0,   -9999.0, std::numeric_limits<double>::quiet_NaN(), inf, -inf, 1e300,
                                   -1e300, 1e-300, 1e9};
  const auto kind = bytes.ConsumeIntegral<std::uint8_t>();
  if (kind < 16) {
    return odd[kind % odd.size()];
  }
  if (kind < 24) {
    return bytes.ConsumeFloatingPoint<double>();
  }
  constexpr int steps = 64;
  return low + (high - low) * bytes.ConsumeIntegralInRange(0, steps) / steps;
}

// Reference systems of a file: that of the terrain, another one, in feet, in degrees, invalid, none.
inline OGRSpatialReference* system_from(Provider& bytes) {
  static std::vector<OGRSpatialReference> systems = [] {
    std::vector<OGRSpatialReference> made(5);
    made[0].importFromEPSG(31287);
    made[1].importFromEPSG(32632);
    made[2].importFromEPSG(2263);
    made[3].importFromEPSG(4326);
    made[4].SetLocalCS("of no place");
    return made;
  }();
  const auto kind = bytes.ConsumeIntegralInRange<std::size_t>(0, 23);
  return kind < systems.size() ? &systems[kind] : kind < 20 ? systems.data() : nullptr;
}

inline constexpr double west = 400000.0, south = 300000.0, wide = 160.0;  // [m], approximate extent of all files

// A GeoTIFF of up to 20 x 20 points.
inline std::string raster_from(Provider& bytes, const std::string& name, double low, double high) {
  const std::string file = memory + name;
  const int columns = chance(bytes, 8) ? bytes.ConsumeIntegralInRange(1, 20) : 17;
  const int rows = chance(bytes, 8) ? bytes.ConsumeIntegralInRange(1, 20) : 17;
  const auto type = chance(bytes, 4) ? static_cast<GDALDataType>(bytes.ConsumeIntegralInRange(1, 11)) : GDT_Float64;
  const GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), columns, rows, chance(bytes, 64) ? 2 : 1, type, nullptr));
  if (dataset == nullptr) {
    return file;
  }
  std::array<double, 6> transform{west, wide / 16.0, 0.0, south + wide, 0.0, -wide / 16.0};
  if (chance(bytes, 8)) {
    for (double& number : transform) {
      number = chance(bytes, 4) ? number_from(bytes, -2.0 * number, 2.0 * number) : number;
    }
  }
  dataset->SetGeoTransform(transform.data());
  dataset->SetSpatialRef(system_from(bytes));
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  if (chance(bytes, 2)) {
    band.SetNoDataValue(number_from(bytes, low, high));
  }
  if (chance(bytes, 16)) {
    band.SetScale(number_from(bytes, -2.0, 2.0));
    band.SetOffset(number_from(bytes, low, high));
  }
  if (chance(bytes, 16)) {
    band.SetUnitType(bytes.PickValueInArray({"m", "metre", "feet", "US survey foot", "?"}));
  }
  std::vector<double> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const double fall = number_from(bytes, low, high);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = low + fall * static_cast<double>(k % static_cast<std::size_t>(columns)) / columns;
  }
  for (int change = bytes.ConsumeIntegralInRange(0, 12); change > 0; --change) {
    const auto first = bytes.ConsumeIntegralInRange<std::size_t>(0, values.size() - 1);
    const auto last = std::min(values.size(), first + bytes.ConsumeIntegralInRange<std::size_t>(1, 40));
    std::fill(values.begin() + static_cast<std::ptrdiff_t>(first), values.begin() + static_cast<std::ptrdiff_t>(last),
              number_from(bytes, low, high));
  }
  static_cast<void>(
      band.RasterIO(GF_Write, 0, 0, columns, rows, values.data(), columns, rows, GDT_Float64, 0, 0, nullptr));
  return file;
}

// Corners on a coarse lattice, so that lines often touch, cross and coincide; `closed` repeats the first.
inline std::string corners_from(Provider& bytes, bool closed, const char* between) {
  std::vector<std::array<double, 2>> corners;
  for (int left = bytes.ConsumeIntegralInRange(closed ? 3 : 1, 8); left > 0; --left) {
    const bool odd = chance(bytes, 32);
    const auto place = [&] {
      return odd ? number_from(bytes, -wide, wide) : bytes.ConsumeIntegralInRange(0, 16) * wide / 16.0;
    };
    const double x = place(), y = place();
    corners.push_back({west + x, south + y});
  }
  if (closed && !chance(bytes, 16)) {
    corners.push_back(corners.front());
  }
  std::string text;
  for (const auto& [x, y] : corners) {
    text += fmt::format("{}{}{}{}{}", text.empty() ? "" : ",", between[0] == ',' ? "[" : "", x, between, y);
    text += between[0] == ',' ? "]" : "";
  }
  return text;
}

// An outline, sometimes with a hole.
inline std::string rings_from(Provider& bytes, bool json) {
  const std::string open = json ? "[" : "(", close = json ? "]" : ")";
  std::string text;
  for (int left = chance(bytes, 3) ? 2 : 1; left > 0; --left) {
    text += (text.empty() ? "" : ",") + open + corners_from(bytes, true, json ? "," : " ") + close;
  }
  return open + text + close;
}

inline std::string geometry_json(Provider& bytes, bool lines) {
  const auto kind = bytes.ConsumeIntegralInRange(0, 15);
  const bool as_asked = kind > 2;
  if (kind == 0) {
    return "null";
  }
  if (kind == 1) {
    return fmt::format(R"({{"type":"MultiPolygon","coordinates":[{},{}]}})", rings_from(bytes, true),
                       rings_from(bytes, true));
  }
  return lines == as_asked
             ? fmt::format(R"({{"type":"LineString","coordinates":[{}]}})", corners_from(bytes, false, ","))
             : fmt::format(R"({{"type":"Polygon","coordinates":{}}})", rings_from(bytes, true));
}

// Features with a name, a thickness and a temperature each: GeoJSON, or WKT in a table, whose corners can be invalid
// numbers.
inline std::string features_from(Provider& bytes, const std::string& name, bool lines) {
  const bool json = !chance(bytes, 4);
  const std::array<const char*, 6> names{"a", "b", "", "A", "null", "1"};
  std::string text;
  for (int left = lines && !chance(bytes, 8) ? 1 : bytes.ConsumeIntegralInRange(0, 4); left > 0; --left) {
    const double thickness = number_from(bytes, 0.5, 20.0), temperature = number_from(bytes, -10.0, 0.0);
    const char* title = bytes.PickValueInArray(names);
    if (json) {
      const auto value = [](double number) { return std::isfinite(number) ? fmt::format("{}", number) : "null"; };
      text += (text.empty() ? "" : ",") +
              fmt::format(R"({{"type":"Feature","properties":{{"name":"{}","thickness":{},"warm":{}}},"geometry":{}}})",
                          title, value(thickness), value(temperature), geometry_json(bytes, lines));
    } else {
      text += fmt::format("\"{} {}\",{},{},{}\n", lines ? "LINESTRING" : "POLYGON",
                          lines ? "(" + corners_from(bytes, false, " ") + ")" : rings_from(bytes, false), title,
                          thickness, temperature);
    }
  }
  return json ? in_memory(name + ".geojson", R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":)"
                                             R"("urn:ogc:def:crs:EPSG::31287"}},"features":[)" +
                                                 text + "]}")
              : in_memory(name + ".csv", "WKT,name,thickness,warm\n" + text);
}

}  // namespace thawslide::fuzz
