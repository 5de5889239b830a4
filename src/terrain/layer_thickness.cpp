#include "terrain/layer_thickness.hpp"

#include <algorithm>
#include <cmath>

#include "terrain/between_middles.hpp"

namespace thawslide::terrain {

namespace {

constexpr int reach = 4;  // columns on each side in the average

template <class Number>
std::uint64_t key_of(const Number& number) {
  constexpr long origin = 1L << 31;  // offset that gives columns outside the domain a key too
  std::uint64_t key = 0;
  for (std::size_t a = 0; a < number.size(); ++a) {
    key |= static_cast<std::uint64_t>(number[a] + origin) << (32 * a);
  }
  return key;
}

// Calls visit(offsets) with first .. last along each axis, the first axis fastest.
template <std::size_t Axes, class Visit>
void for_offsets(long first, long last, const Visit& visit) {
  std::array<long, Axes> offset;
  offset.fill(first);
  while (true) {
    visit(offset);
    std::size_t a = 0;
    while (a < Axes && ++offset[a] > last) {
      offset[a++] = first;
    }
    if (a == Axes) {
      return;
    }
  }
}

}  // namespace

template <int Dim>
LayerThickness<Dim>::LayerThickness(std::shared_ptr<const Surface<Dim>> ground, double cell, double spacing,
                                    Filling filling)
    : ground_(std::move(ground)), cell_(cell), spacing_(spacing), filling_(filling) {}

template <int Dim>
typename LayerThickness<Dim>::Column LayerThickness<Dim>::make_column(const Number& number) const {
  Point corner;
  for (int a = 0; a + 1 < Dim; ++a) {
    corner[a] = static_cast<double>(number[static_cast<std::size_t>(a)]) * cell_;
  }
  // The corners of the column's cells are candidates if their linear shape functions, one cell wide on each side,
  // overlap the ground.
  const double highest = ground_->highest(corner - Point::Constant(cell_), corner + Point::Constant(2.0 * cell_));
  const double highest_corner = std::ceil(highest / cell_ + 1.0 - round_off) - 1.0;
  const double top = (highest_corner + 1.0) * cell_;
  const double footprint = std::pow(spacing_, Dim - 1);
  Column column{0.0, 0.0};
  for_offsets<Dim - 1>(0, std::lround(cell_ / spacing_) - 1, [&](const Number& part) {
    Point point = corner;
    for (int a = 0; a + 1 < Dim; ++a) {
      point[a] += (static_cast<double>(part[static_cast<std::size_t>(a)]) + 0.5) * spacing_;
    }
    const double height = ground_->height(point);
    const double bottom = filling_ == Filling::on_ground
                              ? height
                              : std::ceil(height / spacing_ - 0.5 - round_off) * spacing_;  // of the lowest particle
    column.filled += (top - bottom) * footprint;
    column.ground += std::hypot(1.0, ground_->gradient(point, spacing_).norm()) * footprint;
  });
  return column;
}

template <int Dim>
typename LayerThickness<Dim>::Column LayerThickness<Dim>::column(const Number& number) {
  const auto k = static_cast<std::size_t>(column_index_.insert(key_of(number)));
  if (k == columns_.size()) {
    columns_.push_back(make_column(number));
  }
  return columns_[k];
}

template <int Dim>
double LayerThickness<Dim>::at_middle(const Number& number) {
  const auto k = static_cast<std::size_t>(middle_index_.insert(key_of(number)));
  if (k == at_middle_.size()) {
    double filled = 0.0, ground = 0.0;
    for_offsets<Dim - 1>(-reach, reach, [&](const Number& offset) {
      double weight = 1.0;
      Number adjacent = number;
      for (std::size_t a = 0; a + 1 < Dim; ++a) {
        weight *= static_cast<double>(reach + 1 - std::abs(offset[a]));
        adjacent[a] += offset[a];
      }
      const Column there = column(adjacent);
      filled += weight * there.filled;
      ground += weight * there.ground;
    });
    at_middle_.push_back(filled / ground);
  }
  return at_middle_[k];
}

template <int Dim>
double LayerThickness<Dim>::at(const Point& point) {
  Number left;
  std::array<double, Dim - 1> fraction;
  for (std::size_t a = 0; a < left.size(); ++a) {
    const double in_columns = point[static_cast<int>(a)] / cell_ + 0.5;  // 1 in the middle of column 0
    left[a] = static_cast<long>(std::floor(in_columns)) - 1;
    fraction[a] = in_columns - std::floor(in_columns);
  }
  return between_middles(fraction, [&](const std::array<int, Dim - 1>& steps) {
    Number number = left;
    for (std::size_t a = 0; a < number.size(); ++a) {
      number[a] += steps[a];
    }
    return at_middle(number);
  });
}

template <int Dim>
double LayerThickness<Dim>::largest(const Point& from, const Point& to) {
  Number first, count;
  long total = 1;
  for (int a = 0; a + 1 < Dim; ++a) {
    const auto k = static_cast<std::size_t>(a);
    first[k] = static_cast<long>(std::floor(from[a] / cell_)) - 1;
    count[k] = static_cast<long>(std::ceil(to[a] / cell_)) + 1 - first[k];
    total *= count[k];
  }
  double largest = 0.0;
  for (long k = 0; k < total; ++k) {
    Number number = first;
    long rest = k;
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      number[a] += rest % count[a];
      rest /= count[a];
    }
    largest = std::max(largest, at_middle(number));
  }
  return largest;
}

template class LayerThickness<2>;
template class LayerThickness<3>;

}  // namespace thawslide::terrain
