#include "terrain/height_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "base/raster.hpp"
#include "terrain/convex_polygon.hpp"

namespace thawslide::terrain {

namespace {

// Six-point rule on triangles, exact to the fourth degree: Dunavant (1985), Int. J. Numer. Meth. Eng. 21, table II.
// Each point has two equal barycentric coordinates.
struct RulePoint {
  double weight, twice;
};
constexpr std::array<RulePoint, 2> triangle_rule{RulePoint{0.22338158967801146570, 0.44594849091596488632},
                                                 RulePoint{0.10995174365532186764, 0.09157621350977074346}};

// In cells: tolerance for positions at a point.
constexpr double round_off = 1e-9;

// Column or row of cells at `offset` cells from the first point, from -1 to points - 1.
int cell_number(double offset, int points) {
  return static_cast<int>(std::max(-1.0, std::min(std::floor(offset), points - 1.0)));
}

}  // namespace

HeightField::HeightField(Raster points) : points_(std::move(points)) {
  THAWSLIDE_ASSERT(points_.columns >= 2 && points_.rows >= 2, "{} x {} points", points_.columns, points_.rows);
  THAWSLIDE_ASSERT(points_.cell_x > 0.0 && points_.cell_y > 0.0, "cells of {} x {}", points_.cell_x, points_.cell_y);
  const std::size_t size = points_.index(0, points_.rows);
  THAWSLIDE_ASSERT(points_.values.size() == size, "{} values for {} points", points_.values.size(), size);
  if (std::none_of(points_.values.begin(), points_.values.end(), [](double value) { return std::isnan(value); })) {
    return;
  }
  const int width = points_.columns + 1;
  no_data_before_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(points_.rows + 1));
  for (int row = 0; row < points_.rows; ++row) {
    int in_row = 0;
    for (int column = 0; column < points_.columns; ++column) {
      in_row += std::isnan(points_.at(column, row)) ? 1 : 0;
      no_data_before_[static_cast<std::size_t>((row + 1) * width + column + 1)] =
          no_data_before(column + 1, row) + in_row;
    }
  }
  fill_from_nearest_known(points_);
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

int HeightField::no_data_before(int column, int row) const {
  return no_data_before_[static_cast<std::size_t>(row * (points_.columns + 1) + column)];
}

bool HeightField::is_known(const Point& point) const { return is_known(point, point); }

bool HeightField::is_known(const Point& from, const Point& to) const {
  const Point cells(points_.cell_x, points_.cell_y);
  const Point margin = round_off * cells;
  const Point least(points_.x, points_.y), greatest(points_.x_end(), points_.y_end());
  if ((from.array() < (least - margin).array()).any() || (to.array() > (greatest + margin).array()).any()) {
    return false;
  }
  if (no_data_before_.empty()) {
    return true;
  }
  // Cells that only touch the rectangle do not count.
  const Point low = (from + margin).cwiseMin(greatest - margin), high = (to - margin).cwiseMax(low);
  const Span columns = cell_columns(low[0], high[0]), rows = cell_rows(low[1], high[1]);
  const int west = std::max(columns.first, 0), east = std::min(columns.last + 2, points_.columns);
  const int south = std::max(rows.first, 0), north = std::min(rows.last + 2, points_.rows);
  return no_data_before(east, north) - no_data_before(west, north) ==
         no_data_before(east, south) - no_data_before(west, south);
}

}  // namespace thawslide::terrain
