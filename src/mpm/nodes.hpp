// Nodal records of the grid during a step.
#pragma once

#include "mpm/records.hpp"
#include "mpm/transfer.hpp"
#include "mpm/vectors_in_records.hpp"

namespace thawslide::mpm {

template <class Name, int Dim, class Real>
using PatchOf = Patch<Dim, Real, components_of<Name, Dim>>;
template <class Name, int Dim, class Real>
using RecordsOf = NodeRecords<Dim, Real, components_of<Name, Dim>>;
template <class Name, int Dim, class Real>
using SparseRecordsOf = SparseRecords<Dim, Real, components_of<Name, Dim>>;

// Marks of temperature changes and seepage: tiles with such particles, and the blocks in their reach.
struct ActivityMarks {
  std::vector<std::uint8_t> changing_tiles, changing_blocks;
  std::vector<std::uint8_t> seeping_tiles, seeping_blocks;
};

template <int Dim, class Real>
struct Nodes {
  std::shared_ptr<PatchPool> room = std::make_shared<PatchPool>();
  RecordsOf<Momentum, Dim, Real> momentum{room};
  RecordsOf<Motion, Dim, Real> motion;
  RecordsOf<Velocity, Dim, Real> velocity{room};
  RecordsOf<Averages, Dim, Real> averages{room};
  RecordsOf<NodalState, Dim, Real> state;
  RecordsOf<HeatRates, Dim, Real> heat_rates{room};
  // In steps that filter velocities.
  RecordsOf<FilterMoments, Dim, Real> filter_moments{room};
  RecordsOf<FilterMomentum, Dim, Real> filter_momentum{room};
  RecordsOf<FilterIncrement, Dim, Real> filter_increment;
  RecordsOf<FilterTotal, Dim, Real> filter_total;
  // In blocks with candidate nodes.
  SparseRecords<Dim, Real, BaseLayout::size> base;
  SparseRecordsOf<Contact, Dim, Real> contact;
  SparseRecordsOf<NearGround, Dim, Real> near_ground{room};
  SparseRecords<Dim, Real, BedLayout<Dim>::size> bed;  // with an erodible bed
  SparseRecordsOf<UnreachedHeat, Dim, Real> unreached_heat;
  SparseRecordsOf<BaseState, Dim, Real> base_state;    // with band columns
  SparseRecordsOf<HeatRates, Dim, Real> secant_rates;  // with the secant capacity, in blocks with temperature changes
  SparseRecordsOf<Seepage, Dim, Real> seepage{room};   // in blocks that water can seep to
  SparseRecordsOf<SeepingWater, Dim, Real> seeping_water{room};
  ActivityMarks marks;

  template <class Name>
  [[nodiscard]] auto& of() {
    return Name::in(*this);
  }
};

// Position [m, relative to the domain's lower corner] of a node of a block.
template <int Dim, class Real>
Vector<Real, Dim> node_position(const SparseGrid<Dim, Real>& grid, std::size_t block, std::size_t node) {
  using T = Tile<Dim>;
  const typename T::Index index = T::node(T::index(grid.blocks()[block]), static_cast<int>(node));
  Vector<Real, Dim> position;
  for (int a = 0; a < Dim; ++a) {
    position[a] = static_cast<Real>(index[static_cast<std::size_t>(a)]) * grid.cell();
  }
  return position;
}

}  // namespace thawslide::mpm
