// Normal load of particles on a device.
#pragma once

#include "band/columns_of_tile.hpp"
#include "mpm/kernel.hpp"

namespace thawslide::device {

// Normal load of a particle, from columns that hold the load per depth in place of the cosine.
template <class Columns>
struct AddPressureLoad {
  using Reads = mpm::RecordList<>;
  using Adds = mpm::RecordList<>;
  using Totals = mpm::NoTotals;

  struct InTile {
    typename Columns::OfTile columns;

    template <class Particles, class At, class Seen, class Scatter>
    THAWSLIDE_HD void operator()(Particles& particles, const At& at, const Seen& /*seen*/, Scatter& /*added*/,
                                 Totals& /*totals*/) const {
      band::update_load(particles, at.particle[0], columns.flow_depth(particles, at));
    }
  };

  Columns columns;  // by tile

  [[nodiscard]] THAWSLIDE_HD InTile in_tile(std::size_t tile) const { return InTile{columns.of_tile(tile)}; }
};

}  // namespace thawslide::device
