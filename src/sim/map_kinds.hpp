// The maps that a run in space writes, each a value of a cell.
#pragma once

#include <vector>

#include "sim/map_cell.hpp"

namespace thawslide::sim {

// One of the maps.
struct MapKind {
  const char* name;
  const char* unit;
  const char* description;
  double (*value)(const MapCell&);
  bool of_last_state = false;  // of the moment that it is written at, and not of the whole run
};

// All maps, in the order in which they are told of. A cell that the slide never was in has no data in any of them.
[[nodiscard]] const std::vector<MapKind>& map_kinds();

}  // namespace thawslide::sim
