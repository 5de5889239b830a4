#include "terrain/height_field.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/nearest_known.hpp"
#include "terrain/convex_polygon.hpp"
#include "terrain/nearest_on_triangle.hpp"
#include "terrain/surface_integrals.hpp"
#include "terrain/triangle_rule.hpp"

namespace thawslide::terrain {

namespace {

constexpr int block = 16;  // points along each axis of a block with a common summary
// In cells: tolerance for positions at a point.
constexpr double round_off = 1e-9;

int blocks_of(int points) { return (points + block - 1) / block; }

// Column or row of cells at `offset` cells from the first point, from -1 to points - 1.
int cell_number(double offset, int points) {
  return static_cast<int>(std::max(-1.0, std::min(std::floor(offset), points - 1.0)));
}

}  // namespace

void HeightField::Summary::add(const Summary& other) {
  lowest = std::min(lowest, other.lowest);
  highest = std::max(highest, other.highest);
  known = known && other.known;
}

HeightField::HeightField(Raster points) : points_(std::move(points)) {
  THAWSLIDE_ASSERT(points_.columns >= 2 && points_.rows >= 2, "{} x {} points", points_.columns, points_.rows);
  THAWSLIDE_ASSERT(points_.cell_x > 0.0 && points_.cell_y > 0.0, "cells of {} x {}", points_.cell_x, points_.cell_y);
  const std::size_t size = points_.index(0, points_.rows);
  THAWSLIDE_ASSERT(points_.values.size() == size, "{} values for {} points", points_.values.size(), size);
  if (std::any_of(points_.values.begin(), points_.values.end(), [](double value) { return std::isnan(value); })) {
    no_data_.resize(size);
    std::transform(points_.values.begin(), points_.values.end(), no_data_.begin(),
                   [](double value) { return std::isnan(value); });
    fill_from_nearest_known(points_);
  }
  summarize_blocks();
}

void HeightField::summarize_blocks() {
  for (int row = 0; row < points_.rows; row += block) {
    for (int column = 0; column < points_.columns; column += block) {
      block_summary_.push_back(summary_one_by_one({column, std::min(column + block, points_.columns) - 1},
                                                  {row, std::min(row + block, points_.rows) - 1}));
    }
  }
}

HeightField::Summary HeightField::summary_one_by_one(Span columns, Span rows) const {
  Summary summary;
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      const std::size_t k = points_.index(column, row);
      summary.add({points_.values[k], points_.values[k], no_data_.empty() || !no_data_[k]});
    }
  }
  return summary;
}

HeightField::Summary HeightField::summary_of_points(Span columns, Span rows) const {
  Summary summary;
  for (int j = rows.first / block; j <= rows.last / block; ++j) {
    for (int i = columns.first / block; i <= columns.last / block; ++i) {
      const Span all_columns{i * block, std::min((i + 1) * block, points_.columns) - 1};
      const Span all_rows{j * block, std::min((j + 1) * block, points_.rows) - 1};
      const Span in_columns{std::max(all_columns.first, columns.first), std::min(all_columns.last, columns.last)};
      const Span in_rows{std::max(all_rows.first, rows.first), std::min(all_rows.last, rows.last)};
      const bool whole = in_columns.first == all_columns.first && in_columns.last == all_columns.last &&
                         in_rows.first == all_rows.first && in_rows.last == all_rows.last;
      summary.add(whole ? block_summary_[static_cast<std::size_t>(j * blocks_of(points_.columns) + i)]
                        : summary_one_by_one(in_columns, in_rows));
    }
  }
  return summary;
}

HeightField::Summary HeightField::summary(const Point& from, const Point& to) const {
  const auto points = [](Span cells, int count) {
    return Span{std::max(cells.first, 0), std::min(cells.last + 1, count - 1)};
  };
  return summary_of_points(points(cell_columns(from[0], to[0]), points_.columns),
                           points(cell_rows(from[1], to[1]), points_.rows));
}

HeightField::Span HeightField::cell_columns(double from, double to) const {
  return {cell_number((from - points_.x) / points_.cell_x, points_.columns),
          cell_number((to - points_.x) / points_.cell_x, points_.columns)};
}

HeightField::Span HeightField::cell_rows(double from, double to) const {
  return {cell_number((from - points_.y) / points_.cell_y, points_.rows),
          cell_number((to - points_.y) / points_.cell_y, points_.rows)};
}

double HeightField::height_at(int column, int row) const {
  return points_.at(std::clamp(column, 0, points_.columns - 1), std::clamp(row, 0, points_.rows - 1));
}

HeightField::Cell HeightField::cell(int column, int row, const Point& from, const Point& to) const {
  const double west = column < 0 ? std::min(from[0], points_.x - points_.cell_x) : points_.x_of(column);
  const double east =
      column + 1 < points_.columns ? points_.x_of(column + 1) : std::max(to[0], points_.x_end() + points_.cell_x);
  const double south = row < 0 ? std::min(from[1], points_.y - points_.cell_y) : points_.y_of(row);
  const double north =
      row + 1 < points_.rows ? points_.y_of(row + 1) : std::max(to[1], points_.y_end() + points_.cell_y);
  Cell cell;
  cell.point = {Vector<double, 3>(west, south, height_at(column, row)),
                Vector<double, 3>(east, south, height_at(column + 1, row)),
                Vector<double, 3>(east, north, height_at(column + 1, row + 1)),
                Vector<double, 3>(west, north, height_at(column, row + 1))};
  cell.centre = 0.25 * ((cell.point[0] + cell.point[2]) + (cell.point[1] + cell.point[3]));
  return cell;
}

HeightField::Cell HeightField::cell_at(const Point& point) const {
  return cell(cell_columns(point[0], point[0]).first, cell_rows(point[1], point[1]).first, point, point);
}

// Calls visit(cell, k) for the triangles of all cells that overlap a rectangle.
template <class Visit>
void HeightField::for_triangles(const Point& from, const Point& to, const Visit& visit) const {
  const Span columns = cell_columns(from[0], to[0]), rows = cell_rows(from[1], to[1]);
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      const Cell there = cell(column, row, from, to);
      for (std::size_t k = 0; k < 4; ++k) {
        visit(there, k);
      }
    }
  }
}

std::size_t HeightField::Cell::triangle_at(const Point& position) const {
  const double x = (position[0] - centre[0]) / (point[2][0] - point[0][0]);
  const double y = (position[1] - centre[1]) / (point[2][1] - point[0][1]);
  if (std::abs(x) > std::abs(y)) {
    return x > 0.0 ? 1 : 3;
  }
  return y > 0.0 ? 2 : 0;
}

HeightField::Point HeightField::Cell::gradient(std::size_t k) const {
  const Vector<double, 3>&a = point[k], &b = point[(k + 1) % 4];
  const int along = k % 2 == 0 ? 0 : 1;  // axis of the outer edge
  const int across = 1 - along;
  Point gradient;
  gradient[along] = (b[2] - a[2]) / (b[along] - a[along]);
  gradient[across] = (centre[2] - 0.5 * (a[2] + b[2])) / (centre[across] - a[across]);
  return gradient;
}

HeightField::Point HeightField::gradient(const Point& point, double width) const {
  if (width <= 0.0) {
    const Cell cell = cell_at(point);
    return cell.gradient(cell.triangle_at(point));
  }
  const Point from = point.array() - 0.5 * width, to = point.array() + 0.5 * width;
  Point sum = Point::Zero();
  for_triangles(from, to, [&](const Cell& cell, std::size_t k) {
    sum += ConvexPolygon(cell.triangle(k)).over(from, to).plan_area() * cell.gradient(k);
  });
  return sum / (width * width);
}

double HeightField::height(const Point& point) const {
  const Cell cell = cell_at(point);
  return cell.centre[2] + cell.gradient(cell.triangle_at(point)).dot(point - cell.centre.head<2>());
}

HeightField::ColumnMeans HeightField::column_means(const Point& at, double cell_size) const {
  const Point from = at.array() - cell_size, to = at.array() + cell_size;
  const auto hat = [&](const Vector<double, 3>& point) {
    return (1.0 - std::abs(point[0] - at[0]) / cell_size) * (1.0 - std::abs(point[1] - at[1]) / cell_size);
  };
  double weights = 0.0;
  ColumnMeans means{0.0, 0.0};
  for_triangles(from, to, [&](const Cell& there, std::size_t k) {
    const ConvexPolygon in_reach = ConvexPolygon(there.triangle(k)).over(from, to);
    const double stretch = std::hypot(1.0, there.gradient(k).norm());
    ConvexPolygon half[2], quarter[2];
    in_reach.split(0, at[0], half[0], half[1]);
    for (const ConvexPolygon& side : half) {
      side.split(1, at[1], quarter[0], quarter[1]);
      for (const ConvexPolygon& part : quarter) {
        for (int corner = 1; corner + 1 < part.size(); ++corner) {
          const Vector<double, 3>&a = part[0], &b = part[corner], &c = part[corner + 1];
          const double plan = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
          for (const auto& [weight, twice] : triangle_rule) {
            for (const Vector<double, 3>* once : {&a, &b, &c}) {
              const Vector<double, 3> point = twice * (a + b + c) + (1.0 - 3.0 * twice) * *once;
              const double of_hat = weight * plan * hat(point);
              weights += of_hat;
              means.height += of_hat * point[2];
              means.area += of_hat * stretch;
            }
          }
        }
      }
    }
  });
  return {means.height / weights, means.area / weights};
}

// Gradients of triangles are means of the rises along the sides of their cell.
double HeightField::steepest(const Point& from, const Point& to) const {
  const Span columns = cell_columns(from[0], to[0]), rows = cell_rows(from[1], to[1]);
  double found = 0.0;
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      const double south_west = height_at(column, row), south_east = height_at(column + 1, row),
                   north_west = height_at(column, row + 1), north_east = height_at(column + 1, row + 1);
      const double along_x = std::max(std::abs(south_east - south_west), std::abs(north_east - north_west)),
                   along_y = std::max(std::abs(north_west - south_west), std::abs(north_east - south_east));
      found = std::max(found, std::hypot(along_x / points_.cell_x, along_y / points_.cell_y));
    }
  }
  return found;
}

double HeightField::highest(const Point& from, const Point& to) const {
  // Beyond the outermost points, the ground is as high as at the edge.
  const Point least(points_.x, points_.y), greatest(points_.x_end(), points_.y_end());
  const Point low = from.cwiseMax(least).cwiseMin(greatest), high = to.cwiseMax(least).cwiseMin(greatest);
  const Span columns = cell_columns(low[0], high[0]), rows = cell_rows(low[1], high[1]);
  double top = -HUGE_VAL;
  if (columns.first < columns.last && rows.first < rows.last) {
    top = summary_of_points({columns.first + 1, columns.last}, {rows.first + 1, rows.last}).highest;
  }
  const auto examine = [&](int column, int row) {
    if (std::max({height_at(column, row), height_at(column + 1, row), height_at(column, row + 1),
                  height_at(column + 1, row + 1)}) <= top) {
      return;
    }
    const Cell there = cell(column, row, low, high);
    for (std::size_t k = 0; k < 4; ++k) {
      top = std::max(top, ConvexPolygon(there.triangle(k)).over(low, high).extent(2).greatest);
    }
  };
  for (int row = rows.first; row <= rows.last; ++row) {
    const bool whole_row = row == rows.first || row == rows.last;
    for (int column = columns.first; column <= columns.last;
         column += whole_row ? 1 : std::max(1, columns.last - columns.first)) {
      examine(column, row);
    }
  }
  return top;
}

bool HeightField::is_known(const Point& point) const { return is_known(point, point); }

bool HeightField::is_known(const Point& from, const Point& to) const {
  const Point cells(points_.cell_x, points_.cell_y);
  const Point margin = round_off * cells;
  const Point least(points_.x, points_.y), greatest(points_.x_end(), points_.y_end());
  if ((from.array() < (least - margin).array()).any() || (to.array() > (greatest + margin).array()).any()) {
    return false;
  }
  // Cells that only touch the rectangle do not count.
  const Point low = (from + margin).cwiseMin(greatest - margin);
  return summary(low, (to - margin).cwiseMax(low)).known;
}

void HeightField::at_block(const NodeIndex& first, double cell_size, int edge, GroundAtNode<3>* nodes) const {
  at_nodes_from(cell_size * Vector<double, 3>(first[0], first[1], first[2]), cell_size, edge, nodes);
}

void HeightField::at_nodes_from(const Vector<double, 3>& lowest, double cell_size, int edge,
                                GroundAtNode<3>* nodes) const {
  const Point from = lowest.head<2>().array() - cell_size;
  const Point to = lowest.head<2>().array() + edge * cell_size;
  const Summary below = summary(from, to);
  SurfaceIntegrals integrals(lowest, cell_size, edge, nodes);
  if (below.highest <= lowest[2] - cell_size) {
    integrals.finish_in_space();
  } else if (below.lowest >= lowest[2] + edge * cell_size) {
    integrals.finish_in_ground();
  } else {
    for_triangles(from, to, [&](const Cell& there, std::size_t k) { integrals.add(there.triangle(k)); });
    integrals.finish();
  }
  set_distances(lowest, cell_size, edge, nodes);
}

void HeightField::set_distances(const Vector<double, 3>& lowest, double cell_size, int edge,
                                GroundAtNode<3>* nodes) const {
  const double reach = reach_in_cells * cell_size;
  const double width = (edge - 1) * cell_size;
  const Summary about = summary(lowest.head<2>().array() - reach, lowest.head<2>().array() + width + reach);
  const bool any_near = about.highest > lowest[2] - reach && about.lowest < lowest[2] + width + reach;
  for (int k = 0; k < edge * edge * edge; ++k) {
    GroundAtNode<3>& node = nodes[k];
    const int column = k % edge, row = k / edge % edge, layer = k / (edge * edge);
    const Vector<double, 3> position = lowest + cell_size * Vector<double, 3>(column, row, layer);
    const Point point = position.head<2>();
    const double sign = position[2] >= height(point) ? 1.0 : -1.0;
    const auto foot = any_near ? nearest(position, reach) : std::nullopt;
    const double distance = foot ? (*foot - position).norm() : reach;
    node.distance = sign * distance;
    if (node.normal.isZero(0.0)) {
      node.normal = foot && distance > round_off * cell_size ? Vector<double, 3>(sign * (*foot - position) / distance)
                                                             : normal_below(point, 0.0);
      node.plane = position.dot(node.normal) + node.distance;
    }
    if (!node.candidate) {
      node.plane = HUGE_VAL;
    }
  }
}

std::optional<Vector<double, 3>> HeightField::nearest(const Vector<double, 3>& position, double reach) const {
  const Point point = position.head<2>();
  const Point from = point.array() - reach, to = point.array() + reach;
  std::optional<Vector<double, 3>> nearest;
  double least = reach * reach;
  const auto examine = [&](int column, int row) {
    if (squared_distance_of_cell(position, column, row) >= least) {
      return;
    }
    const Cell there = cell(column, row, from, to);
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector<double, 3> candidate = nearest_on_triangle(position, there.triangle(k));
      const double squared = (candidate - position).squaredNorm();
      if (squared < least) {
        least = squared;
        nearest = candidate;
      }
    }
  };
  // Starts at the foot on the plane of the triangle below, because nearly all other cells are then known to be too far.
  const Point slope = gradient(point, 0.0);
  const Point foot = point + slope * ((position[2] - height(point)) / (1.0 + slope.squaredNorm()));
  examine(cell_columns(foot[0], foot[0]).first, cell_rows(foot[1], foot[1]).first);
  const double rest = std::sqrt(least);
  const Span columns = cell_columns(point[0] - rest, point[0] + rest);
  const Span rows = cell_rows(point[1] - rest, point[1] + rest);
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      examine(column, row);
    }
  }
  return nearest;
}

double HeightField::squared_distance_of_cell(const Vector<double, 3>& position, int column, int row) const {
  const auto gap = [](double offset, int cell, int points) {  // distance from a cell along an axis, in cells
    return std::max({0.0, cell < 0 ? 0.0 : cell - offset, cell + 1 < points ? offset - (cell + 1) : 0.0});
  };
  const double x = points_.cell_x * gap((position[0] - points_.x) / points_.cell_x, column, points_.columns);
  const double y = points_.cell_y * gap((position[1] - points_.y) / points_.cell_y, row, points_.rows);
  const auto [low, high] = std::minmax(
      {height_at(column, row), height_at(column + 1, row), height_at(column, row + 1), height_at(column + 1, row + 1)});
  const double z = std::max({0.0, low - position[2], position[2] - high});
  return x * x + y * y + z * z;
}

}  // namespace thawslide::terrain
