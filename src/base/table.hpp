// Number given as a constant or as a table over one variable; linear between entries, constant beyond the ends.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace thawslide {

// A jump is given by two entries at the same abscissa; the later value applies at the jump itself.
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

// Width of a 2D section: a number, 0 if not given, or a table over x [m].
struct WidthOverX {
  Table table{0.0};

  [[nodiscard]] bool varies() const { return !table.is_constant(); }
  // Reference width, per metre of which results are given: the first of a table. factor: multiplier of sums of results.
  [[nodiscard]] double reference() const { return table.value.front(); }
  [[nodiscard]] double factor() const { return reference() > 0.0 ? reference() : 1.0; }
};

// Thickness of the band over time [s]; 0 m without a band.
struct BandThickness {
  Table table;  // empty: not given

  [[nodiscard]] bool is_given() const { return !table.value.empty(); }
  [[nodiscard]] double at(double time) const { return is_given() ? table.at(time) : 0.0; }
  [[nodiscard]] double smallest() const;
  [[nodiscard]] double largest() const;
};

// Initial field: a value, a table over depth below the surface or over x [m], or a map (attribute or raster).
struct InitialField {
  enum class Over { nothing, depth, x, attribute, raster };
  Over over = Over::nothing;
  Table table;
  std::string source;  // name of the attribute, or path of the raster (absolute once read)

  InitialField() = default;
  explicit InitialField(double constant) : table(constant) {}
  [[nodiscard]] bool is_given() const { return is_map() || !table.value.empty(); }
  [[nodiscard]] bool is_map() const { return over == Over::attribute || over == Over::raster; }
  [[nodiscard]] double at(double depth, double x) const;  // not for maps
};

}  // namespace thawslide
