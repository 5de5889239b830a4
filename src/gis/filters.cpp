#include "gis/filters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace thawslide::gis {

namespace {

// exp(-d^2 / (2 s^2)) at 0, 1, ... points from the centre, up to the filter's reach or the raster's length.
std::vector<double> weights_of(double standard_deviation, double cell, int count) {
  const double s = standard_deviation / cell;
  const auto reach = static_cast<int>(std::min(std::ceil(smoothing_reach * s), static_cast<double>(count)));
  std::vector<double> weights;
  for (int k = 0; k <= reach; ++k) {
    const double d = k / s;
    weights.push_back(std::exp(-0.5 * d * d));
  }
  return weights;
}

// Weighted sums along a row around a point: of 1, x, x^2, z and x z, with x relative to the point in cells.
struct RowSums {
  double w = 0.0, x = 0.0, xx = 0.0, z = 0.0, xz = 0.0;
};

// The same over rows and columns.
struct PlaneSums {
  double w = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0, z = 0.0, xz = 0.0, yz = 0.0;

  void add(const RowSums& row, double weight, double at) {
    w += weight * row.w;
    x += weight * row.x;
    y += weight * at * row.w;
    xx += weight * row.xx;
    xy += weight * at * row.x;
    yy += weight * at * at * row.w;
    z += weight * row.z;
    xz += weight * row.xz;
    yz += weight * at * row.z;
  }

  // z at x = y = 0 of the least-squares plane; of the flattest one if the points are collinear and do not determine it.
  [[nodiscard]] double height() const {
    const double mean_x = x / w, mean_y = y / w, mean_z = z / w;
    const double c_xx = xx / w - mean_x * mean_x, c_xy = xy / w - mean_x * mean_y, c_yy = yy / w - mean_y * mean_y;
    const double c_xz = xz / w - mean_x * mean_z, c_yz = yz / w - mean_y * mean_z;
    const double trace = c_xx + c_yy, determinant = c_xx * c_yy - c_xy * c_xy;
    constexpr double in_line = 1e-9;
    if (determinant > in_line * trace * trace) {
      return mean_z - ((c_yy * c_xz - c_xy * c_yz) * mean_x + (c_xx * c_yz - c_xy * c_xz) * mean_y) / determinant;
    }
    const double square = std::max(trace * trace, std::numeric_limits<double>::min());
    return mean_z - ((c_xx * c_xz + c_xy * c_yz) * mean_x + (c_xy * c_xz + c_yy * c_yz) * mean_y) / square;
  }
};

std::vector<RowSums> sum_rows(const Raster& raster, const std::vector<double>& weights) {
  const int reach = static_cast<int>(weights.size()) - 1;
  std::vector<RowSums> all(raster.values.size());
  parallel_for(static_cast<std::size_t>(raster.rows), [&](std::size_t row) {
    for (int column = 0; column < raster.columns; ++column) {
      RowSums& sums = all[raster.index(column, static_cast<int>(row))];
      for (int k = std::max(-reach, -column); k <= std::min(reach, raster.columns - 1 - column); ++k) {
        const double z = raster.at(column + k, static_cast<int>(row));
        if (std::isnan(z)) {
          continue;
        }
        const double weight = weights[static_cast<std::size_t>(std::abs(k))];
        sums.w += weight;
        sums.x += weight * k;
        sums.xx += weight * k * k;
        sums.z += weight * z;
        sums.xz += weight * k * z;
      }
    }
  });
  return all;
}

std::vector<double> weights_of(double width, double cell) {
  const int reach = taper_reach(width, cell);
  std::vector<double> weights;
  double sum = 0.0;
  for (int k = -reach; k <= reach; ++k) {
    weights.push_back(1.0 + std::cos(2.0 * std::numbers::pi * k * cell / width));
    sum += weights.back();
  }
  for (double& weight : weights) {
    weight /= sum;
  }
  return weights;
}

// Distributes the value of each point to its neighbours along one axis.
Raster spread(const Raster& raster, const std::vector<double>& weights, int along_columns, int along_rows) {
  const int reach = static_cast<int>(weights.size() / 2);
  Raster result = raster.filled(0.0);
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      const double value = raster.at(column, row);
      for (int k = -reach; value != 0.0 && k <= reach; ++k) {
        const int i = column + k * along_columns, j = row + k * along_rows;
        THAWSLIDE_ASSERT(i >= 0 && j >= 0 && i < raster.columns && j < raster.rows,
                         "the taper leaves the raster at column {}, row {}", i, j);
        result.values[result.index(i, j)] += value * weights[static_cast<std::size_t>(k + reach)];
      }
    }
  }
  return result;
}

}  // namespace

Raster smoothed(const Raster& raster, double standard_deviation) {
  const std::vector<RowSums> rows = sum_rows(raster, weights_of(standard_deviation, raster.cell_x, raster.columns));
  const std::vector<double> weights = weights_of(standard_deviation, raster.cell_y, raster.rows);
  const int reach = static_cast<int>(weights.size()) - 1;
  Raster result = raster;
  parallel_for(static_cast<std::size_t>(raster.rows), [&](std::size_t at) {
    const int row = static_cast<int>(at);
    for (int column = 0; column < raster.columns; ++column) {
      double& value = result.values[raster.index(column, row)];
      if (std::isnan(value)) {
        continue;
      }
      PlaneSums sums;
      for (int k = std::max(-reach, -row); k <= std::min(reach, raster.rows - 1 - row); ++k) {
        sums.add(rows[raster.index(column, row + k)], weights[static_cast<std::size_t>(std::abs(k))], k);
      }
      value = sums.height();
    }
  });
  return result;
}

int taper_reach(double width, double cell) {
  return std::max(0, static_cast<int>(std::ceil(0.5 * width / cell - 1e-9)) - 1);
}

Raster tapered(const Raster& thickness, double width) {
  if (width <= 0.0) {
    return thickness;
  }
  return spread(spread(thickness, weights_of(width, thickness.cell_x), 1, 0), weights_of(width, thickness.cell_y), 0,
                1);
}

}  // namespace thawslide::gis
