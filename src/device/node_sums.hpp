// Nodal records, and their sums over the patches around each node in the order of mpm/transfer.hpp.
#pragma once

#include <limits>

#include "base/select.hpp"
#include "device/tile_tables.hpp"
#include "mpm/kernel.hpp"
#include "mpm/records.hpp"

namespace thawslide::device {

// Records of one name, consecutive over the nodes of all blocks.
template <class Name, int Dim>
struct RecordsOf {
  static constexpr std::size_t size = mpm::record_size(mpm::components_of<Name, Dim>);
  double* numbers;

  // node: number over all blocks.
  [[nodiscard]] THAWSLIDE_HD double* operator()(std::size_t node) const { return numbers + node * size; }
};

// Pointers to the records that a pass reads.
template <class Names>
struct RecordsRead;
template <class... Names>
struct RecordsRead<mpm::RecordList<Names...>> {
  using Type = mpm::ByName<mpm::Named<Names, const double*>...>;
  template <class Records>
  static Type from([[maybe_unused]] const Records& records) {
    return {{records.template numbers<Names>()}...};
  }
};

// Sum, over the tiles around a node, of their patches, its own tile first; the minimum for min-reduced components. One
// thread per component of a node. MinReduced: a name with such components, or void.
template <class Name, class MinReduced, class TileFilter, int Dim>
struct SumPatches {
  static constexpr std::size_t size = mpm::record_size(mpm::components_of<Name, Dim>);

  TileTables<Dim> tables;
  TileFilter accepts;
  const std::uint8_t* blocks;  // marks of blocks with nodes to sum at; null: all
  const double* patches;
  double* records;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    using T = mpm::Tile<Dim>;
    constexpr auto nodes = static_cast<std::size_t>(T::nodes);
    constexpr std::size_t own = static_cast<std::size_t>(T::stencil) / 2;
    const std::size_t component = k % size, node = k / size % nodes, block = k / size / nodes;
    if (blocks != nullptr && blocks[block] == 0) {
      return;
    }
    const bool min_reduced = is_min_reduced(component);
    double sum = min_reduced ? std::numeric_limits<double>::max() : 0.0;
    if (!min_reduced) {
      visit_part(block, node, own, component, [&](double part) { sum = part; });
    }
    for_directions_that_see(node, [&](std::size_t d) {
      if (min_reduced) {
        visit_part(block, node, d, component, [&](double part) { sum = min(sum, part); });
      } else if (d != own) {
        visit_part(block, node, d, component, [&](double part) { sum += part; });
      }
    });
    records[k] = sum;
  }

 private:
  THAWSLIDE_HD static constexpr bool is_min_reduced([[maybe_unused]] std::size_t component) {
    if constexpr (std::is_void_v<MinReduced>) {
      return false;
    } else {
      return component >= mpm::part_of<MinReduced, Dim>.from &&
             component < mpm::part_of<MinReduced, Dim>.from + mpm::part_of<MinReduced, Dim>.count;
    }
  }
  // Calls visit(direction), in order, for the directions whose tile's patch contains a node of a block. Along each
  // axis, these are the block's own, and the adjacent side if the node is the outermost one.
  template <class Visit>
  THAWSLIDE_HD static void for_directions_that_see(std::size_t node, const Visit& visit) {
    constexpr auto edge = static_cast<std::size_t>(mpm::Tile<Dim>::edge);
    const std::size_t along[3] = {node % edge, node / edge % edge, node / edge / edge};
    std::size_t from[3] = {1, 0, 0}, to[3] = {1, 0, 0};
    for (int a = 0; a < Dim; ++a) {
      from[a] = along[a] == 0 ? 0 : 1;
      to[a] = along[a] + 1 == edge ? 2 : 1;
    }
    for (std::size_t z = from[2]; z <= to[2]; ++z) {
      for (std::size_t y = from[1]; y <= to[1]; ++y) {
        for (std::size_t x = from[0]; x <= to[0]; ++x) {
          visit((z * 3 + y) * 3 + x);
        }
      }
    }
  }
  // Calls with(number) with the component in the patch of the tile in a direction, if that tile exists.
  template <class With>
  THAWSLIDE_HD void visit_part(std::size_t block, std::size_t node, std::size_t direction, std::size_t component,
                               const With& with) const {
    using T = mpm::Tile<Dim>;
    const std::int32_t tile = tables.tiles_about_block[block * static_cast<std::size_t>(T::stencil) + direction];
    if (tile == absent || !accepts(static_cast<std::size_t>(tile))) {
      return;
    }
    const std::size_t index = index_in_patch<Dim>(node, direction);
    with(patches[(static_cast<std::size_t>(tile) * static_cast<std::size_t>(T::patch_nodes) + index) * size +
                 component]);
  }
};

}  // namespace thawslide::device
