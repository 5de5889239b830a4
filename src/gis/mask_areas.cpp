// Conversion of a mask to polygons.
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <cstdint>

#include "base/error.hpp"
#include "gis/gdal_messages.hpp"
#include "gis/geometry.hpp"
#include "gis/geopackage.hpp"

namespace thawslide::gis {

namespace {

// In-memory data set over the mask's bytes, which remain owned by the caller.
GDALDatasetUniquePtr dataset_over(const Raster& mask, std::vector<std::uint8_t>& bytes) {
  GDALDatasetUniquePtr dataset(
      GetGDALDriverManager()->GetDriverByName("MEM")->Create("", mask.columns, mask.rows, 0, GDT_Byte, nullptr));
  char pointer[64] = {};
  const int length = CPLPrintPointer(pointer, bytes.data(), sizeof(pointer) - 1);
  const std::string option = "DATAPOINTER=" + std::string(pointer, static_cast<std::size_t>(length));
  const char* const options[] = {option.c_str(), nullptr};
  dataset->AddBand(GDT_Byte, const_cast<char**>(options));
  double transform[6] = {mask.x - 0.5 * mask.cell_x, mask.cell_x, 0.0, mask.y - 0.5 * mask.cell_y, 0.0, mask.cell_y};
  dataset->SetGeoTransform(transform);
  return dataset;
}

}  // namespace

Polygons areas_of_mask(const Raster& mask) {
  const GdalMessages messages;
  std::vector<std::uint8_t> bytes(mask.values.size());
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    bytes[k] = mask.values[k] != 0.0 && !std::isnan(mask.values[k]) ? 1 : 0;
  }
  const GDALDatasetUniquePtr dataset = dataset_over(mask, bytes);
  const GDALDatasetUniquePtr found(
      GetGDALDriverManager()->GetDriverByName("Memory")->Create("", 0, 0, 0, GDT_Unknown, nullptr));
  OGRLayer* const layer = found->CreateLayer("areas", nullptr, wkbPolygon, nullptr);
  GDALRasterBand* const band = dataset->GetRasterBand(1);
  // The mask serves as its own mask: no polygons where it is 0.
  const CPLErr result = GDALPolygonize(band, band, layer, -1, nullptr, nullptr, nullptr);
  THAWSLIDE_ASSERT(result == CE_None, "no areas of {} x {} points{}", mask.columns, mask.rows, messages.remark());
  Polygons areas;
  for (const auto& feature : *layer) {
    const Polygons more = areas_of(*feature->GetGeometryRef());
    areas.insert(areas.end(), more.begin(), more.end());
  }
  return areas;
}

}  // namespace thawslide::gis
