// Rasters of one band in files: GeoTIFF and ESRI ASCII grids are read, GeoTIFF is written.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/raster.hpp"
#include "gis/point_window.hpp"
#include "gis/rectangle.hpp"
#include "gis/value_unit.hpp"

namespace thawslide::gis {

// Before memory is asked for so many points of a file. Throws UserError for more than are taken, or than fit into
// memory.
void require_readable(const std::string& file, double columns, double rows);

// A file that is open. What it throws is a UserError that begins with the file's name.
class RasterFile {
 public:
  // Opens the file and checks what can be checked without its values: one band, and at most one more with the opacity;
  // straight to the axes; in a known unit.
  RasterFile(const std::string& file, Quantity quantity);
  ~RasterFile();
  RasterFile(const RasterFile&) = delete;
  RasterFile& operator=(const RasterFile&) = delete;

  [[nodiscard]] const std::string& file() const { return file_; }
  // Places of the points and the file's reference system, without values.
  [[nodiscard]] const Raster& layout() const { return layout_; }
  // The outer edges of the cells about the points.
  [[nodiscard]] Rectangle extent() const;
  // How the values come to the unit that they are read in.
  [[nodiscard]] const UnitConversion& conversion() const { return conversion_; }

  // The points that lie in the window, and one more on each side where the file has one; without a window, all of them.
  // Reads nothing else. Values are scaled as the file states, and converted. NaN: nodata, what the file's mask or its
  // band of opacity leaves out, and what is not finite. An error if no value is left.
  [[nodiscard]] Raster read(const std::optional<Rectangle>& window = std::nullopt) const;

 private:
  struct Handle;
  void remove_masked(const PointWindow& part, Raster& raster) const;

  std::unique_ptr<Handle> handle_;
  std::string file_;
  Raster layout_;
  UnitConversion conversion_;
  bool north_up_ = true;
  bool has_nodata_ = false;
  double nodata_ = 0.0;
};

enum class Precision { float32, float64 };

struct BandText {
  std::string unit;         // "m"
  std::string description;  // "largest thickness"
};

// Tiled, DEFLATE compressed, nodata -9999 for NaN, with the raster's reference system. Whole or not there: written
// beside its place and renamed.
void write_geotiff(const std::string& file, const Raster& raster, const BandText& text,
                   Precision precision = Precision::float64);

// Whether GDAL takes the file for a raster, and not for polygons, lines or points too.
[[nodiscard]] bool is_raster_file(const std::string& file);

}  // namespace thawslide::gis
