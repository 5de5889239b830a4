// Columns of the sliding mass as seen from the particles of one tile, and the depth of particles in them.
#pragma once

#include <array>
#include <cmath>

#include "band/columns.hpp"
#include "base/error.hpp"
#include "mpm/body_sizes.hpp"

namespace thawslide::band {

// Overlap of boxes with two cells along one horizontal axis, `lower` and the next one.
template <class Value>
struct Overlap {
  Value lower;        // number of the cell, relative to the tile's first one
  Value from[2];      // [m]
  Value to[2];        // [m]
  Value fraction[2];  // fraction of the box

  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Overlap<double> of_lane(std::size_t lane) const {
    return {extract(lower, lane),
            {extract(from[0], lane), extract(from[1], lane)},
            {extract(to[0], lane), extract(to[1], lane)},
            {extract(fraction[0], lane), extract(fraction[1], lane)}};
  }
};

template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Overlap<Value> overlap(Value middle, const mpm::HalfSize<Value>& size,
                                                            int first_cell, double cell, double inverse_cell) {
  using std::floor;
  const Value begin = middle - size.half, end = middle + size.half, sliver = Value(round_off) * size.half;
  const Value number = floor((begin + sliver) * inverse_cell);
  const Value border = (number + 1.0) * cell;
  const auto crosses = end - sliver >= border;
  Overlap<Value> over;
  over.lower = number - static_cast<double>(first_cell);
  over.from[0] = max(begin, number * cell);
  over.to[0] = min(end, border);
  over.from[1] = border;
  over.to[1] = select(crosses, end, border);
  const Value inverse_width = 0.5 * size.inverse;
  over.fraction[0] = (over.to[0] - over.from[0]) * inverse_width;
  over.fraction[1] = (over.to[1] - over.from[1]) * inverse_width;
  return over;
}

template <int Dim, class Value>
using Overlaps = std::array<Overlap<Value>, static_cast<std::size_t>(Dim) - 1>;

template <int Dim, class Particles, class At>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Overlaps<Dim, typename At::Value> overlaps(
    const std::array<int, Dim - 1>& first_cell, double cell, double inverse_cell, const mpm::SizesOfBodies& sizes,
    const Particles& particles, const At& at) {
  const auto size = sizes.of(particles, at);
  Overlaps<Dim, typename At::Value> along;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    along[a] = overlap(particles.position.load(at, static_cast<int>(a)), size, first_cell[a], cell, inverse_cell);
    const auto inside = (along[a].lower >= 0.0) & (along[a].lower <= double(mpm::Tile<Dim>::edge));
    THAWSLIDE_ASSERT(!any(!inside), "of particles {} ... one lies outside its tile: cells {} ...",
                     particles.id(at.particle[0]), extract(along[a].lower, 0));
  }
  return along;
}

// Calls visit(which of the two cells along each axis, places in the tile, fractions) for every column that boxes may
// overlap.
template <int Dim, class Value, class Visit>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void for_columns(const Overlaps<Dim, Value>& along, const Visit& visit) {
  constexpr auto per_axis = static_cast<double>(columns_per_axis<Dim>);
  unrolled<static_cast<std::size_t>(1) << (Dim - 1)>([&](auto corner) THAWSLIDE_INLINE_LAMBDA {
    std::array<std::size_t, Dim - 1> side{};
    Value index = 0.0, fraction = 1.0;
    for (std::size_t a = Dim - 1; a-- > 0;) {
      side[a] = corner >> a & 1;
      index = index * per_axis + along[a].lower + static_cast<double>(side[a]);
      fraction = fraction * along[a].fraction[side[a]];
    }
    visit(side, index, fraction);
  });
}

// Extent of a particle's box in one of these columns.
template <int Dim, class Side>
THAWSLIDE_HD auto extent_in_column(const Overlaps<Dim, double>& along, const Side& side) {
  Extent<Dim> own;
  for (std::size_t a = 0; a + 1 < Dim; ++a) {
    own.from[a] = along[a].from[side[a]];
    own.to[a] = along[a].to[side[a]];
  }
  return own;
}

// One number per column in reach of a tile, by place.
template <int Dim>
struct NumbersOfTile {
  std::array<double, columns_per_tile<Dim>> numbers;

  // all: numbers of all columns. column: index of a column, by place.
  [[nodiscard]] THAWSLIDE_HD static NumbersOfTile of(const double* all, const std::int32_t* column) {
    NumbersOfTile here;
    for (std::size_t index = 0; index < columns_per_tile<Dim>; ++index) {
      here.numbers[index] = all[column[index]];
    }
    return here;
  }
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value at(const Value& index) const {
    return look_up(numbers.data(), index);
  }
};
// The same, by index into the numbers of all columns.
struct NumbersOfColumns {
  const double* numbers;
  const std::int32_t* column;  // by place

  [[nodiscard]] THAWSLIDE_HD static NumbersOfColumns of(const double* all, const std::int32_t* column) {
    return {all, column};
  }
  [[nodiscard]] THAWSLIDE_HD double at(const double& index) const {
    return numbers[column[static_cast<std::size_t>(index)]];
  }
};

// Columns in reach of the particles of one tile. Numbers: one number per column, by place in the tile.
template <int Dim, class Numbers = NumbersOfTile<Dim>>
struct ColumnsOfTile {
  std::array<int, Dim - 1> first_cell;  // number along each horizontal axis
  double cell, inverse_cell;            // [m], [1/m]
  mpm::SizesOfBodies sizes;             // half sizes of particles [m]
  Numbers thickness, top, cosine;
  bool has_ground = false;  // `top` is above the ground (mpm/mapping.hpp)

  // H [m]: column thickness in the band, depth below the column top elsewhere; averaged over columns by the fraction of
  // the box in each.
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD typename At::Value flow_depth(const Particles& particles, const At& at) const {
    using Value = typename At::Value;
    const Value height = height_of(particles, at);
    const auto in_band = particles.in_band.load_whole(at) > 0.0;
    const bool any_in_band = any(in_band);
    Value depth = 0.0;
    for_columns<Dim>(overlaps<Dim>(first_cell, cell, inverse_cell, sizes, particles, at),
                     [&](const auto& /*side*/, Value index, Value fraction) THAWSLIDE_INLINE_LAMBDA {
                       if (!any(fraction > 0.0)) {
                         return;
                       }
                       Value here = max(top.at(index) - height, Value(0.0));
                       if (any_in_band) {
                         here = select(in_band, thickness.at(index), here);
                       }
                       depth += fraction * cosine.at(index) * here;
                     });
    return depth;
  }
  // Vertical depth below the top of the column that contains the particle's centre [m].
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD typename At::Value below_top(const Particles& particles, const At& at) const {
    using Value = typename At::Value;
    using std::floor;
    Value index = 0.0;
    for (std::size_t a = Dim - 1; a-- > 0;) {
      const Value number = floor(particles.position.load(at, static_cast<int>(a)) * inverse_cell);
      index = index * double(columns_per_axis<Dim>) + (number - static_cast<double>(first_cell[a]));
    }
    return top.at(index) - height_of(particles, at);
  }

 private:
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD typename At::Value height_of(const Particles& particles, const At& at) const {
    return has_ground ? particles.height_above_ground.load(at) : particles.position.load(at, Dim - 1);
  }
};

}  // namespace thawslide::band
