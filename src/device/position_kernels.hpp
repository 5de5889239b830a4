// Kernels for positions of particles, and their heights above the ground.
#pragma once

#include <cstddef>

#include "mpm/kernel.hpp"
#include "mpm/position_kernel.hpp"
#include "terrain/column_heights.hpp"

namespace thawslide::device {

// Heights of columns of nodes in device memory.
template <int Dim>
struct ColumnHeights {
  terrain::ColumnChunks<Dim> columns;
  const double* heights;  // by chunk and column

  [[nodiscard]] THAWSLIDE_HD double operator()(const typename terrain::ColumnChunks<Dim>::Column& column) const {
    const auto place = columns.place_of(column);
    return heights[place.chunk * static_cast<std::size_t>(columns.size) + place.column];
  }
};

// Updates positions and, with ground, what depends on them alone.
template <int Dim>
struct UpdatePosition {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = typename mpm::UpdatePosition<Dim>::Totals;

  mpm::UpdatePosition<Dim> update;
  bool has_ground;
  terrain::LocateAboveGround<Dim, ColumnHeights<Dim>> locate;

  template <class Particles, class At, class Seen, class Scatter>
  THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& seen, Scatter& added,
                               Totals& invalid) const {
    update(particles, at, seen, added, invalid);
    if (has_ground) {
      mpm::NoTotals none;
      locate(particles, at, seen, added, none);
    }
  }
};

}  // namespace thawslide::device
