// Boxes of particles over the columns of the sliding mass (mpm/box_sums.hpp): one group per tile, whose places are the
// columns in reach.
#pragma once

#include "band/columns_of_tile.hpp"
#include "mpm/mapping.hpp"

namespace thawslide::band {

template <int Dim>
struct ColumnBoxes {
  using Part = ColumnPart<Dim>;
  using Side = std::array<std::size_t, Dim - 1>;  // which of the two columns along each axis

  struct Tile {
    std::size_t number;
    std::array<int, Dim - 1> first_cell;

    [[nodiscard]] THAWSLIDE_HD static constexpr std::size_t tiles() { return 1; }
    [[nodiscard]] THAWSLIDE_HD std::size_t tile(std::size_t /*k*/) const { return number; }
    [[nodiscard]] THAWSLIDE_HD static constexpr std::size_t places() { return columns_per_tile<Dim>; }
  };
  template <class Value>
  struct Spans {
    Value top;  // [m]
    Overlaps<Dim, Value> along;
  };
  struct Box {
    double volume, mass;
    Spans<double> spans;
  };
  struct Share {
    Side side;
    double fraction;  // of the box

    THAWSLIDE_HD explicit operator bool() const { return fraction > 0.0; }
  };

  std::size_t tiles;
  const std::uint64_t* tile_keys;
  mpm::SizesOfBodies sizes;  // half sizes of particles [m]
  double cell;
  mpm::Mapping mapping;
  Part* parts;  // by tile and place

  [[nodiscard]] THAWSLIDE_HD std::size_t groups() const { return tiles; }
  [[nodiscard]] THAWSLIDE_HD Tile group(std::size_t tile) const { return {tile, first_cell_of<Dim>(tile_keys[tile])}; }
  template <class Particles, class At>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Spans<typename At::Value> spans(const Tile& here,
                                                                                     const Particles& particles,
                                                                                     const At& at) const {
    return {mapping.template coordinate<Dim>(particles, at, Dim - 1) + sizes.of(particles, at).half,
            overlaps<Dim>(here.first_cell, cell, 1.0 / cell, sizes, particles, at)};
  }
  template <class Particles, class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Box box(const Particles& particles, std::uint32_t p,
                                                             const Spans<Value>& spans, std::size_t lane) const {
    Box found{particles.volume(p), particles.mass(p), {extract(spans.top, lane), {}}};
    for (std::size_t a = 0; a + 1 < Dim; ++a) {
      found.spans.along[a] = spans.along[a].of_lane(lane);
    }
    return found;
  }
  template <class Visit>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void for_places(const Tile& /*here*/, const Box& box, const Visit& visit) const {
    for_columns<Dim>(box.spans.along, [&](const Side& side, double place, double fraction) THAWSLIDE_INLINE_LAMBDA {
      if (fraction > 0.0) {
        visit(static_cast<std::size_t>(place), Share{side, fraction});
      }
    });
  }
  [[nodiscard]] THAWSLIDE_HD Share share(const Tile& /*here*/, const Box& box, std::size_t place) const {
    Share found{{}, 0.0};
    for_columns<Dim>(box.spans.along, [&](const Side& side, double at, double fraction) {
      if (static_cast<std::size_t>(at) == place) {
        found = {side, fraction};
      }
    });
    return found;
  }
  [[nodiscard]] THAWSLIDE_HD Part* part(const Tile& here, std::size_t place) const {
    return parts + here.number * columns_per_tile<Dim> + place;
  }
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void add(const Box& box, const Share& share, Part& part) const {
    const double volume = share.fraction * box.volume;
    if (volume > 0.0) {
      part.column_mass += {volume, box.spans.top};
    }
    part.extent += extent_in_column<Dim>(box.spans.along, share.side);
    part.mass += share.fraction * box.mass;
  }
};

}  // namespace thawslide::band
