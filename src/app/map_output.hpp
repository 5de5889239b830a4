// maps/ of a run in space: GeoTIFF maps, a GeoPackage of areas and lines, and QGIS styles beside them.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "sim/run_records.hpp"

namespace thawslide::app {

// Where the front was at a time [s].
struct FrontAt {
  double time;
  Place2 place;
};

// Whether this build can write maps: it needs GDAL.
[[nodiscard]] bool can_write_maps();

// The ground that the slide moves on, and the thickness of what is released; nothing without a raster of the ground.
void write_ground_maps(const std::filesystem::path& folder, const config::Site& site);

// What was gathered so far, over the maps of an earlier time. Each file is whole or not there. when: what the last
// state is called (sim/end_state.hpp).
void write_maps(const std::filesystem::path& folder, const sim::RunRecords<3>& records,
                const std::vector<FrontAt>& fronts, const std::string& when);

}  // namespace thawslide::app
