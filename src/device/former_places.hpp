// What the processor was asked of tiles, blocks or columns before is not asked again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "device/tile_tables.hpp"

namespace thawslide::device {

// Where each key of an ascending list stands in another, or absent.
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
