#include "gis/sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "gis/filters.hpp"
#include "gis/point_window.hpp"
#include "gis/polygons.hpp"
#include "gis/reference_system.hpp"
#include "gis/reprojection.hpp"

namespace thawslide::gis {

namespace {

constexpr double finer_by = 1.01;
constexpr double no_data = std::numeric_limits<double>::quiet_NaN();

// Fractions of the interval around a position in the cells of old points; positions in units of their spacing. Parts
// outside the outermost cells are omitted.
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

// Linear interpolation that omits points beyond the outermost ones.
AxisWeights between_points(double coordinate, int count) {
  const double below = std::floor(coordinate), fraction = coordinate - below;
  AxisWeights made;
  for (const auto& [point, weight] : {std::pair(below, 1.0 - fraction), std::pair(below + 1.0, fraction)}) {
    if (point >= 0.0 && point < count) {
      made.first = made.weights.empty() ? static_cast<int>(point) : made.first;
      made.weights.push_back(weight);
    }
  }
  return made;
}

WeightedSums sums_in_one_system(const Raster& raster, const Raster& layout) {
  return weighted_sums(raster, layout, [](double coordinate, double width, int count) {
    return width > finer_by ? overlaps(coordinate, width, count) : between_points(coordinate, count);
  });
}

// Transforms points of a layout's row to the reference system of a raster.
void transform_points(const Reprojection& reprojection, const Raster& raster, const Raster& layout, int row,
                      std::vector<double>& x, std::vector<double>& y) {
  if (!reprojection.apply(x, y)) {
    throw UserError(
        "points of the ground near {}, {} cannot be transformed to the coordinate reference system {}. Reproject the "
        "raster to {}.",
        coordinate_text(layout.x), coordinate_text(layout.y_of(row)), name_of(raster.crs), name_of(layout.crs));
  }
}

// value_at(x, y), in the coordinates of a raster, at the points of a layout.
template <class ValueAt>
Raster values_at_points(const Raster& raster, const Raster& layout, const ValueAt& value_at) {
  const Reprojection reprojection(layout.crs, raster.crs);
  Raster result = layout.filled(no_data);
  const auto columns = static_cast<std::size_t>(layout.columns);
  for (int row = 0; row < layout.rows; ++row) {
    std::vector<double> x(columns), y(columns, layout.y_of(row));
    for (int column = 0; column < layout.columns; ++column) {
      x[static_cast<std::size_t>(column)] = layout.x_of(column);
    }
    transform_points(reprojection, raster, layout, row, x, y);
    for (std::size_t k = 0; k < columns; ++k) {
      result.values[result.index(static_cast<int>(k), row)] = value_at(x[k], y[k]);
    }
  }
  return result;
}

using Point = std::array<double, 2>;

// Corners of the cells of a layout's row, on its lower (0) or upper (1) side, in columns and rows of a raster.
std::vector<Point> corners_of(const Reprojection& reprojection, const Raster& raster, const Raster& layout, int row,
                              int side) {
  const auto count = static_cast<std::size_t>(layout.columns) + 1;
  std::vector<double> x(count), y(count, layout.y_of(row) + (side - 0.5) * layout.cell_y);
  for (std::size_t k = 0; k < count; ++k) {
    x[k] = layout.x + (static_cast<double>(k) - 0.5) * layout.cell_x;
  }
  transform_points(reprojection, raster, layout, row, x, y);
  std::vector<Point> corners(count);
  for (std::size_t k = 0; k < count; ++k) {
    corners[k] = {(x[k] - raster.x) / raster.cell_x, (y[k] - raster.y) / raster.cell_y};
  }
  return corners;
}

double distance(const Point& one, const Point& other) {
  return std::max(std::abs(one[0] - other[0]), std::abs(one[1] - other[1]));
}

// Three parts for each of the raster's cells along a side. A nearly whole number of parts per cell avoids aliasing with
// the pattern of the cells.
int parts_of(double side) {
  constexpr double parts_per_cell = 3.0, most_parts = 255.0;
  return static_cast<int>(std::clamp(parts_per_cell * std::round(side), 1.0, most_parts));
}

// Sums over the parts of the cell between four corners: lower left, lower right, upper left, upper right.
std::array<double, 2> sum_over_parts(const Raster& raster, const std::array<Point, 4>& corners) {
  const int across = parts_of(distance(corners[0], corners[1])), up = parts_of(distance(corners[0], corners[2]));
  double value = 0.0, weight = 0.0;
  for (int j = 0; j < up; ++j) {
    for (int i = 0; i < across; ++i) {
      const double s = (i + 0.5) / across, t = (j + 0.5) / up;
      Point point;
      for (std::size_t a = 0; a < 2; ++a) {
        point[a] = std::floor(0.5 + (1.0 - t) * ((1.0 - s) * corners[0][a] + s * corners[1][a]) +
                              t * ((1.0 - s) * corners[2][a] + s * corners[3][a]));
      }
      const bool inside = point[0] >= 0.0 && point[1] >= 0.0 && point[0] < raster.columns && point[1] < raster.rows;
      const double there = inside ? raster.at(static_cast<int>(point[0]), static_cast<int>(point[1])) : no_data;
      if (!std::isnan(there)) {
        value += there;
        weight += 1.0;
      }
    }
  }
  const double parts = static_cast<double>(across) * up;
  return {value / parts, weight / parts};
}

WeightedSums sums_between_systems(const Reprojection& reprojection, const Raster& raster, const Raster& layout) {
  WeightedSums sums{layout.filled(0.0), layout.filled(0.0)};
  for (int row = 0; row < layout.rows; ++row) {
    const std::vector<Point> lower = corners_of(reprojection, raster, layout, row, 0);
    const std::vector<Point> upper = corners_of(reprojection, raster, layout, row, 1);
    parallel_for(static_cast<std::size_t>(layout.columns), [&](std::size_t column) {
      const std::size_t k = layout.index(static_cast<int>(column), row);
      const auto [value, weight] =
          sum_over_parts(raster, {lower[column], lower[column + 1], upper[column], upper[column + 1]});
      sums.values.values[k] = value;
      sums.weights.values[k] = weight;
    });
  }
  return sums;
}

// Sums over the area of each new cell.
WeightedSums sums_over_cells(const Raster& raster, const Raster& layout) {
  const Reprojection reprojection(layout.crs, raster.crs);
  return reprojection.changes_nothing() ? sums_in_one_system(raster, layout)
                                        : sums_between_systems(reprojection, raster, layout);
}

Polygons in_system(const Polygons& polygons, const Reprojection& reprojection, const std::string& name) {
  Polygons transformed = polygons;
  const auto transform = [&](Polyline2& ring) {
    std::vector<double> x, y;
    for (const auto& corner : ring) {
      x.push_back(corner[0]);
      y.push_back(corner[1]);
    }
    if (!reprojection.apply(x, y)) {
      throw UserError(
          "the release cannot be transformed to the coordinate reference system {} of the raster. Reproject the raster "
          "to the system of the DEM.",
          name);
    }
    for (std::size_t k = 0; k < ring.size(); ++k) {
      ring[k] = {x[k], y[k]};
    }
  };
  for (Polygon& polygon : transformed) {
    transform(polygon.outline);
    std::ranges::for_each(polygon.holes, transform);
  }
  return transformed;
}

}  // namespace

bool is_finer(const Raster& raster, const Raster& layout) {
  const Reprojection reprojection(layout.crs, raster.crs);
  if (reprojection.changes_nothing()) {
    return layout.cell_x > finer_by * raster.cell_x || layout.cell_y > finer_by * raster.cell_y;
  }
  const Raster middle = layout_of(layout, {layout.columns / 2, layout.rows / 2, 1, 1});
  const std::vector<Point> lower = corners_of(reprojection, raster, middle, 0, 0);
  const std::vector<Point> upper = corners_of(reprojection, raster, middle, 0, 1);
  return distance(lower[0], lower[1]) > finer_by || distance(lower[0], upper[0]) > finer_by;
}

Raster averaged(const Raster& raster, const Raster& layout, Missing missing) {
  WeightedSums sums = sums_over_cells(raster, layout);
  return missing == Missing::zero ? std::move(sums.values)
                                  : means_of(std::move(sums), missing == Missing::unknown ? 0.5 - 1e-9 : 1e-9);
}

CoveredRaster covered_part(const Raster& raster, const Polygons& polygons, const std::string& crs) {
  const Polygons there = in_system(polygons, Reprojection(crs, raster.crs), name_of(raster.crs));
  constexpr double half = 0.499999;  // of a cell, so that rounding moves no corner out of the outermost cells
  const Rectangle all = span_of_points(raster).widened(half * raster.cell_x, half * raster.cell_y);
  const Polygons inside = intersection_of(there, {box_polygon(all)});
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
  return is_finer(raster, layout)
             ? averaged(raster, layout, missing)
             : values_at_points(raster, layout, [&](double x, double y) { return bilinear(raster, x, y, missing); });
}

Raster nearest(const Raster& raster, const Raster& layout) {
  return values_at_points(raster, layout, [&](double x, double y) {
    const double i = std::floor((x - raster.x) / raster.cell_x + 0.5);
    const double j = std::floor((y - raster.y) / raster.cell_y + 0.5);
    const bool is_inside = i >= 0.0 && j >= 0.0 && i < raster.columns && j < raster.rows;
    return is_inside ? raster.at(static_cast<int>(i), static_cast<int>(j)) : no_data;
  });
}

Raster above_ground(const Raster& surface, const Raster& ground) {
  Raster above = sampled(ground, surface, Missing::unknown);
  for (std::size_t k = 0; k < above.values.size(); ++k) {
    above.values[k] = surface.values[k] - above.values[k];
  }
  return above;
}

}  // namespace thawslide::gis
