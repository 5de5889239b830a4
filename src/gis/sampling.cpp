#include "gis/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace thawslide::gis {

namespace {

constexpr double finer_by = 1.01;
constexpr double no_data = std::numeric_limits<double>::quiet_NaN();

// Weights of the old points first, first + 1, ... for a new one along an axis.
struct AxisWeights {
  int first = 0;
  std::vector<double> weights;
};

// For a new point at a position, and with a cell width, in units of the old spacing; count: number of old points.
using WeightsOfPoint = std::function<AxisWeights(double coordinate, double width, int count)>;

// Fractions of the interval around a position in the cells of old points, in units of their spacing.
AxisWeights overlaps(double coordinate, double width, int count) {
  const double low = coordinate - 0.5 * width, high = coordinate + 0.5 * width;
  const int first = static_cast<int>(std::clamp(std::floor(low + 0.5), 0.0, count - 1.0));
  const int last = static_cast<int>(std::clamp(std::floor(high + 0.5), 0.0, count - 1.0));
  AxisWeights made{first, {}};
  for (int k = first; k <= last; ++k) {
    made.weights.push_back(std::max(0.0, std::min(high, k + 0.5) - std::max(low, k - 0.5)) / width);
  }
  return made;
}

bool is_mean(double width) { return width > 1.0 + 1e-9; }

// Linear interpolation, or its mean over an interval.
AxisWeights surface_weights(double coordinate, double width, int count) {
  if (is_mean(width)) {
    // Integral from minus infinity to t of the linear shape function, which is 1 at 0 and decreases to 0 at -1 and 1.
    const auto integral = [](double t) {
      const double s = std::clamp(t, -1.0, 1.0);
      return s < 0.0 ? 0.5 * (1.0 + s) * (1.0 + s) : 1.0 - 0.5 * (1.0 - s) * (1.0 - s);
    };
    const double low = coordinate - 0.5 * width, high = coordinate + 0.5 * width;
    AxisWeights result{std::clamp(static_cast<int>(std::floor(low)), 0, count - 1), {}};
    const int last = std::clamp(static_cast<int>(std::ceil(high)), 0, count - 1);
    for (int k = result.first; k <= last; ++k) {
      result.weights.push_back((integral(high - k) - integral(low - k)) / width);
    }
    return result;
  }
  const int first = std::clamp(static_cast<int>(std::floor(coordinate)), 0, std::max(count - 2, 0));
  const double fraction = coordinate - first;
  // A new point on an old one needs no neighbour, which may have no data.
  constexpr double rounding = 1e-9;
  if (fraction < rounding || count == 1) {
    return {first, {1.0}};
  }
  return fraction > 1.0 - rounding ? AxisWeights{first + 1, {1.0}} : AxisWeights{first, {1.0 - fraction, fraction}};
}

// Sums at each point of a layout, over old points with data: of weights times values, and of weights.
struct WeightedSums {
  Raster values, weights;
};

WeightedSums weighted_sums(const Raster& raster, const Raster& layout, const WeightsOfPoint& weights_of) {
  // For each new point along an axis, which is given by its first point, spacing and number.
  const auto along = [&](double first, double cell, int count, double new_first, double new_cell, int new_count) {
    std::vector<AxisWeights> all;
    for (int k = 0; k < new_count; ++k) {
      all.push_back(weights_of((new_first + k * new_cell - first) / cell, new_cell / cell, count));
    }
    return all;
  };
  const std::vector<AxisWeights> along_x =
      along(raster.x, raster.cell_x, raster.columns, layout.x, layout.cell_x, layout.columns);
  const std::vector<AxisWeights> along_y =
      along(raster.y, raster.cell_y, raster.rows, layout.y, layout.cell_y, layout.rows);
  const std::size_t columns = along_x.size();
  std::vector<double> row_values(columns * static_cast<std::size_t>(raster.rows));
  std::vector<double> row_weights = row_values;
  parallel_for(static_cast<std::size_t>(raster.rows), [&](std::size_t row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const AxisWeights& made = along_x[column];
      const double* old = raster.values.data() + raster.index(made.first, static_cast<int>(row));
      double value = 0.0, weight = 0.0;
      for (std::size_t k = 0; k < made.weights.size(); ++k) {
        if (!std::isnan(old[k])) {
          value += made.weights[k] * old[k];
          weight += made.weights[k];
        }
      }
      row_values[row * columns + column] = value;
      row_weights[row * columns + column] = weight;
    }
  });
  WeightedSums sums{layout.filled(0.0), layout.filled(0.0)};
  parallel_for(along_y.size(), [&](std::size_t row) {
    const AxisWeights& made = along_y[row];
    for (std::size_t column = 0; column < columns; ++column) {
      double value = 0.0, weight = 0.0;
      for (std::size_t k = 0; k < made.weights.size(); ++k) {
        const std::size_t from = (static_cast<std::size_t>(made.first) + k) * columns + column;
        value += made.weights[k] * row_values[from];
        weight += made.weights[k] * row_weights[from];
      }
      sums.values.values[row * columns + column] = value;
      sums.weights.values[row * columns + column] = weight;
    }
  });
  return sums;
}

// Value over weight if the weight exceeds `least`; otherwise NaN.
Raster means_of(WeightedSums sums, double least) {
  Raster& result = sums.values;
  for (std::size_t k = 0; k < result.values.size(); ++k) {
    const double weight = sums.weights.values[k];
    result.values[k] = weight > least ? result.values[k] / weight : no_data;
  }
  return std::move(result);
}

}  // namespace

Raster resampled_layout(const Raster& layout, double distance) {
  const auto along = [&](double first, double cell, int count, double& new_first, int& new_count) {
    const double margin = is_mean(distance / cell) ? 0.5 * distance : 0.0;
    const double available = (count - 1) * cell - 2.0 * margin;
    new_first = first + margin;
    new_count = available < 0.0 ? 0 : static_cast<int>(std::floor(available / distance + 1e-9)) + 1;
  };
  Raster result;
  result.cell_x = result.cell_y = distance;
  result.crs = layout.crs;
  along(layout.x, layout.cell_x, layout.columns, result.x, result.columns);
  along(layout.y, layout.cell_y, layout.rows, result.y, result.rows);
  return result;
}

Rectangle needed_for(const Raster& new_layout) {
  return Rectangle{new_layout.x, new_layout.y, new_layout.x_end(), new_layout.y_end()}.widened(0.5 * new_layout.cell_x,
                                                                                               0.5 * new_layout.cell_y);
}

Raster resampled(const Raster& raster, const Raster& new_layout) {
  const bool is_averaged = is_mean(new_layout.cell_x / raster.cell_x) || is_mean(new_layout.cell_y / raster.cell_y);
  return means_of(weighted_sums(raster, new_layout, surface_weights), is_averaged ? 0.5 : 1.0 - 1e-9);
}

bool is_finer(const Raster& raster, const Raster& layout) {
  return layout.cell_x > finer_by * raster.cell_x || layout.cell_y > finer_by * raster.cell_y;
}

Raster averaged(const Raster& raster, const Raster& layout, Missing missing) {
  WeightedSums sums = weighted_sums(raster, layout, overlaps);
  return missing == Missing::zero ? std::move(sums.values)
                                  : means_of(std::move(sums), missing == Missing::unknown ? 0.5 - 1e-9 : 1e-9);
}

CoveredRaster covered_part(const Raster& raster, const Polygons& polygons) {
  constexpr double half = 0.499999;  // of a cell, so that rounding moves no corner out of the outermost cells
  const Rectangle all = span_of_points(raster).widened(half * raster.cell_x, half * raster.cell_y);
  const Polygons inside = intersection_of(polygons, {box_polygon(all)});
  if (inside.empty()) {
    return {};
  }
  CoveredRaster part;
  part.values = part_of(raster, points_in(raster, extent_of(inside)));
  part.fraction = coverage_of(inside, part.values);
  return part;
}

CoveredMeans averaged(const CoveredRaster& part, const Raster& layout) {
  if (part.values.empty()) {
    return {layout.filled(0.0), layout.filled(no_data)};
  }
  Raster amount = part.values, known = part.fraction;
  for (std::size_t k = 0; k < amount.values.size(); ++k) {
    amount.values[k] *= part.fraction.values[k];
    known.values[k] = std::isnan(amount.values[k]) ? 0.0 : known.values[k];
  }
  CoveredMeans means{averaged(amount, layout, Missing::zero), averaged(part.values, layout, Missing::nothing)};
  const Raster weight = averaged(known, layout, Missing::zero);
  for (std::size_t k = 0; k < weight.values.size(); ++k) {
    if (weight.values[k] > 0.0) {  // otherwise a sliver that the parts of cells miss
      means.mean.values[k] = means.amount.values[k] / weight.values[k];
    }
  }
  return means;
}

Gradient gradient_at(const Raster& raster, int column, int row) {
  const double here = raster.at(column, row);
  const auto along = [&](int before_column, int before_row, int after_column, int after_row, double cell) {
    const auto known = [&](int i, int j) {
      return i >= 0 && j >= 0 && i < raster.columns && j < raster.rows && !std::isnan(raster.at(i, j));
    };
    const bool before = known(before_column, before_row), after = known(after_column, after_row);
    const double low = before ? raster.at(before_column, before_row) : here;
    const double high = after ? raster.at(after_column, after_row) : here;
    return before && after ? (high - low) / (2.0 * cell) : (high - low) / cell;
  };
  return {along(column - 1, row, column + 1, row, raster.cell_x),
          along(column, row - 1, column, row + 1, raster.cell_y)};
}

Raster sampled(const Raster& raster, const Raster& layout, Missing missing) {
  if (is_finer(raster, layout)) {
    return averaged(raster, layout, missing);
  }
  Raster result = layout.filled(no_data);
  for_each_point(result, [&](int column, int row, double& value) {
    value = bilinear(raster, layout.x_of(column), layout.y_of(row), missing);
  });
  return result;
}

Raster above_ground(const Raster& surface, const Raster& ground) {
  Raster above = sampled(ground, surface, Missing::unknown);
  for (std::size_t k = 0; k < above.values.size(); ++k) {
    above.values[k] = surface.values[k] - above.values[k];
  }
  return above;
}

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
