// Maps written by a 3D run, each with one value per cell.
#pragma once

#include <vector>

#include "sim/maps/map_cell.hpp"

namespace thawslide::sim {

// One of the maps.
struct MapKind {
  const char* name;
  const char* unit;
  const char* description;
  double (*value)(const MapCell&);
  bool of_last_state = false;  // of the state when it is written, not of the whole run
};

// All maps, in output order. A cell that the slide never covered has no data in any of them.
[[nodiscard]] const std::vector<MapKind>& map_kinds();

}  // namespace thawslide::sim
