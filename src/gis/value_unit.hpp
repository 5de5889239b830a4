// Unit of a raster's values, and conversion to the unit of the computation.
#pragma once

#include <string>

namespace thawslide::gis {

// Quantity of the values of a raster: lengths [m] (elevations, thicknesses, depths of a bed), temperatures [C],
// fractions of a volume [1], speeds [m/s], times [s], or codes, which have no unit.
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

// A band of lengths without a unit has the vertical unit of its reference system. Without either, values are in metres,
// degrees Celsius, fractions of 1, m/s or s. Throws UserError for an unknown unit or one of another quantity, and for
// two contradictory units.
[[nodiscard]] UnitConversion conversion_from(const StatedUnits& stated, Quantity quantity);

}  // namespace thawslide::gis
