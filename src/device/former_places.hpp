// Index map between former and current keys, to reuse earlier results of CPU queries for tiles, blocks and columns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "device/tile_tables.hpp"

namespace thawslide::device {

// Place of each key in the list `former`, or absent. Both lists ascend.
inline std::vector<std::int32_t> places_in(const std::vector<std::uint64_t>& former,
                                           const std::vector<std::uint64_t>& keys) {
  std::vector<std::int32_t> places(keys.size(), absent);
  std::size_t at = 0;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    while (at < former.size() && former[at] < keys[k]) {
      ++at;
    }
    if (at < former.size() && former[at] == keys[k]) {
      places[k] = static_cast<std::int32_t>(at);
    }
  }
  return places;
}

}  // namespace thawslide::device
