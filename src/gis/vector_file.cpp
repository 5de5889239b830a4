#include "gis/vector_file.hpp"

#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "base/text.hpp"
#include "config/input_limits.hpp"
#include "config/problems.hpp"
#include "gis/data_set.hpp"
#include "gis/gdal_messages.hpp"
#include "gis/raster_file.hpp"
#include "gis/reference_system.hpp"

namespace thawslide::gis {

namespace {

enum class Kind { polygons, lines };

const char* name_of_kind(Kind kind) { return kind == Kind::polygons ? "polygons" : "lines"; }

bool is_of_kind(OGRwkbGeometryType type, Kind kind) {
  constexpr OGRwkbGeometryType one[] = {wkbCurvePolygon, wkbCurve};
  constexpr OGRwkbGeometryType several[] = {wkbMultiSurface, wkbMultiCurve};
  const auto k = static_cast<std::size_t>(kind);
  const OGRwkbGeometryType flat = wkbFlatten(type);
  return flat != wkbTriangle && flat != wkbCurve && flat != wkbSurface &&  // not read
         (OGR_GT_IsSubClassOf(flat, one[k]) != 0 || OGR_GT_IsSubClassOf(flat, several[k]) != 0);
}

// True for a Shapefile without a .cpg file whose .dbf file states the code page "ANSI", which means little, or none.
bool has_unknown_encoding(GDALDataset& dataset) {
  constexpr const char* domain = "SHAPEFILE";
  if (std::string(dataset.GetDriverName()) != "ESRI Shapefile" || dataset.GetLayerCount() != 1) {
    return false;
  }
  OGRLayer& layer = *dataset.GetLayer(0);
  const char* const page = layer.GetMetadataItem("LDID_VALUE", domain);
  constexpr int ansi = 0x57;
  const int number = page == nullptr ? 0 : std::atoi(page);
  return layer.GetMetadataItem("CPG_VALUE", domain) == nullptr && (number == 0 || number == ansi);
}

// A text that is not UTF-8 is read as Windows-1252, which includes the letters of Latin-1.
std::string as_utf8(const std::string& text) {
  return CPLIsUTF8(text.c_str(), -1) != 0 ? text : released(CPLRecode(text.c_str(), "CP1252", CPL_ENC_UTF8));
}

// Known cause for which GDAL cannot open a file, with its remedy; empty if there is none.
std::string cause_of_unreadable_vector(const std::string& file) {
  const std::filesystem::path path(file);
  if (lower_case(path.extension().string()) != ".shp") {
    return "";
  }
  std::error_code ignored;
  for (const char* ending : {".shx", ".SHX"}) {
    if (std::filesystem::exists(std::filesystem::path(path).replace_extension(ending), ignored)) {
      return "";
    }
  }
  return fmt::format(
      "the index of the Shapefile, {}, is missing. Copy the .shx, .dbf and .prj file next to it, or restore the index: "
      "ogrinfo --config SHAPE_RESTORE_SHX YES {}",
      std::filesystem::path(path).replace_extension(".shx").filename().string(), shell_quote(file));
}

// A ring needs three corners that are not collinear.
bool has_area(const OGRPolygon& polygon) {
  if (polygon.getExteriorRing()->getNumPoints() < 4) {
    return false;
  }
  const std::unique_ptr<OGRGeometry> hull(polygon.ConvexHull());
  return hull != nullptr && wkbFlatten(hull->getGeometryType()) == wkbPolygon && hull->toPolygon()->get_Area() > 0.0;
}

// Throws UserError for a polygon without an area, and for one that intersects itself, with the location.
void check_polygons(const VectorLayer& layer) {
  for (const Feature& feature : layer.features) {
    for (const Polygon& polygon : feature.polygons) {
      const GdalMessages messages;
      const OGRPolygon geometry = to_geometry(polygon);
      if (!has_area(geometry)) {
        throw UserError("{}: {} has no area. Delete it, or draw its outline.", layer.file, feature.title);
      }
      if (geometry.IsValid()) {
        continue;
      }
      const std::string crossing = messages.after("Self-intersection at or near point ");
      if (!crossing.empty()) {
        throw UserError(
            "{}: {} crosses itself at or near {}. Correct its outline there (QGIS: Vector > Geometry Tools > Check "
            "Validity).",
            layer.file, feature.title, crossing);
      }
      throw UserError(
          "{}: {} is not a valid polygon{}. Correct its outline (QGIS: Vector > Geometry Tools > Check Validity).",
          layer.file, feature.title, messages.remark());
    }
  }
}

GDALDatasetUniquePtr open_vector(const std::string& file, const std::string& readable, Kind kind) {
  const GdalMessages messages;
  GDALDatasetUniquePtr dataset(
      GDALDataset::Open(readable.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, vector_formats()));
  if (dataset != nullptr && has_unknown_encoding(*dataset)) {
    const char* const as_stored[] = {"ENCODING=", nullptr};
    dataset.reset(GDALDataset::Open(readable.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, vector_formats(), as_stored));
  }
  if (dataset == nullptr) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
      throw UserError("{}: there is no such file. Correct the path.", file);
    }
    if (is_raster_file(file)) {
      throw UserError(
          "{}: the file is a raster; needed: {}, in a Shapefile, GeoPackage, GeoJSON or KML. Is it swapped with "
          "another file? Correct the path.{}",
          file, name_of_kind(kind),
          kind == Kind::polygons
              ? " A raster of a body's thickness goes to thickness = { raster = \"FILE\" }, which needs no polygons."
              : "");
    }
    if (const std::string cause = cause_of_unreadable_vector(file); !cause.empty()) {
      throw UserError("{}: {}", file, cause);
    }
    throw UserError(
        "{}: the file cannot be opened{}. Allowed: Shapefile (with its .shx and .dbf), GeoPackage, GeoJSON or KML; "
        "check that the file is complete and readable.",
        file, messages.remark());
  }
  return dataset;
}

bool layer_has_kind(OGRLayer& layer, Kind kind) {
  if (wkbFlatten(layer.GetGeomType()) != wkbUnknown) {
    return is_of_kind(layer.GetGeomType(), kind);
  }
  // Decides by the first feature with a geometry; if none has one, the first feature is reported.
  layer.ResetReading();
  bool any = false;
  for (const auto& feature : layer) {
    any = true;
    if (feature->GetGeometryRef() != nullptr) {
      const bool fits = is_of_kind(feature->GetGeometryRef()->getGeometryType(), kind);
      layer.ResetReading();
      return fits;
    }
  }
  layer.ResetReading();
  return any;
}

OGRLayer& layer_with(const std::string& file, GDALDataset& dataset, Kind kind) {
  std::vector<std::string> all, fitting;
  OGRLayer* chosen = nullptr;
  GIntBig features = 0;
  for (OGRLayer* layer : dataset.GetLayers()) {
    all.push_back(fmt::format("'{}' ({}, {} features)", config::shown(layer->GetName()),
                              OGRGeometryTypeToName(layer->GetGeomType()), layer->GetFeatureCount()));
    features += layer->GetFeatureCount();
    if (layer_has_kind(*layer, kind)) {
      fitting.push_back(config::shown(layer->GetName()));
      chosen = layer;
    }
  }
  if (fitting.size() == 1 && chosen->GetFeatureCount() > 0) {
    return *chosen;
  }
  if (fitting.size() > 1) {
    throw UserError("{}: the file has {} layers of {}: {}; allowed: one. Export the one meant to a file of its own.",
                    file, fitting.size(), name_of_kind(kind), config::comma_list(fitting));
  }
  if (features == 0 || chosen != nullptr) {
    throw UserError("{}: the layer is empty; needed: {}. Draw them, or name the file that has them.", file,
                    name_of_kind(kind));
  }
  throw UserError("{}: the file has no {}, but {}. Name the file that has them.", file, name_of_kind(kind),
                  config::comma_list(all));
}

class LayerReader {
 public:
  LayerReader(const std::string& file, const std::string& crs, Kind kind) : kind_(kind), readable_(file) {
    const GdalMessages messages;
    result_.file = file;
    dataset_ = open_vector(file, readable_.path().string(), kind);
    layer_ = &layer_with(file, *dataset_, kind);
    OGREnvelope envelope;
    const bool has_extent = layer_->GetExtent(&envelope) == OGRERR_NONE;
    const Rectangle extent =
        has_extent ? Rectangle{envelope.MinX, envelope.MinY, envelope.MaxX, envelope.MaxY} : Rectangle{};
    const LikelySystem system = likely_system(file, wkt_from_reference(layer_->GetSpatialRef()), extent, crs);
    add_warning(system.warning, result_.warnings);
    reprojection_ = Reprojection(system.wkt, crs);
  }

  VectorLayer read() {
    const GdalMessages messages;
    const OGRFeatureDefn& definition = *layer_->GetLayerDefn();
    for (int k = 0; k < definition.GetFieldCount(); ++k) {
      result_.attributes.push_back(as_utf8(definition.GetFieldDefn(k)->GetNameRef()));
    }
    const auto require_whole = [&] {
      if (messages.any_error()) {
        throw UserError("{}: the features cannot be read{}. The file seems to be damaged or truncated: copy it again.",
                        result_.file, messages.remark());
      }
    };
    for (const auto& feature : *layer_) {
      require_whole();
      require_few(result_.features.size() + 1, config::most_features, name_of_kind(kind_));
      add_feature(*feature);
    }
    require_whole();
    if (kind_ == Kind::polygons) {
      check_polygons(result_);
    }
    return std::move(result_);
  }

 private:
  void require_few(std::size_t found, std::size_t most, const char* what) const {
    if (found > most) {
      throw UserError(
          "{}: the file has more than {} {}; allowed: as many. Export those that are meant to a file of their own, or "
          "simplify them (ogr2ogr -simplify).",
          result_.file, most, what);
    }
  }

  void add_feature(const OGRFeature& source) {
    Feature feature;
    read_attributes(source, feature);
    const std::vector<std::string>& attributes = result_.attributes;
    auto named = std::ranges::find(attributes, "name");
    if (named == attributes.end()) {
      named = std::ranges::find_if(attributes, [](const std::string& each) { return lower_case(each) == "name"; });
    }
    if (named != attributes.end() && feature.texts.contains(*named)) {
      feature.name = feature.texts.at(*named);
    }
    feature.title = fmt::format("{} {}{}", kind_ == Kind::polygons ? "polygon" : "line", result_.features.size() + 1,
                                feature.name.empty() ? "" : " (" + config::shown(feature.name) + ")");
    if (source.GetGeometryRef() == nullptr || source.GetGeometryRef()->IsEmpty()) {
      throw UserError("{}: {} has no geometry; needed: {}. Delete it or draw it.", result_.file, feature.title,
                      name_of_kind(kind_));
    }
    const std::unique_ptr<OGRGeometry> geometry(source.GetGeometryRef()->getLinearGeometry());
    geometry->flattenTo2D();
    read_geometry(*geometry, feature);
    if (make_nested_rings_holes(feature.polygons)) {
      result_.warnings.push_back(fmt::format("note: {}: {} has rings within others, which are holes",
                                             name_of_file(result_.file), feature.title));
    }
    result_.features.push_back(std::move(feature));
  }

  void read_attributes(const OGRFeature& source, Feature& feature) const {
    for (int index = 0; index < source.GetFieldCount(); ++index) {
      if (!source.IsFieldSetAndNotNull(index)) {
        continue;
      }
      const std::string& name = result_.attributes[static_cast<std::size_t>(index)];
      const OGRFieldType type = source.GetFieldDefnRef(index)->GetType();
      const bool is_boolean = source.GetFieldDefnRef(index)->GetSubType() == OFSTBoolean;
      feature.texts[name] = !is_boolean                            ? as_utf8(source.GetFieldAsString(index))
                            : source.GetFieldAsInteger(index) == 0 ? "false"
                                                                   : "true";
      if (!is_boolean && (type == OFTReal || type == OFTInteger || type == OFTInteger64)) {
        feature.numbers[name] = source.GetFieldAsDouble(index);
      }
    }
  }

  void read_geometry(const OGRGeometry& geometry, Feature& feature) {
    if (geometry.IsEmpty()) {
      return;  // a part; a feature has others
    }
    const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
    if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection) != 0) {
      for (const OGRGeometry* part : *geometry.toGeometryCollection()) {
        read_geometry(*part, feature);
      }
    } else if (kind_ == Kind::polygons && type == wkbPolygon) {
      Polygon polygon = from_geometry(*geometry.toPolygon());
      reproject(polygon.outline, feature.title);
      for (Polyline2& hole : polygon.holes) {
        reproject(hole, feature.title);
      }
      feature.polygons.push_back(std::move(polygon));
    } else if (kind_ == Kind::lines && type == wkbLineString) {
      feature.lines.push_back(from_geometry(*geometry.toLineString()));
      reproject(feature.lines.back(), feature.title);
    } else {
      throw UserError("{}: {} is of the kind {}; allowed: {}.", result_.file, feature.title, geometry.getGeometryName(),
                      name_of_kind(kind_));
    }
  }

  void reproject(Polyline2& line, const std::string& title) {
    corners_ += line.size();
    require_few(corners_, config::most_corners, "corners");
    std::vector<double> x, y;
    for (const auto& corner : line) {
      x.push_back(corner[0]);
      y.push_back(corner[1]);
    }
    const bool known = reprojection_.apply(x, y);
    for (std::size_t k = 0; k < line.size(); ++k) {
      if (!known || !std::isfinite(x[k]) || !std::isfinite(y[k])) {
        throw UserError(
            "{}: {} has a corner that has no place in the ground's coordinate reference system, near {}, {}. Check the "
            "system of the file.",
            result_.file, title, coordinate_text(line[k][0]), coordinate_text(line[k][1]));
      }
      line[k] = {x[k], y[k]};
    }
  }

  Kind kind_;
  ReadableFile readable_;
  GDALDatasetUniquePtr dataset_;
  OGRLayer* layer_ = nullptr;
  Reprojection reprojection_{"", ""};
  std::size_t corners_ = 0;  // so far
  VectorLayer result_;
};

}  // namespace

const char* const* vector_formats() {
  static const char* const formats[] = {"ESRI Shapefile", "GPKG", "GeoJSON", "KML", nullptr};
  return formats;
}

VectorLayer read_polygons(const std::string& file, const std::string& crs) {
  return LayerReader(file, crs, Kind::polygons).read();
}

VectorLayer read_lines(const std::string& file, const std::string& crs) {
  return LayerReader(file, crs, Kind::lines).read();
}

}  // namespace thawslide::gis
