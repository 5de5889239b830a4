// Nearest known point in two sweeps: along each column, then along each row over the columns' nearest points. The
// squared distances to these are parabolas along the row, and their lower envelope gives the minimum: Felzenszwalb and
// Huttenlocher (2012), Distance transforms of sampled functions, Theory of Computing 8, section 2.1.
#include "base/nearest_known.hpp"

#include <cmath>

#include "base/error.hpp"

namespace thawslide {

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

// Columns whose parabolas form the lower envelope along a row, and the start of the interval in which each is the
// lowest.
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
