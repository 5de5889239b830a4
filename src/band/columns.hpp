// Columns of grid cells filled by the sliding mass (band/flow_depth.hpp): keys, contributions of particles, and
// results. For host and device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

#include "base/linear.hpp"
#include "base/select.hpp"
#include "mpm/tile.hpp"

namespace thawslide::band {

// Particles of a tile extend from the cell below its first node to the cell above its last one. A box that ends there
// also evaluates one more cell, with a fraction of 0.
template <int Dim>
inline constexpr int columns_per_axis = mpm::Tile<Dim>::edge + 2;
template <int Dim>
inline constexpr auto columns_per_tile = static_cast<std::size_t>(mpm::power(columns_per_axis<Dim>, Dim - 1));

// Column numbers are offset by this number to avoid a carry from one axis into the next.
inline constexpr std::int64_t column_origin = std::int64_t{1} << 31;

// Number of the first cell, along each horizontal axis, that particles of a tile may overlap.
template <int Dim>
THAWSLIDE_HD std::array<int, Dim - 1> first_cell_of(std::uint64_t tile_key) {
  const auto tile = mpm::Tile<Dim>::index(tile_key);
  std::array<int, Dim - 1> first{};
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    first[a] = tile[a] * mpm::Tile<Dim>::edge - 1;
  }
  return first;
}

// Key of the column at a place in a tile.
template <int Dim>
THAWSLIDE_HD std::uint64_t column_key(std::uint64_t tile_key, std::size_t index) {
  const auto first = first_cell_of<Dim>(tile_key);
  std::uint64_t key = 0;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    const int along = first[a] + static_cast<int>(index % static_cast<std::size_t>(columns_per_axis<Dim>));
    index /= static_cast<std::size_t>(columns_per_axis<Dim>);
    key |= static_cast<std::uint64_t>(column_origin + along) << (32 * a);
  }
  return key;
}

// Adjacent column on a side. Each axis has two sides, the lower one first.
template <int Dim>
inline constexpr std::size_t column_sides = 2 * (static_cast<std::size_t>(Dim) - 1);
THAWSLIDE_HD inline std::uint64_t neighbour_column(std::uint64_t key, std::size_t side) {
  const std::uint64_t step = std::uint64_t{1} << (32 * (side / 2));
  return side % 2 == 0 ? key - step : key + step;
}

// Function of a horizontal position [m].
template <int Dim>
using OfPosition = std::function<double(const Vector<double, Dim - 1>&)>;

template <int Dim>
Vector<double, Dim - 1> middle_of_column(std::uint64_t key, double cell) {
  Vector<double, Dim - 1> middle;
  for (int a = 0; a + 1 < Dim; ++a) {
    const auto number = static_cast<std::int64_t>(key >> (32 * a) & 0xffffffffu) - column_origin;
    middle[a] = (static_cast<double>(number) + 0.5) * cell;
  }
  return middle;
}

// Extent of the boxes in a column along each horizontal axis [m].
template <int Dim>
struct Extent {
  std::array<double, Dim - 1> from, to;

  THAWSLIDE_HD Extent() {
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      from[a] = std::numeric_limits<double>::max();
      to[a] = std::numeric_limits<double>::lowest();
    }
  }
  THAWSLIDE_HD Extent& operator+=(const Extent& part) {
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      from[a] = min(from[a], part.from[a]);
      to[a] = max(to[a], part.to[a]);
    }
    return *this;
  }
};

// Contents of a column: volume [m3], and top of its highest box [m].
struct ColumnMass {
  double volume = 0;
  double top = std::numeric_limits<double>::lowest();

  [[nodiscard]] THAWSLIDE_HD bool is_present() const { return volume > 0.0; }
  THAWSLIDE_HD ColumnMass& operator+=(const ColumnMass& part) {
    volume += part.volume;
    top = max(top, part.top);
    return *this;
  }
};

// Contribution of a set of particles to a column.
template <int Dim>
struct ColumnPart {
  ColumnMass column_mass;
  Extent<Dim> extent;
  double mass = 0;

  THAWSLIDE_HD ColumnPart& operator+=(const ColumnPart& part) {
    column_mass += part.column_mass;
    extent += part.extent;
    mass += part.mass;
    return *this;
  }
};

// True if a column lacks a neighbour. filled(side): the adjacent column contains part of the sliding mass.
template <int Dim, class Filled>
THAWSLIDE_HD bool lacks_neighbour(const Filled& filled) {
  for (std::size_t side = 0; side < column_sides<Dim>; ++side) {
    if (!filled(side)) {
      return true;
    }
  }
  return false;
}

// Footprint [m2], per metre of width in 2D: that of the cell, or, at the edge of the body, the extent of the boxes in
// it.
template <int Dim, class Filled>
THAWSLIDE_HD double footprint_of(double cell, bool at_edge, const Extent<Dim>& extent, const Filled& filled) {
  double footprint = 1;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    const bool inside = !at_edge || (filled(2 * a) && filled(2 * a + 1));
    footprint *= inside ? cell : min(cell, extent.to[a] - extent.from[a]);
  }
  return footprint;
}

inline THAWSLIDE_HD double thickness_of(const ColumnMass& column_mass, double footprint) {
  return column_mass.is_present() ? column_mass.volume / footprint : 0.0;
}

// Load on the ground per depth of the column [Pa/m]. normal_gravity: of the column [m/s2].
inline THAWSLIDE_HD double load_per_depth(const ColumnMass& column_mass, double mass, double normal_gravity) {
  return mass / column_mass.volume * normal_gravity;
}

template <class Particles>
THAWSLIDE_HD void update_load(Particles& particles, std::uint32_t particle, double load) {
  particles.load_change(particle) = load - particles.normal_load(particle);
  particles.normal_load(particle) = load;
}

}  // namespace thawslide::band
