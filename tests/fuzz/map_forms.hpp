// Writers of valid files: the plain form and, with bytes, any other form of the same meaning.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "gis/raster_file.hpp"
#include "map_files.hpp"

namespace thawslide::fuzz {

inline constexpr int points = 17;
inline const std::string first_name =
    "S\xC3\xBC"
    "d \xE2\x80\xA2";  // letters of CP1252 too
inline const std::string second_name = "Nord";

// Values of the points of a square, from the south: low + step * k with k up to 200; NaN: no value.
struct Grid {
  double low, step;
  std::vector<double> values;
};

inline Grid grid_from(Provider& bytes, double low, double step) {
  Grid grid{low, step, {}};
  const int along_x = bytes.ConsumeIntegralInRange(-3, 3), along_y = bytes.ConsumeIntegralInRange(-3, 3);
  const int period = bytes.ConsumeIntegralInRange(1, 40);
  for (int k = 0; k < points * points; ++k) {
    grid.values.push_back(low + step * (100 + along_x * (k % points - 8) + along_y * (k / points - 8) + k % period));
  }
  if (bytes.ConsumeBool()) {
    grid.values[0] = std::numeric_limits<double>::quiet_NaN();  // outside the domain
  }
  return grid;
}

// A box with a hole, and an island in it; corners in quarters of 10 m, from the south-west.
struct Area {
  std::vector<std::array<int, 4>> boxes;
};

inline std::vector<Area> areas_from(Provider& bytes) {
  std::vector<Area> areas;
  for (const int left : {10, 34}) {
    const int low = bytes.ConsumeIntegralInRange(10, 20), high = bytes.ConsumeIntegralInRange(44, 54);
    Area area{{{left, low, left + 20, high}}};
    if (bytes.ConsumeBool()) {
      area.boxes.push_back({left + 4, low + 6, left + 16, high - 6});
      if (bytes.ConsumeBool()) {
        area.boxes.push_back({left + 8, low + 10, left + 12, high - 8});
      }
    }
    areas.push_back(area);
  }
  return areas;
}

inline bool turns(Provider* forms) { return forms != nullptr && forms->ConsumeBool(); }
inline int pick(Provider* forms, int count) {
  return forms == nullptr ? 0 : forms->ConsumeIntegralInRange(0, count - 1);
}

inline std::string ascii_grid(const Grid& grid, const std::string& name, Provider& forms) {
  const bool is_centre = forms.ConsumeBool(), is_windows = forms.ConsumeBool();
  const double cell = wide / 16.0, offset = is_centre ? 0.5 * cell : 0.0;
  const std::string of_corner = is_centre ? "center" : "corner", end = is_windows ? "\r\n" : "\n";
  std::string text =
      fmt::format("ncols {0}{1}nrows {0}{1}xll{2} {3}{1}YLL{2} {4}{1}cellsize {5}{1}nodata_value -9999{1}", points, end,
                  of_corner, west + offset, south + offset, cell);
  for (int row = points - 1; row >= 0; --row) {
    for (int column = 0; column < points; ++column) {
      const double value = grid.values[static_cast<std::size_t>(row * points + column)];
      text +=
          std::isnan(value) ? "-9999 " : fmt::format(fmt::runtime(forms.ConsumeBool() ? "{:.6e} " : "{:.4f} "), value);
    }
    text += end;
  }
  char* wkt = nullptr;
  OGRSpatialReference system;
  system.importFromEPSG(31287);
  system.exportToWkt(&wkt);
  in_memory(name + ".prj", wkt);
  CPLFree(wkt);
  return in_memory(name + ".asc", text);
}

// Unit of a file: a value in it is factor * value + offset.
struct FileUnit {
  const char* name;
  double factor, offset;
};

inline FileUnit unit_from(gis::Quantity quantity, Provider* forms) {
  static const std::array<FileUnit, 5> lengths{
      {{"", 1, 0}, {"metre", 1, 0}, {"cm", 100, 0}, {"ft", 1 / 0.3048, 0}, {"US survey foot", 3937.0 / 1200, 0}}};
  static const std::array<FileUnit, 4> temperatures{{{"", 1, 0}, {"degC", 1, 0}, {"K", 1, 273.15}, {"F", 1.8, 32}}};
  return quantity == gis::Quantity::length        ? lengths[static_cast<std::size_t>(pick(forms, 5))]
         : quantity == gis::Quantity::temperature ? temperatures[static_cast<std::size_t>(pick(forms, 4))]
                                                  : FileUnit{"", 1, 0};
}

inline std::string write_grid(const Grid& grid, const std::string& name, gis::Quantity quantity, Provider* forms) {
  if (forms != nullptr && chance(*forms, 8)) {
    return ascii_grid(grid, name, *forms);
  }
  const FileUnit unit = unit_from(quantity, forms);
  static const GDALDataType types[] = {GDT_Float64, GDT_Byte,  GDT_UInt16, GDT_Int16,
                                       GDT_UInt32,  GDT_Int32, GDT_Int64,  GDT_UInt64};
  const GDALDataType type = types[pick(forms, 8)];
  const bool is_integer = type != GDT_Float64, is_packed = is_integer || turns(forms);
  const double scale = is_packed ? unit.factor * grid.step : 1.0;
  const double offset = is_packed ? unit.factor * grid.low + unit.offset : 0.0;
  const bool south_up = turns(forms), has_mask = turns(forms), has_alpha = !has_mask && turns(forms);
  CPLStringList options;
  const char* const compressions[] = {"NONE", "LZW", "DEFLATE", "PACKBITS", "ZSTD"};
  options.SetNameValue("COMPRESS", compressions[pick(forms, 5)]);
  options.SetNameValue("ENDIANNESS", turns(forms) ? "BIG" : "LITTLE");
  options.SetNameValue("BIGTIFF", turns(forms) ? "YES" : "NO");
  options.SetNameValue("INTERLEAVE", turns(forms) ? "BAND" : "PIXEL");
  if (turns(forms)) {
    options.SetNameValue("TILED", "YES");
    options.SetNameValue("BLOCKXSIZE", "16");
    options.SetNameValue("BLOCKYSIZE", "32");
  }
  if (turns(forms)) {
    options.SetNameValue("PREDICTOR", is_integer ? "2" : "3");
    if (!is_integer) {
      options.SetNameValue("ENDIANNESS", "LITTLE");  // GDAL 3.6 writes big-endian numbers with it in the wrong order
    }
  }
  CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", turns(forms) ? "YES" : "NO");
  const std::string file = memory + name + ".tif";
  const GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), points, points, has_alpha ? 2 : 1, type, options.List()));
  const double cell = wide / 16.0, north = south + points * cell;
  std::array<double, 6> transform{west, cell, 0.0, south_up ? south : north, 0.0, south_up ? cell : -cell};
  OGRSpatialReference system;
  system.importFromEPSG(31287);
  if (turns(forms)) {
    dataset->SetMetadataItem("AREA_OR_POINT", "Point");
  }
  dataset->SetGeoTransform(transform.data());
  dataset->SetSpatialRef(&system);
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  if (unit.name[0] != '\0') {
    band.SetUnitType(unit.name);
  }
  if (is_packed) {
    band.SetScale(scale);
    band.SetOffset(offset);
  }
  const double missing = is_integer ? 250.0 : turns(forms) ? std::numeric_limits<double>::quiet_NaN() : -32768.0;
  if (!has_mask && !has_alpha) {
    type == GDT_Int64    ? band.SetNoDataValueAsInt64(250)
    : type == GDT_UInt64 ? band.SetNoDataValueAsUInt64(250)
                         : band.SetNoDataValue(missing);
  }
  std::vector<double> stored, known;
  for (int line = 0; line < points; ++line) {
    const int row = south_up ? line : points - 1 - line;
    for (int column = 0; column < points; ++column) {
      const double value = grid.values[static_cast<std::size_t>(row * points + column)];
      const double packed = (unit.factor * value + unit.offset - offset) / scale;
      known.push_back(std::isnan(value) ? 0.0 : 255.0);
      stored.push_back(std::isnan(value) ? missing : is_integer ? std::round(packed) : packed);
    }
  }
  const auto put = [](GDALRasterBand& into, std::vector<double>& numbers) {
    static_cast<void>(
        into.RasterIO(GF_Write, 0, 0, points, points, numbers.data(), points, points, GDT_Float64, 0, 0, nullptr));
  };
  put(band, stored);
  if (has_mask) {
    dataset->CreateMaskBand(GMF_PER_DATASET);
    put(*band.GetMaskBand(), known);
  }
  if (has_alpha) {
    dataset->GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand);
    put(*dataset->GetRasterBand(2), known);
  }
  return file;
}

// Closed ring of a box: direction, first corner and corners within its sides vary.
inline std::unique_ptr<OGRLinearRing> ring_of(const std::array<int, 4>& box, Provider* forms) {
  std::vector<std::array<double, 2>> corners;
  const int first = pick(forms, 4);
  const bool is_reversed = turns(forms), has_more = turns(forms);
  for (int k = 0; k < 4; ++k) {
    const int at = (first + (is_reversed ? 4 - k : k)) % 4, next = (at + (is_reversed ? 3 : 1)) % 4;
    const auto corner = [&](int number) -> std::array<double, 2> {
      const int x = box[number == 1 || number == 2 ? 2 : 0], y = box[number >= 2 ? 3 : 1];
      return {west + 2.5 * x, south + 2.5 * y};
    };
    corners.push_back(corner(at));
    if (has_more) {
      corners.push_back({0.5 * (corner(at)[0] + corner(next)[0]), 0.5 * (corner(at)[1] + corner(next)[1])});
    }
  }
  corners.push_back(corners.front());
  auto ring = std::make_unique<OGRLinearRing>();
  for (const auto& [x, y] : corners) {
    ring->addPoint(x, y);
  }
  ring->flattenTo2D();
  return ring;
}

// Multipolygon of an area. In other forms, holes can be parts.
inline std::unique_ptr<OGRMultiPolygon> geometry_of(const Area& area, Provider* forms) {
  auto parts = std::make_unique<OGRMultiPolygon>();
  const bool holes_are_parts = turns(forms);
  OGRPolygon* last = nullptr;
  for (std::size_t k = 0; k < area.boxes.size(); ++k) {
    if (k % 2 == 0 || holes_are_parts) {
      last = new OGRPolygon;  // owned by `parts`
      parts->addGeometryDirectly(last);
    }
    last->addRingDirectly(ring_of(area.boxes[k], forms).release());
  }
  return parts;
}

// Layer of a new file, in the system of the terrain or in degrees.
struct NewLayer {
  std::string file;
  GDALDatasetUniquePtr dataset;
  OGRLayer* layer = nullptr;
  std::unique_ptr<OGRCoordinateTransformation> to_degrees;

  // Adds a feature; its geometry gets elevations or measures at random.
  void add(std::unique_ptr<OGRGeometry> geometry, const std::string& name, double thickness, Provider* forms) {
    const std::unique_ptr<OGRFeature> feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
    feature->SetField("name", name.c_str());
    if (feature->GetFieldIndex("thickness") >= 0) {
      feature->SetField("thickness", thickness);
    }
    if (to_degrees != nullptr) {
      geometry->transform(to_degrees.get());
    }
    const int dimension = pick(forms, 3);
    geometry->set3D(dimension > 0 ? TRUE : FALSE);
    geometry->setMeasured(dimension > 1 ? TRUE : FALSE);
    feature->SetGeometryDirectly(geometry.release());
    static_cast<void>(layer->CreateFeature(feature.get()));
  }
};

// with_thickness: an attribute, which KML does not have.
inline NewLayer new_layer(const std::string& name, OGRwkbGeometryType type, bool with_thickness, Provider* forms) {
  static const char* const drivers[][2] = {
      {"GeoJSON", ".geojson"}, {"GPKG", ".gpkg"}, {"ESRI Shapefile", ".shp"}, {"KML", ".kml"}};
  const auto& driver = drivers[pick(forms, with_thickness ? 3 : 4)];
  const std::string kind = driver[0];
  NewLayer made;
  made.file = memory + name + driver[1];
  made.dataset.reset(
      GetGDALDriverManager()->GetDriverByName(driver[0])->Create(made.file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  OGRSpatialReference system, degrees;
  system.importFromEPSG(31287);
  degrees.importFromEPSG(4326);
  for (OGRSpatialReference* each : {&system, &degrees}) {
    each->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  }
  const bool is_in_degrees = kind == "KML" || turns(forms);
  if (is_in_degrees) {
    made.to_degrees.reset(OGRCreateCoordinateTransformation(&system, &degrees));
  }
  CPLStringList options;
  if (kind == "GeoJSON") {
    options.SetNameValue("COORDINATE_PRECISION", "15");
  }
  if (kind == "ESRI Shapefile") {
    const char* const encodings[] = {"UTF-8", "CP1252"};
    options.SetNameValue("ENCODING", encodings[pick(forms, 2)]);
  }
  made.layer = made.dataset->CreateLayer(name.c_str(), is_in_degrees ? &degrees : &system,
                                         kind == "ESRI Shapefile" ? type : wkbUnknown, options.List());
  OGRFieldDefn title("name", OFTString), more("remark", OFTInteger);
  OGRFieldDefn thickness(turns(forms) ? "Thickness" : "thickness", turns(forms) ? OFTInteger64 : OFTReal);
  if (turns(forms)) {
    made.layer->CreateField(&more);
  }
  made.layer->CreateField(&title);
  if (with_thickness) {
    made.layer->CreateField(&thickness);
  }
  return made;
}

// Two features, the second one 20 m thick.
inline std::string write_areas(const std::vector<Area>& areas, const std::string& name, bool with_thickness,
                               Provider* forms) {
  NewLayer layer = new_layer(name, wkbPolygon, with_thickness, forms);
  const std::size_t first = turns(forms) ? 1 : 0;
  for (const std::size_t k : {first, 1 - first}) {
    layer.add(geometry_of(areas[k], forms), k == 0 ? first_name : second_name, k == 0 ? 10.0 : 20.0, forms);
  }
  return layer.file;
}

inline std::string write_line(const std::vector<std::array<double, 2>>& corners, const std::string& name,
                              Provider* forms) {
  NewLayer layer = new_layer(name, wkbLineString, false, forms);
  auto line = std::make_unique<OGRLineString>();
  for (const auto& [x, y] : corners) {
    line->addPoint(x, y);
  }
  line->flattenTo2D();
  if (turns(forms)) {
    auto lines = std::make_unique<OGRMultiLineString>();
    lines->addGeometryDirectly(line.release());
    layer.add(std::move(lines), name, 0.0, forms);
  } else {
    layer.add(std::move(line), name, 0.0, forms);
  }
  return layer.file;
}

// Text of a profile with a surface.
inline std::string profile_text(const std::vector<std::array<double, 3>>& rows, Provider* forms) {
  const std::string end = turns(forms) ? "\r\n" : "\n";
  std::string text = turns(forms) ? "\xEF\xBB\xBF" : "";
  const auto space = [&] {
    const char* const spaces[] = {"", " ", "\t", "  "};
    return spaces[pick(forms, 4)];
  };
  const auto line_between = [&] {
    const char* const lines[] = {"", "# surveyed, 2016", "  ", ""};
    const int kind = pick(forms, 4);
    text += kind == 0 ? "" : lines[kind] + end;
  };
  line_between();
  text += fmt::format("{}distance_m{},terrain_elevation_m,{}surface_elevation_m{}", space(), space(), space(), end);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    line_between();
    for (std::size_t column = 0; column < 3; ++column) {
      const double number = rows[k][column];
      const char* const notations[] = {"{}", "{:+.3f}", "{:.12e}", "{:.9E}"};
      text += space() + fmt::format(fmt::runtime(notations[pick(forms, 4)]), number) + space();
      text += column < 2 ? "," : "";
    }
    text += k + 1 == rows.size() && turns(forms) ? "" : end;
  }
  return text;
}

}  // namespace thawslide::fuzz
