// GeoTIFF output of rasters.
#include <gdal_priv.h>

#include <cmath>
#include <vector>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "gis/gdal_messages.hpp"
#include "gis/raster_file.hpp"

namespace thawslide::gis {

namespace {

constexpr double written_nodata = -9999.0;

// Writes rows from north to south, one row of tiles at a time, so that no second raster is in memory.
bool write_rows(GDALRasterBand& band, const Raster& raster) {
  constexpr int rows_at_a_time = 256;
  const auto columns = static_cast<std::size_t>(raster.columns);
  std::vector<double> lines;
  for (int line = 0; line < raster.rows; line += rows_at_a_time) {
    const int count = std::min(rows_at_a_time, raster.rows - line);
    lines.resize(columns * static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) {
      const double* const row = raster.values.data() + raster.index(0, raster.rows - 1 - line - k);
      double* const to = lines.data() + columns * static_cast<std::size_t>(k);
      std::transform(row, row + raster.columns, to, [](double v) { return std::isnan(v) ? written_nodata : v; });
    }
    if (band.RasterIO(GF_Write, 0, line, raster.columns, count, lines.data(), raster.columns, count, GDT_Float64, 0, 0,
                      nullptr) != CE_None) {
      return false;
    }
  }
  return true;
}

}  // namespace

void write_geotiff(const std::string& file, const Raster& raster, const BandText& text, Precision precision) {
  THAWSLIDE_ASSERT(raster.columns > 0 && raster.rows > 0 &&
                       raster.values.size() == raster.index(raster.columns - 1, raster.rows - 1) + 1,
                   "{} x {} points, {} values", raster.columns, raster.rows, raster.values.size());
  AtomicFile whole(file);
  const GdalMessages messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  THAWSLIDE_ASSERT(driver != nullptr, "GDAL has no driver for GeoTIFF");
  // Predictor 3 is TIFF's for floating-point values. Tiles without data are omitted, so size and time scale with the
  // slide.
  const char* const options[] = {"TILED=YES",        "COMPRESS=DEFLATE", "PREDICTOR=3",
                                 "BIGTIFF=IF_SAFER", "SPARSE_OK=TRUE",   nullptr};
  GDALDatasetUniquePtr dataset(driver->Create(whole.temporary().c_str(), raster.columns, raster.rows, 1,
                                              precision == Precision::float64 ? GDT_Float64 : GDT_Float32,
                                              const_cast<char**>(options)));
  if (dataset == nullptr) {
    whole.fail(messages.reason());
  }
  double transform[6] = {raster.x - 0.5 * raster.cell_x,       raster.cell_x, 0.0,
                         raster.y_end() + 0.5 * raster.cell_y, 0.0,           -raster.cell_y};
  dataset->SetGeoTransform(transform);
  if (!raster.crs.empty()) {
    OGRSpatialReference reference = reference_from_wkt(raster.crs);
    if (!text.heights.empty()) {
      const OGRSpatialReference horizontal = reference;
      OGRSpatialReference vertical;
      vertical.SetVertCS(text.heights.c_str(), text.heights.c_str());  // in metres
      const std::string name = fmt::format("{} + {}", horizontal.GetName(), text.heights);
      reference.SetCompoundCS(name.c_str(), &horizontal, &vertical);
    }
    dataset->SetSpatialRef(&reference);
  }
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  band.SetNoDataValue(written_nodata);
  band.SetUnitType(text.unit.c_str());
  band.SetDescription(text.description.c_str());
  const bool written = write_rows(band, raster);
  dataset.reset();
  if (!written || messages.any_error()) {
    whole.fail(messages.reason());
  }
  whole.publish();
}

}  // namespace thawslide::gis
