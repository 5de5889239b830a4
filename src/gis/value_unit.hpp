// The unit of a raster's values, and the conversion to the unit that the program computes in.
#pragma once

#include <string>

namespace thawslide::gis {

// What the values of a raster measure: lengths [m] (elevations, thicknesses, depths of a bed), temperatures [C],
// shares of a volume [1], or codes, which have no unit.
enum class Quantity { length, temperature, share, code };

// The units that a file states. Empty: none.
struct StatedUnits {
  std::string file;
  std::string band;              // of its values
  std::string vertical;          // of the heights of its reference system
  double vertical_metres = 1.0;  // in one of these
};

// computed = factor * stated + offset
struct UnitConversion {
  double factor = 1.0, offset = 0.0;
  std::string warning;  // for the user; empty: nothing is converted
};

// A band without a unit of its own is in that of the heights of its reference system if it holds lengths. Without
// either it is in metres, degrees Celsius or shares of 1. Throws UserError for a unit that is not known or is none of
// the quantity, and for two that contradict one another.
[[nodiscard]] UnitConversion conversion_from(const StatedUnits& stated, Quantity quantity);

}  // namespace thawslide::gis
