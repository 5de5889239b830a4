// State of the band columns below nodes on the ground. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mpm/records.hpp"
#include "mpm/tile.hpp"

namespace thawslide::mpm {

// Records of BaseState of the nodes of layer 0; nodes below have the state of the one above them.
template <int Dim>
struct BaseStates {
  static constexpr std::size_t size = record_size(components_of<BaseState, Dim>);
  static constexpr auto of_layer = static_cast<std::size_t>(Tile<Dim>::rows);

  // By block: that of layer 0 in its column, or the number of blocks if this one is not active; -1 above the ground.
  const std::int32_t* ground_block = nullptr;
  const double* records = nullptr;  // by ground block and node, then zeros; null without band columns

  // Null without band columns. The node must be on the ground or below it.
  [[nodiscard]] THAWSLIDE_HD const double* at(std::size_t block, std::size_t node) const {
    return records == nullptr
               ? nullptr
               : records + (static_cast<std::size_t>(ground_block[block]) * of_layer + node % of_layer) * size;
  }
};

}  // namespace thawslide::mpm
