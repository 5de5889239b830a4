#include "gis/raster_file.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>

#include "base/atomic_file.hpp"
#include "base/available_memory.hpp"
#include "base/error.hpp"
#include "base/rounding.hpp"
#include "base/text.hpp"
#include "config/input_limits.hpp"
#include "gis/gdal_messages.hpp"
#include "gis/vector_file.hpp"

namespace thawslide::gis {

struct RasterFile::Handle {
  GDALDatasetUniquePtr dataset;
  GDALRasterBand* band = nullptr;
  std::vector<GDALRasterBand*> masks;  // 0 where there is no data
  double scale = 1.0, offset = 0.0;    // of the values stored
  bool is_single = false;              // 32-bit floating point
};

namespace {

// Known cause for which GDAL cannot read a file, with its remedy; empty if there is none.
std::string cause_of_unreadable_raster(const std::string& file) {
  std::string head(4096, '\0');  // includes the header of an ASCII grid
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (head.rfind("\xEF\xBB\xBF", 0) == 0) {
    return fmt::format(
        "the file begins with a UTF-8 byte order mark, which an ASCII grid may not have. Remove it: sed -i "
        "'1s/^\\xEF\\xBB\\xBF//' {}",
        shell_quote(file));
  }
  // After lines of a keyword and a number.
  static const std::regex begins_with_nan(R"(\s*[a-z]\w*\s+[-+.\d]\S*(\s+[a-z]\w*\s+[-+.\d]\S*)*\s+nan\s)",
                                          std::regex::icase);
  if (std::regex_search(head.c_str(), begins_with_nan, std::regex_constants::match_continuous)) {
    return fmt::format(
        "the first value of the ASCII grid is nan, which GDAL does not read there. Write the number of NODATA_value in "
        "its place, for example -9999: sed -i 's/nan/-9999/gi' {}",
        shell_quote(file));
  }
  return "";
}

[[noreturn]] void fail_open(const std::string& file, const GdalMessages& messages) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    throw UserError("{}: there is no such file. Correct the path.", file);
  }
  if (const std::string cause = cause_of_unreadable_raster(file); !cause.empty()) {
    throw UserError("{}: {}", file, cause);
  }
  if (GDALIdentifyDriverEx(file.c_str(), GDAL_OF_VECTOR, vector_formats(), nullptr) != nullptr) {
    throw UserError(
        "{}: the file has polygons, lines or points; needed: a raster, as a GeoTIFF or an ESRI ASCII grid. Is it "
        "swapped with another file? Correct the path.",
        file);
  }
  throw UserError(
      "{}: the raster cannot be opened{}. Allowed: a GeoTIFF or an ESRI ASCII grid; check that the file is complete "
      "and readable.",
      file, messages.remark());
}

GDALDatasetUniquePtr open_raster(const std::string& file) {
  const GdalMessages messages;
  GDALDriverH driver = GDALIdentifyDriver(file.c_str(), nullptr);
  // By default, the driver of ASCII grids reads floats, and integers if the first value is an integer.
  const bool is_ascii = driver != nullptr && std::string(GDALGetDescription(driver)) == "AAIGrid";
  const char* const as_double[] = {"DATATYPE=Float64", nullptr};
  GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(),
                                                 GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                                 raster_formats(), is_ascii ? as_double : nullptr, nullptr));
  if (dataset == nullptr) {
    fail_open(file, messages);
  }
  return dataset;
}

// Layout of the points from GDAL's six coefficients: corner, columns and rows of the upper left pixel.
Raster layout_from(const std::string& file, GDALDataset& dataset, bool& north_up) {
  double transform[6];
  if (dataset.GetGeoTransform(transform) != CE_None) {
    throw UserError(
        "{}: the raster is not georeferenced: its corner and the size of its cells are unknown. Export it again with "
        "georeferencing (GeoTIFF tags, or a world file next to it).",
        file);
  }
  const double along = std::abs(transform[1]) + std::abs(transform[5]);
  if (std::abs(transform[2]) + std::abs(transform[4]) > 1e-12 * along || transform[1] <= 0.0 || transform[5] == 0.0) {
    throw UserError(
        "{}: the raster is rotated or mirrored (geotransform {:g}); allowed: columns from west to east, rows from "
        "north to south or back. Straighten it: gdalwarp -r bilinear {} straight.tif",
        file, fmt::join(transform, ", "), shell_quote(file));
  }
  Raster layout;
  layout.columns = dataset.GetRasterXSize();
  layout.rows = dataset.GetRasterYSize();
  layout.cell_x = transform[1];
  layout.cell_y = std::abs(transform[5]);
  north_up = transform[5] < 0.0;
  layout.x = transform[0] + 0.5 * layout.cell_x;
  layout.y = (north_up ? transform[3] - layout.rows * layout.cell_y : transform[3]) + 0.5 * layout.cell_y;
  layout.crs = wkt_from_reference(dataset.GetSpatialRef());
  const double point[] = {layout.x, layout.y, layout.x_end(), layout.y_end(), layout.cell_x, layout.cell_y};
  if (!std::all_of(std::begin(point), std::end(point), [](double number) { return std::isfinite(number); })) {
    throw UserError(
        "{}: the raster has no valid position (geotransform {:g}): corners and sizes of cells must be finite numbers. "
        "Export it again with georeferencing.",
        file, fmt::join(transform, ", "));
  }
  return layout;
}

// Band with the values; a second one may contain the opacity. `alpha`: null without one.
GDALRasterBand* band_of_values(const std::string& file, GDALDataset& dataset, GDALRasterBand*& alpha) {
  std::vector<GDALRasterBand*> of_values;
  for (GDALRasterBand* band : dataset.GetBands()) {
    if (band->GetColorInterpretation() == GCI_AlphaBand && alpha == nullptr) {
      alpha = band;
    } else {
      of_values.push_back(band);
    }
  }
  if (of_values.size() != 1) {
    throw UserError("{}: the raster has {} bands; allowed: one. Take one out: gdal_translate -b 1 {} one-band.tif",
                    file, dataset.GetRasterCount(), file);
  }
  return of_values.front();
}

// GDAL opens an accompanying mask in any format, which is therefore restricted.
void require_plain_mask(const std::string& file) {
  const std::string mask = file + ".msk";
  std::error_code ignored;
  if (!std::filesystem::exists(mask, ignored)) {
    return;
  }
  GDALDriverH driver = GDALIdentifyDriver(mask.c_str(), nullptr);
  if (driver == nullptr || std::string(GDALGetDescription(driver)) != "GTiff") {
    throw UserError("{}: the mask of {} is not a GeoTIFF. Remove it, or write the raster with its mask again.", mask,
                    file);
  }
}

}  // namespace

const char* const* raster_formats() {
  static const char* const formats[] = {"GTiff", "AAIGrid", nullptr};
  return formats;
}

void require_readable(const std::string& file, double columns, double rows) {
  constexpr double copies = 2.0;  // while the raster is converted to the ground
  const double points = columns * rows, bytes = points * sizeof(double) * copies;
  if (points > config::most_raster_points) {
    throw UserError(
        "{}: {} x {} points of it are needed; allowed: {} points. Crop it (gdal_translate -projwin), resample it to a "
        "larger spacing (gdalwarp -tr), or make the domain smaller.",
        file, count_text(columns), count_text(rows), count_text(config::most_raster_points));
  }
  const AvailableMemory available = available_memory();
  if (bytes > available.bytes) {
    throw UserError(
        "{}: {} x {} points of it are needed; they take {} GB of memory, and {} GB {}. Crop it (gdal_translate "
        "-projwin), resample it to a larger spacing (gdalwarp -tr), or make the domain smaller.",
        file, count_text(columns), count_text(rows), rounded_text(bytes / 1e9), rounded_text(available.bytes / 1e9),
        available.bound);
  }
}

RasterFile::RasterFile(const std::string& file, Quantity quantity) : handle_(std::make_unique<Handle>()), file_(file) {
  handle_->dataset = open_raster(file);
  const GdalMessages messages;
  GDALDataset& dataset = *handle_->dataset;
  GDALRasterBand* alpha = nullptr;
  handle_->band = band_of_values(file, dataset, alpha);
  layout_ = layout_from(file, dataset, north_up_);
  GDALRasterBand& band = *handle_->band;
  const GDALDataType type = band.GetRasterDataType();
  if (GDALDataTypeIsComplex(type) != 0) {
    throw UserError("{}: the values are of the type {}; allowed: real numbers or integers.", file,
                    GDALGetDataTypeName(type));
  }
  handle_->is_single = type == GDT_Float32;
  handle_->scale = band.GetScale();
  handle_->offset = band.GetOffset();
  if (!std::isfinite(handle_->scale) || handle_->scale == 0.0 || !std::isfinite(handle_->offset)) {
    throw UserError(
        "{}: the values are stored with a scale of {:g} and an offset of {:g}; allowed: finite numbers, and a scale "
        "other than 0. Correct them: gdal_edit.py -scale 1 -offset 0 {}",
        file, handle_->scale, handle_->offset, shell_quote(file));
  }
  const HeightUnit heights = height_unit_of(dataset.GetSpatialRef());
  conversion_ = conversion_from({file, band.GetUnitType(), heights.name, heights.metres}, quantity);
  int has_nodata = 0;
  nodata_ = type == GDT_Int64    ? static_cast<double>(band.GetNoDataValueAsInt64(&has_nodata))
            : type == GDT_UInt64 ? static_cast<double>(band.GetNoDataValueAsUInt64(&has_nodata))
                                 : band.GetNoDataValue(&has_nodata);
  has_nodata_ = has_nodata != 0;
  require_plain_mask(file);
  // GDAL's own mask ignores opacity bands that are not integers, and those of rasters with a nodata value.
  const int flags = band.GetMaskFlags();
  if ((flags & GMF_PER_DATASET) != 0 && (flags & GMF_ALPHA) == 0) {
    handle_->masks.push_back(band.GetMaskBand());
  }
  if (alpha != nullptr) {
    handle_->masks.push_back(alpha);
  }
}

RasterFile::~RasterFile() = default;

Rectangle RasterFile::extent() const {
  return span_of_points(layout_).widened(0.5 * layout_.cell_x, 0.5 * layout_.cell_y);
}

Raster RasterFile::read(const std::optional<Rectangle>& window) const {
  Raster raster = read_points(window ? points_in(layout_, *window) : PointWindow{0, 0, layout_.columns, layout_.rows});
  const bool any = std::ranges::any_of(raster.values, [](double v) { return !std::isnan(v); });
  if (!any) {
    throw UserError("{}: no point holds a value, all are nodata{}. Check that it is the right file.", file_,
                    window ? " in the area asked for" : "");
  }
  return raster;
}

Raster RasterFile::read_points(const PointWindow& part) const {
  THAWSLIDE_ASSERT(part.columns > 0 && part.rows > 0, "{}: a window without a point", file_);
  require_readable(file_, part.columns, part.rows);
  Raster raster = layout_of(layout_, part);
  raster.values.resize(raster.index(0, raster.rows));
  // GDAL's rows run downwards in a north-up file, so those of the result are filled from the last.
  const int first_line = north_up_ ? layout_.rows - part.first_row - part.rows : part.first_row;
  const auto line_bytes = static_cast<GSpacing>(part.columns) * static_cast<GSpacing>(sizeof(double));
  double* const first = raster.values.data() + (north_up_ ? raster.index(0, part.rows - 1) : 0);
  const GdalMessages messages;
  const CPLErr result =
      handle_->band->RasterIO(GF_Read, part.first_column, first_line, part.columns, part.rows, first, part.columns,
                              part.rows, GDT_Float64, sizeof(double), north_up_ ? -line_bytes : line_bytes, nullptr);
  if (result != CE_None || messages.any_error()) {
    if (const std::string cause = cause_of_unreadable_raster(file_); !cause.empty()) {
      throw UserError("{}: {}", file_, cause);
    }
    throw UserError("{}: the values cannot be read{}. The file seems to be damaged or truncated: copy it again.", file_,
                    messages.remark());
  }
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  // A sum with an offset that is 0 exactly may differ from 0 after rounding.
  const double rounding = 1e-12 * (std::abs(conversion_.factor * handle_->offset) + std::abs(conversion_.offset));
  const auto nodata_single = static_cast<float>(nodata_);
  for (double& value : raster.values) {
    const bool is_nodata =
        has_nodata_ && (value == nodata_ || (handle_->is_single && static_cast<float>(value) == nodata_single));
    value = is_nodata ? missing : conversion_.factor * (value * handle_->scale + handle_->offset) + conversion_.offset;
    value = std::isfinite(value) ? value : missing;
    value = std::abs(value) < rounding ? 0.0 : value;
  }
  remove_masked(part, raster);
  return raster;
}

// Works line by line, because this needs no second raster in memory.
void RasterFile::remove_masked(const PointWindow& part, Raster& raster) const {
  const GdalMessages messages;
  std::vector<double> mask(static_cast<std::size_t>(part.columns));
  for (GDALRasterBand* band : handle_->masks) {
    for (int row = 0; row < part.rows; ++row) {
      const int line = north_up_ ? layout_.rows - 1 - part.first_row - row : part.first_row + row;
      const CPLErr result = band->RasterIO(GF_Read, part.first_column, line, part.columns, 1, mask.data(), part.columns,
                                           1, GDT_Float64, 0, 0, nullptr);
      if (result != CE_None || messages.any_error()) {
        throw UserError("{}: the mask cannot be read{}. The file seems to be damaged or truncated: copy it again.",
                        file_, messages.remark());
      }
      for (int column = 0; column < part.columns; ++column) {
        double& value = raster.values[raster.index(column, row)];
        value = mask[static_cast<std::size_t>(column)] == 0.0 ? std::numeric_limits<double>::quiet_NaN() : value;
      }
    }
  }
}

bool is_raster_file(const std::string& file) {
  const GdalMessages messages;
  const auto is = [&](unsigned kind) { return GDALIdentifyDriverEx(file.c_str(), kind, nullptr, nullptr) != nullptr; };
  return is(GDAL_OF_RASTER) && !is(GDAL_OF_VECTOR);
}

void write_geotiff(const std::string& file, const Raster& raster, const BandText& text) {
  constexpr double written_nodata = -9999.0;
  THAWSLIDE_ASSERT(raster.columns > 0 && raster.rows > 0 &&
                       raster.values.size() == raster.index(raster.columns - 1, raster.rows - 1) + 1,
                   "{} x {} points, {} values", raster.columns, raster.rows, raster.values.size());
  AtomicFile whole(file);
  const GdalMessages messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  THAWSLIDE_ASSERT(driver != nullptr, "GDAL has no driver for GeoTIFF");
  // Predictor 3 is for floating-point values. Tiles without data are omitted, so the size scales with the slide.
  const char* const options[] = {"TILED=YES",        "COMPRESS=DEFLATE", "PREDICTOR=3",
                                 "BIGTIFF=IF_SAFER", "SPARSE_OK=TRUE",   nullptr};
  GDALDatasetUniquePtr dataset(driver->Create(whole.temporary().c_str(), raster.columns, raster.rows, 1, GDT_Float64,
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
  std::vector<double> values = raster.values;
  std::ranges::replace_if(
      values, [](double value) { return std::isnan(value); }, written_nodata);
  // From north to south.
  const auto line = static_cast<GSpacing>(raster.columns) * static_cast<GSpacing>(sizeof(double));
  const bool written =
      band.RasterIO(GF_Write, 0, 0, raster.columns, raster.rows, values.data() + raster.index(0, raster.rows - 1),
                    raster.columns, raster.rows, GDT_Float64, sizeof(double), -line, nullptr) == CE_None;
  dataset.reset();
  if (!written || messages.any_error()) {
    whole.fail(messages.reason());
  }
  whole.publish();
}

}  // namespace thawslide::gis
