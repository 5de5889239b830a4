// A number given as a constant or as a table over one variable; linear between entries, constant beyond the ends.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace thawslide {

// A jump is two entries at the same abscissa; at the jump itself the later value holds.
struct Table {
  std::vector<double> abscissa;  // ascending; empty for a constant
  std::vector<double> value;     // one value, or as many as abscissae

  Table() = default;
  explicit Table(double constant) : value{constant} {}
  Table(std::vector<double> abscissae, std::vector<double> values)
      : abscissa(std::move(abscissae)), value(std::move(values)) {}

  [[nodiscard]] bool is_constant() const { return abscissa.empty(); }
  [[nodiscard]] double at(double x) const;
};

// The width of a 2D section: a number, 0 where none is given, or a table over x [m].
struct WidthOverX {
  Table table{0.0};

  [[nodiscard]] bool varies() const { return !table.is_constant(); }
  // The width that results are per metre of, the first of a table; and what sums of them are multiplied by.
  [[nodiscard]] double reference() const { return table.value.front(); }
  [[nodiscard]] double factor() const { return reference() > 0.0 ? reference() : 1.0; }
};

// An initial field: a value, a table over depth below the body's surface [m] or over x [m], or from a map, as an
// attribute of polygons or a raster: then it has no table.
struct InitialField {
  enum class Over { nothing, depth, x, attribute, raster };
  Over over = Over::nothing;
  Table table;
  std::string source;  // name of the attribute, or path of the raster (absolute once read)

  InitialField() = default;
  explicit InitialField(double constant) : table(constant) {}
  [[nodiscard]] bool is_given() const { return is_map() || !table.value.empty(); }
  [[nodiscard]] bool is_map() const { return over == Over::attribute || over == Over::raster; }
  [[nodiscard]] double at(double depth, double x) const;  // not of a map
};

}  // namespace thawslide
