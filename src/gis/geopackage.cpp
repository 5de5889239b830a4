#include "gis/geopackage.hpp"

#include <cpl_conv.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "gis/gdal_messages.hpp"

namespace thawslide::gis {

namespace {

// GDAL reports failures of the functions below as errors, which the caller checks.

void set_attributes(OGRFeature& feature, const MapLayer& layer, std::size_t k) {
  for (const Attribute& attribute : layer.attributes) {
    if (const auto* numbers = std::get_if<std::vector<double>>(&attribute.values)) {
      if (std::isfinite(numbers->at(k))) {
        feature.SetField(attribute.name.c_str(), numbers->at(k));
      }
    } else if (const std::string& text = std::get<1>(attribute.values).at(k); !text.empty()) {
      feature.SetField(attribute.name.c_str(), text.c_str());
    }
  }
}

void write_layer(GDALDataset& dataset, const MapLayer& layer, OGRSpatialReference* reference) {
  constexpr OGRwkbGeometryType types[] = {wkbMultiPolygon, wkbLineString, wkbPoint};
  OGRLayer* const written = dataset.CreateLayer(layer.name.c_str(), reference, types[layer.features.index()], nullptr);
  if (written == nullptr) {
    return;
  }
  for (const Attribute& attribute : layer.attributes) {
    OGRFieldDefn field(attribute.name.c_str(), attribute.values.index() == 0 ? OFTReal : OFTString);
    written->CreateField(&field);
  }
  std::visit(
      [&](const auto& features) {
        for (std::size_t k = 0; k < features.size(); ++k) {
          OGRFeature feature(written->GetLayerDefn());
          const auto geometry = to_geometry(features[k]);
          feature.SetGeometry(&geometry);
          set_attributes(feature, layer, k);
          if (written->CreateFeature(&feature) != OGRERR_NONE) {
            return;  // the error is among the messages
          }
        }
      },
      layer.features);
}

// Writes the table in which QGIS stores the styles of a GeoPackage's layers; column names are those of QGIS.
void write_styles(GDALDataset& dataset, const std::vector<MapLayer>& layers) {
  const auto has_style = [](const MapLayer& layer) { return !layer.style.empty(); };
  OGRLayer* const table =
      std::ranges::any_of(layers, has_style) ? dataset.CreateLayer("layer_styles", nullptr, wkbNone, nullptr) : nullptr;
  if (table == nullptr) {
    return;
  }
  for (const char* name : {"f_table_catalog", "f_table_schema", "f_table_name", "f_geometry_column", "styleName",
                           "styleQML", "styleSLD", "description", "owner", "ui", "useAsDefault", "update_time"}) {
    const bool is_flag = std::string("useAsDefault") == name, is_time = std::string("update_time") == name;
    OGRFieldDefn field(name, is_flag ? OFTInteger : is_time ? OFTDateTime : OFTString);
    field.SetSubType(is_flag ? OFSTBoolean : OFSTNone);
    table->CreateField(&field);
  }
  for (const MapLayer& layer : layers) {
    if (!has_style(layer)) {
      continue;
    }
    OGRFeature row(table->GetLayerDefn());
    for (const char* name : {"f_table_catalog", "f_table_schema", "styleSLD", "description", "owner"}) {
      row.SetField(name, "");
    }
    row.SetField("f_table_name", layer.name.c_str());
    row.SetField("f_geometry_column", dataset.GetLayerByName(layer.name.c_str())->GetGeometryColumn());
    row.SetField("styleName", layer.name.c_str());
    row.SetField("styleQML", layer.style.c_str());
    row.SetField("useAsDefault", 1);
    if (table->CreateFeature(&row) != OGRERR_NONE) {
      return;
    }
  }
}

}  // namespace

void write_geopackage(const std::string& file, const std::vector<MapLayer>& layers, const std::string& crs) {
  // A constant date of the last change, which the format requires, keeps files of equal content identical.
  const CPLConfigOptionSetter no_date("OGR_CURRENT_DATE", "1970-01-01T00:00:00.000Z", false);
  AtomicFile whole(file);
  const GdalMessages messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  THAWSLIDE_ASSERT(driver != nullptr, "GDAL has no driver for GeoPackage");
  GDALDatasetUniquePtr dataset(driver->Create(whole.temporary().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  OGRSpatialReference reference = reference_from_wkt(crs);
  if (dataset != nullptr && dataset->StartTransaction() == OGRERR_NONE) {
    for (const MapLayer& layer : layers) {
      write_layer(*dataset, layer, crs.empty() ? nullptr : &reference);
    }
    if (!messages.any_error()) {
      write_styles(*dataset, layers);
    }
    dataset->CommitTransaction();
  }
  dataset.reset();
  if (messages.any_error()) {
    whole.fail(messages.reason());
  }
  whole.publish();
}

}  // namespace thawslide::gis
