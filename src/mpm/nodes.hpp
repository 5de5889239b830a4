// Nodal records of the grid during a step.
#pragma once

#include "mpm/records.hpp"
#include "mpm/transfer.hpp"
#include "mpm/vectors_in_records.hpp"

namespace thawslide::mpm {

template <class Name, int Dim>
using PatchOf = Patch<Dim, components_of<Name, Dim>>;
template <class Name, int Dim>
using RecordsOf = NodeRecords<Dim, components_of<Name, Dim>>;
template <class Name, int Dim>
using SparseRecordsOf = SparseRecords<Dim, components_of<Name, Dim>>;

// Tiles and blocks to which a pass is restricted (mpm/step_passes.hpp).
struct ActivityMarks {
  std::vector<std::uint8_t> tiles, blocks;
  std::vector<std::uint64_t> rows;  // by tile: rows of its patch (Tile::rows_from)
};

template <int Dim>
struct Nodes {
  std::shared_ptr<PatchPool> pool = std::make_shared<PatchPool>();
  RecordsOf<Momentum, Dim> momentum{pool};
  RecordsOf<Motion, Dim> motion;
  RecordsOf<Velocity, Dim> velocity{pool};
  RecordsOf<Averages, Dim> averages{pool};
  RecordsOf<NodalState, Dim> state;
  RecordsOf<HeatRates, Dim> heat_rates{pool};
  // In steps that filter velocities.
  RecordsOf<FilterMoments, Dim> filter_moments{pool};
  RecordsOf<FilterMomentum, Dim> filter_momentum{pool};
  RecordsOf<FilterIncrement, Dim> filter_increment;
  RecordsOf<FilterTotal, Dim> filter_total;
  // In blocks with candidate nodes.
  SparseRecordsOf<BaseLoad, Dim> base;
  SparseRecordsOf<Contact, Dim> contact;
  SparseRecordsOf<NearGround, Dim> near_ground{pool};
  SparseRecordsOf<UnreachedHeat, Dim> unreached_heat;
  SparseRecordsOf<SecantRates, Dim> secant_rates{pool};  // in blocks with temperature changes
  SparseRecordsOf<Seepage, Dim> seepage{pool};           // in blocks that water can seep to
  SparseRecordsOf<SeepingWater, Dim> seeping_water{pool};
  ActivityMarks marks;

  template <class Name>
  [[nodiscard]] auto& of() {
    return Name::in(*this);
  }
};

// Position [m, relative to the domain's lower corner] of a node of a block.
template <int Dim>
Vector<double, Dim> node_position(const SparseGrid<Dim>& grid, std::size_t block, std::size_t node) {
  using T = Tile<Dim>;
  const typename T::Index index = T::node(T::index(grid.blocks()[block]), static_cast<int>(node));
  Vector<double, Dim> position;
  for (int a = 0; a < Dim; ++a) {
    position[a] = static_cast<double>(index[static_cast<std::size_t>(a)]) * grid.cell();
  }
  return position;
}

// Records of a node, by name. device::NodeAccess has the same functions.
template <int Dim>
struct NodeAccess {
  const SparseGrid<Dim>& grid;
  Nodes<Dim>& nodes;

  // Zeros in blocks without such records.
  template <class Name>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE const double* read(const NodeAt& at) const {
    return std::as_const(nodes.template of<Name>())(at).data();
  }
  // Null in blocks without such records.
  template <class Name>
  [[nodiscard]] THAWSLIDE_ALWAYS_INLINE double* write(const NodeAt& at) const {
    auto& records = nodes.template of<Name>();
    if constexpr (requires { records.contains(at.block); }) {
      if (!records.contains(at.block)) {
        return nullptr;
      }
    }
    return records.of_block(at.block)[at.node].data();
  }
  [[nodiscard]] static NodeAt node(std::size_t block, std::size_t in_block) { return {block, in_block}; }
  [[nodiscard]] static std::size_t block(const NodeAt& at) { return at.block; }
  [[nodiscard]] static std::size_t in_block(const NodeAt& at) { return at.node; }
  [[nodiscard]] Vector<double, Dim> position(const NodeAt& at) const { return node_position(grid, at.block, at.node); }
};

}  // namespace thawslide::mpm
