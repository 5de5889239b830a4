#include "terrain/layer_thickness.hpp"

#include <algorithm>
#include <cmath>

namespace thawslide::terrain {

namespace {

constexpr int reach = 4;  // columns on each side that count
constexpr double round_off = 1e-9;

// Of one column of cells: what particles fill of its band cells [m2], length of ground [m].
struct Column {
  double filled, length;
};

Column column_at(const Polyline& line, long number, double cell, double spacing) {
  const double left = static_cast<double>(number) * cell;
  // The corners of the column's cells are candidates if their hats, one cell wide on each side, overlap the ground.
  const double highest = line.highest(left - cell, left + 2.0 * cell);
  const double highest_corner = std::ceil(highest / cell + 1.0 - round_off) - 1.0;
  const double top = (highest_corner + 1.0) * cell;
  Column column{0.0, 0.0};
  const long rows = std::lround(cell / spacing);
  for (long k = 0; k < rows; ++k) {
    const double x = left + (static_cast<double>(k) + 0.5) * spacing;
    const double bottom = std::ceil(line.height(x) / spacing - 0.5 - round_off) * spacing;  // of the lowest particle
    column.filled += (top - bottom) * spacing;
    column.length += std::hypot(1.0, line.gradient(x)) * spacing;
  }
  return column;
}

}  // namespace

template <int Dim>
LayerThickness::LayerThickness(const Ground<Dim>& ground, double cell, double spacing, double extent) : cell_(cell) {
  const long count = static_cast<long>(std::ceil(extent / cell)) + 2;  // one before and one behind the domain
  std::vector<Column> columns;
  for (long k = -1 - reach; k < count - 1 + reach; ++k) {
    columns.push_back(column_at(ground.line(), k, cell, spacing));
  }
  for (long k = 0; k < count; ++k) {
    double filled = 0.0, length = 0.0;
    for (int d = -reach; d <= reach; ++d) {
      const double weight = reach + 1 - std::abs(d);
      const Column& column = columns[static_cast<std::size_t>(k + reach + d)];
      filled += weight * column.filled;
      length += weight * column.length;
    }
    at_middle_.push_back(filled / length);
  }
}

double LayerThickness::at(double x) const {
  const double in_columns = x / cell_ + 0.5;  // 0 in the middle of the first column
  const double last = static_cast<double>(at_middle_.size()) - 2.0;
  const double left = std::clamp(std::floor(in_columns), 0.0, last);
  const auto k = static_cast<std::size_t>(left);
  return at_middle_[k] + (in_columns - left) * (at_middle_[k + 1] - at_middle_[k]);
}

double LayerThickness::largest() const { return *std::max_element(at_middle_.begin(), at_middle_.end()); }

template LayerThickness::LayerThickness(const Ground<2>&, double, double, double);
template LayerThickness::LayerThickness(const Ground<3>&, double, double, double);

}  // namespace thawslide::terrain
