// Single-band raster files: GeoTIFF and ESRI ASCII grids are read, GeoTIFF is written. Units of their values.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/raster.hpp"
#include "gis/point_window.hpp"

namespace thawslide::gis {

// Quantity of a raster's values: lengths [m], temperatures [C], volume fractions [1], speeds [m/s], times [s], codes.
enum class Quantity { length, temperature, fraction, speed, time, code };

// Units stated in a file; empty: none.
struct StatedUnits {
  std::string file;
  std::string band;              // of the values
  std::string vertical;          // of the heights of its reference system
  double vertical_metres = 1.0;  // length of this unit
};

// computed = factor * stated + offset
struct UnitConversion {
  double factor = 1.0, offset = 0.0;
  std::string warning;  // for the user; empty: no conversion
};

// Without a unit, lengths have the vertical one of the system, or values are in m, C, 1, m/s or s. Throws UserError for
// an unknown unit, one of another quantity, and two contradictory units.
[[nodiscard]] UnitConversion conversion_from(const StatedUnits& stated, Quantity quantity);

// GDAL's drivers for files of a user; ends with null. Others may refer to files or networks that a case may not name.
[[nodiscard]] const char* const* raster_formats();

// Throws UserError if the points of a file exceed the limit, or the available memory. Call before allocating them.
void require_readable(const std::string& file, double columns, double rows);

// Open raster file. It throws UserErrors that begin with the file's name.
class RasterFile {
 public:
  // Opens the file and checks its metadata: one band, maybe one more with opacity; aligned with axes; known unit.
  RasterFile(const std::string& file, Quantity quantity);
  ~RasterFile();
  RasterFile(const RasterFile&) = delete;
  RasterFile& operator=(const RasterFile&) = delete;

  [[nodiscard]] const std::string& file() const { return file_; }
  // Positions of the points and the file's reference system, without values.
  [[nodiscard]] const Raster& layout() const { return layout_; }
  // Outer edges of the cells around the points.
  [[nodiscard]] Rectangle extent() const;
  // Conversion of the values to the unit in which they are read.
  [[nodiscard]] const UnitConversion& conversion() const { return conversion_; }

  // Reads the points in the window, and one more on each side; without one, all. Values are scaled and converted; NaN:
  // nodata, masked or non-finite values. Throws if no value is left.
  [[nodiscard]] Raster read(const std::optional<Rectangle>& window = std::nullopt) const;
  // Reads the points of a window, which may all be without a value.
  [[nodiscard]] Raster read_points(const PointWindow& part) const;

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

struct BandText {
  std::string unit;          // "m"
  std::string description;   // "maximum thickness"
  std::string heights = {};  // vertical reference system of elevations, as from height_system_of; empty: none
};

// Tiled, DEFLATE compressed, nodata -9999 for NaN, with the raster's reference system. The file is replaced atomically.
void write_geotiff(const std::string& file, const Raster& raster, const BandText& text);

// True if GDAL reads the file as a raster, and not also as vector data.
[[nodiscard]] bool is_raster_file(const std::string& file);

}  // namespace thawslide::gis
