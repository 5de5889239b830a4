#include "base/raster.hpp"

#include <limits>

#include "base/error.hpp"

namespace thawslide {

double bilinear(const Raster& raster, double x, double y, Missing missing) {
  constexpr double rounding = 1e-9;  // in cells
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const double across = (x - raster.x) / raster.cell_x, up = (y - raster.y) / raster.cell_y;
  const double column = std::floor(across), row = std::floor(up);
  const double fraction_x = across - column, fraction_y = up - row;
  double value = 0.0, weight = 0.0;
  for (int k = 0; k < 4; ++k) {
    const int right = k % 2, above = k / 2;
    const double fraction = (right == 0 ? 1.0 - fraction_x : fraction_x) * (above == 0 ? 1.0 - fraction_y : fraction_y);
    if (fraction <= rounding) {
      continue;
    }
    const double i = column + right, j = row + above;
    const bool inside = i >= 0.0 && j >= 0.0 && i < raster.columns && j < raster.rows;
    const double there = inside ? raster.at(static_cast<int>(i), static_cast<int>(j)) : unknown;
    if (!std::isnan(there)) {
      value += fraction * there;
      weight += fraction;
    } else if (missing == Missing::unknown || (missing == Missing::nothing && !inside)) {
      return unknown;
    }
  }
  return missing == Missing::zero ? value : weight > 0.0 ? value / weight : unknown;
}

double volume_of(const Raster& thickness) {
  double sum = 0.0;
  for (const double value : thickness.values) {
    sum += std::isnan(value) ? 0.0 : value;
  }
  return sum * thickness.cell_x * thickness.cell_y;
}

namespace {

constexpr int none = -1;

// By point: row of the nearest known point in the same column, or `none`.
std::vector<int> nearest_rows(const Raster& raster) {
  std::vector<int> nearest(raster.values.size(), none);
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      const bool known = !std::isnan(raster.at(column, row));
      nearest[raster.index(column, row)] = known ? row : (row > 0 ? nearest[raster.index(column, row - 1)] : none);
    }
  }
  for (int row = raster.rows - 2; row >= 0; --row) {
    for (int column = 0; column < raster.columns; ++column) {
      int& below = nearest[raster.index(column, row)];
      const int above = nearest[raster.index(column, row + 1)];
      if (above != none && (below == none || above - row < row - below)) {
        below = above;
      }
    }
  }
  return nearest;
}

// Columns whose parabolas form the lower envelope along a row, and the start of the interval of each.
struct Envelope {
  std::vector<int> column;
  std::vector<double> begin;

  // Adds columns in ascending order. height: minimum of the parabola. width: width of a column.
  void add(int next, const std::vector<double>& height, double width) {
    const auto lift = [&](int c) { return height[static_cast<std::size_t>(c)] / (width * width) + double(c) * c; };
    double from = -HUGE_VAL;
    while (!column.empty()) {
      from = (lift(next) - lift(column.back())) / (2.0 * (next - column.back()));
      if (from > begin.back()) {
        break;
      }
      column.pop_back();
      begin.pop_back();
      from = -HUGE_VAL;
    }
    column.push_back(next);
    begin.push_back(from);
  }
};

}  // namespace

// Along columns, then along rows, where squared distances are parabolas and their lower envelope is the minimum:
// Felzenszwalb and Huttenlocher (2012), Distance transforms of sampled functions, Theory of Computing 8, section 2.1.
void fill_from_nearest_known(Raster& raster) {
  const std::vector<int> nearest = nearest_rows(raster);
  std::vector<double> height(static_cast<std::size_t>(raster.columns));
  Envelope envelope;
  for (int row = 0; row < raster.rows; ++row) {
    envelope.column.clear();
    envelope.begin.clear();
    for (int column = 0; column < raster.columns; ++column) {
      const int there = nearest[raster.index(column, row)];
      if (there != none) {
        height[static_cast<std::size_t>(column)] = std::pow((there - row) * raster.cell_y, 2);
        envelope.add(column, height, raster.cell_x);
      }
    }
    THAWSLIDE_ASSERT(!envelope.column.empty(), "no point of {} x {} has data", raster.columns, raster.rows);
    std::size_t k = 0;
    for (int column = 0; column < raster.columns; ++column) {
      while (k + 1 < envelope.begin.size() && envelope.begin[k + 1] < column) {
        ++k;
      }
      const int there = nearest[raster.index(envelope.column[k], row)];
      // In place: a point with data is its own nearest point.
      raster.values[raster.index(column, row)] = raster.at(envelope.column[k], there);
    }
  }
}

}  // namespace thawslide
