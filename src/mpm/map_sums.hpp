// Sums of the sliding mass over the cells of a map: particle boxes are distributed over the cells below them
// (sim/maps/flow_maps.hpp). 3D only.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/portability.hpp"
#include "base/select.hpp"

namespace thawslide::mpm {

// Cells of a map, in the coordinates of particle positions.
struct MapCells {
  double corner_x = 0.0, corner_y = 0.0;              // lower left corner of the map [m]
  double cell_x = 1.0, cell_y = 1.0;                  // [m]
  double inverse_cell_x = 1.0, inverse_cell_y = 1.0;  // [1/m]
  int columns = 0, rows = 0;
  double largest_half = 0.0;  // largest half width of a particle [m]

  [[nodiscard]] bool operator==(const MapCells& other) const = default;
};

// Key of a cell.
[[nodiscard]] THAWSLIDE_HD inline std::uint64_t map_cell_key(int column, int row) {
  return static_cast<std::uint64_t>(row) << 32 | static_cast<std::uint64_t>(column);
}
[[nodiscard]] inline int column_of_key(std::uint64_t key) { return static_cast<int>(key & 0xffffffffU); }
[[nodiscard]] inline int row_of_key(std::uint64_t key) { return static_cast<int>(key >> 32); }

// Cells along one axis that a box overlaps, and its fractions in them, which sum to 1.
struct CellRange {
  int first, last;
  double first_fraction, inner_fraction, last_fraction;

  [[nodiscard]] THAWSLIDE_HD double fraction(int cell) const {
    return cell == first ? first_fraction : cell == last ? last_fraction : inner_fraction;
  }
};

// The same for several boxes, one per lane, or for one.
template <class Value>
struct CellSpans {
  Value first, last, first_fraction, inner_fraction, last_fraction;

  [[nodiscard]] THAWSLIDE_HD CellRange of_lane(std::size_t lane) const {
    return {static_cast<int>(extract(first, lane)), static_cast<int>(extract(last, lane)),
            extract(first_fraction, lane), extract(inner_fraction, lane), extract(last_fraction, lane)};
  }
};

// Spans of boxes from middle - half to middle + half, in cells, on an axis of `cells` cells. A box that ends on a cell
// border within round-off does not extend into the next cell. Parts outside the map count towards its outermost cell.
// inverse_width: 1/(2 half).
template <class Value>
[[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE CellSpans<Value> cell_spans(Value middle, Value half,
                                                                               Value inverse_width, int cells) {
  using std::floor, thawslide::min, thawslide::max, thawslide::select;
  const Value begin = middle - half, end = middle + half, sliver = round_off * half;
  const Value last_cell(static_cast<double>(cells) - 1.0);
  CellSpans<Value> spans;
  spans.first = max(Value(0.0), min(Value(floor(Value(begin + sliver))), last_cell));
  spans.last = max(Value(0.0), min(Value(floor(Value(end - sliver))), last_cell));
  spans.first_fraction =
      select(spans.first == spans.last, Value(1.0), Value((spans.first + 1.0 - begin) * inverse_width));
  spans.inner_fraction = inverse_width;
  spans.last_fraction = (end - spans.last) * inverse_width;
  return spans;
}

// First and last map cell along an axis that particles of a tile can reach after a step; a step moves them by less than
// a grid cell. first_node: of the tile, as a grid index. grid_cell: mesh size [m].
struct MapWindow {
  int first, last;
};
[[nodiscard]] THAWSLIDE_HD inline MapWindow map_window(int first_node, int edge, double grid_cell, double largest_half,
                                                       double corner, double inverse_cell, int cells) {
  using std::floor, thawslide::min, thawslide::max;
  const double reach = largest_half + grid_cell;
  const double from = grid_cell * first_node - 0.5 * grid_cell - reach - corner;
  const double to = from + grid_cell * edge + 2.0 * reach, last_cell = static_cast<double>(cells) - 1.0;
  return {static_cast<int>(max(0.0, min(floor(from * inverse_cell), last_cell))),
          static_cast<int>(max(0.0, min(floor(to * inverse_cell), last_cell)))};
}

// Sums of a cell over all boxes above it.
struct ColumnSums {
  double volume = 0.0;                                          // [m3]
  double mass = 0.0;                                            // [kg]
  double momentum_x = 0.0, momentum_y = 0.0, momentum_z = 0.0;  // [kg m/s]
  double water = 0.0;  // volume of liquid water [m3], with the actual thickness of the band

  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void add(double fraction, const ColumnSums& box) {
    volume += fraction * box.volume;
    mass += fraction * box.mass;
    momentum_x += fraction * box.momentum_x;
    momentum_y += fraction * box.momentum_y;
    momentum_z += fraction * box.momentum_z;
    water += fraction * box.water;
  }
};

// Sums over the boxes in the band.
struct BandSums {
  double volume = 0.0;              // V [m3]
  double volume_temperature = 0.0;  // V T [m3 C]
  double volume_pressure = 0.0;     // V P [m3 Pa]

  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void add(double fraction, const BandSums& box) {
    volume += fraction * box.volume;
    volume_temperature += fraction * box.volume_temperature;
    volume_pressure += fraction * box.volume_pressure;
  }
};

// Contribution of a whole particle box.
template <class Particles>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE ColumnSums column_sums_of(const Particles& particles, std::size_t p) {
  const double volume = particles.volume(p), mass = particles.mass(p);
  return {volume, mass, mass * particles.velocity(p, 0), mass * particles.velocity(p, 1),
          mass * particles.velocity(p, 2),
          // Cells of metres represent a band of centimetres: its material is scaled as for heat.
          volume * particles.porosity(p) * particles.liquid_saturation(p) / particles.thermal_scaling(p)};
}
template <class Particles>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE BandSums band_sums_of(const Particles& particles, std::size_t p) {
  const double volume = particles.volume(p);
  return {volume, volume * particles.temperature(p), volume * particles.pore_pressure(p)};
}

// All sums of a cell.
struct MapSums {
  ColumnSums column;
  BandSums band;

  THAWSLIDE_HD MapSums& operator+=(const MapSums& part) {
    column.add(1.0, part.column);
    band.add(1.0, part.band);
    return *this;
  }
};

}  // namespace thawslide::mpm
