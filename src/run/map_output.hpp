// maps/ of a 3D run: GeoTIFF maps, a GeoPackage of areas and lines, and their QGIS styles.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/records/run_records.hpp"

namespace thawslide::run {

// Position of the front at a time [s].
struct FrontAt {
  double time;
  Point2 position;
};

// True if this build can write maps, which requires GDAL.
[[nodiscard]] bool can_write_maps();

// A map written at the start.
struct GroundMap {
  const char* name;
  const char* unit;
  const char* description;
};
inline constexpr GroundMap terrain_map{"terrain", "m", "elevation of the terrain, resampled and filtered"};
inline constexpr GroundMap release_map{"release", "m", "vertical thickness of the release"};
inline constexpr GroundMap ground_map{
    "ground", "m",
    "elevation of the ground of the cells, on which the material slides; thicknesses are relative to it"};

// Writes the first two on the points of a DEM, and the last on the grid of the other maps, if there is a terrain.
void write_ground_maps(const std::filesystem::path& folder, const sim::Simulation<3>& simulation);

// Attributes of the maps.
struct MapTexts {
  std::string run;        // name of its folder
  std::string state;      // label of the last state (sim/records/end_state.hpp)
  double time;            // of the last state [s]
  double area_thickness;  // maps.area_thickness [m]
};

// Writes the current maps and replaces earlier ones. Each file is replaced atomically.
void write_maps(const std::filesystem::path& folder, const sim::RunRecords<3>& records, const config::Site& site,
                const std::vector<FrontAt>& fronts, const MapTexts& texts);

}  // namespace thawslide::run
