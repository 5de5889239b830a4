// Transformation of coordinates and rasters between reference systems.
#include <gdal_priv.h>
#include <gdal_utils.h>

#include <algorithm>
#include <limits>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "base/text.hpp"
#include "gis/gdal_messages.hpp"
#include "gis/reference_system.hpp"

namespace thawslide::gis {

Reprojection::Reprojection(const std::string& from_wkt, const std::string& to_wkt) {
  if (from_wkt.empty() || to_wkt.empty() || from_wkt == to_wkt) {
    return;
  }
  const GdalMessages messages;
  // Only horizontal coordinates are transformed; heights remain unchanged.
  OGRSpatialReference from = reference_from_wkt(from_wkt);
  OGRSpatialReference to = reference_from_wkt(to_wkt);
  for (OGRSpatialReference* system : {&from, &to}) {
    system->StripVertical();
    system->DemoteTo2D(nullptr);
  }
  const char* const options[] = {"CRITERION=EQUIVALENT", nullptr};
  if (from.IsSame(&to, options) != 0) {
    return;
  }
  transformation_.reset(OGRCreateCoordinateTransformation(&from, &to));
  if (transformation_ == nullptr) {
    require_projection_database();
    throw UserError(
        "no transformation is available from the coordinate reference system {} to {}{}. Reproject the file to the "
        "latter.",
        name_of(from_wkt), name_of(to_wkt), messages.remark());
  }
}

bool Reprojection::apply(std::vector<double>& x, std::vector<double>& y) const {
  if (transformation_ == nullptr) {
    return true;
  }
  const GdalMessages messages;
  std::vector<int> success(x.size(), 0);
  transformation_->Transform(static_cast<int>(x.size()), x.data(), y.data(), nullptr, success.data());
  return std::ranges::find(success, 0) == success.end();
}

Raster reprojected(const Raster& raster, const std::string& to_wkt, bool is_code) {
  constexpr double no_data = std::numeric_limits<double>::quiet_NaN();
  const GdalMessages messages;
  const GDALDatasetUniquePtr source(
      GetGDALDriverManager()->GetDriverByName("MEM")->Create("", raster.columns, raster.rows, 1, GDT_Float64, nullptr));
  double transform[6] = {raster.x - 0.5 * raster.cell_x, raster.cell_x, 0.0,
                         raster.y - 0.5 * raster.cell_y, 0.0,           raster.cell_y};
  source->SetGeoTransform(transform);
  const OGRSpatialReference reference = reference_from_wkt(raster.crs);
  source->SetSpatialRef(&reference);
  source->GetRasterBand(1)->SetNoDataValue(no_data);
  Raster values = raster;
  const bool is_copied =
      source->RasterIO(GF_Write, 0, 0, raster.columns, raster.rows, values.values.data(), raster.columns, raster.rows,
                       GDT_Float64, 1, nullptr, 0, 0, 0, nullptr) == CE_None;
  THAWSLIDE_ASSERT(is_copied, "no copy of {} x {} points{}", raster.columns, raster.rows, messages.remark());
  const char* const words[] = {"-of", "MEM", "-t_srs",     to_wkt.c_str(), "-r",        is_code ? "near" : "bilinear",
                               "-et", "0",   "-dstnodata", "nan",          "-novshift", nullptr};
  GDALWarpAppOptions* const options = GDALWarpAppOptionsNew(const_cast<char**>(words), nullptr);
  GDALDatasetH handle = GDALDataset::ToHandle(source.get());
  const GDALDatasetUniquePtr made(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &handle, options, nullptr)));
  GDALWarpAppOptionsFree(options);
  if (made == nullptr || made->GetGeoTransform(transform) != CE_None) {
    throw UserError("the raster cannot be reprojected from {} to {}{}", name_of(raster.crs), name_of(to_wkt),
                    messages.remark());
  }
  Raster result;
  result.columns = made->GetRasterXSize();
  result.rows = made->GetRasterYSize();
  result.cell_x = transform[1];
  result.cell_y = -transform[5];
  result.x = transform[0] + 0.5 * result.cell_x;
  result.y = transform[3] - (result.rows - 0.5) * result.cell_y;
  result.crs = to_wkt;
  result = result.filled(no_data);
  // From north to south.
  const auto line = static_cast<GSpacing>(result.columns) * static_cast<GSpacing>(sizeof(double));
  const CPLErr read = made->GetRasterBand(1)->RasterIO(
      GF_Read, 0, 0, result.columns, result.rows, result.values.data() + result.index(0, result.rows - 1),
      result.columns, result.rows, GDT_Float64, sizeof(double), -line, nullptr);
  THAWSLIDE_ASSERT(read == CE_None, "no values of {} x {} points{}", result.columns, result.rows, messages.remark());
  return result;
}

LikelySystem likely_system(const std::string& file, const std::string& specified, const Rectangle& extent,
                           const std::string& ground) {
  const std::string name = name_of_file(file);
  if (ground.empty()) {
    return {specified, ""};
  }
  if (specified.empty()) {
    return {ground, fmt::format("{} specifies no coordinate reference system: that of the DEM, {}, is assumed", name,
                                name_of(ground))};
  }
  if (reference_from_wkt(specified).IsGeographic() != 0 && !can_be_degrees(extent)) {
    return {
        ground,
        fmt::format("{} specifies degrees ({}), which {}, {} cannot be: the system of the DEM, {}, is assumed", name,
                    name_of(specified), coordinate_text(extent.min_x), coordinate_text(extent.min_y), name_of(ground))};
  }
  if (Reprojection(specified, ground).changes_nothing()) {
    return {ground, ""};
  }
  return {specified, fmt::format("note: {} was reprojected from {} to {}", name, name_of(specified), name_of(ground))};
}

}  // namespace thawslide::gis
