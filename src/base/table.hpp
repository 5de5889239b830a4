// A number given as a constant or as a table over one variable; linear between entries, constant beyond the ends.
#pragma once

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

// An initial field: a value, or a table over depth below the body's surface [m] or over x [m].
struct InitialField {
  enum class Over { nothing, depth, x };
  Over over = Over::nothing;
  Table table;

  InitialField() = default;
  explicit InitialField(double constant) : table(constant) {}
  [[nodiscard]] double at(double depth, double x) const;
};

}  // namespace thawslide
