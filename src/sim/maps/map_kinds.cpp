#include "sim/maps/map_kinds.hpp"

namespace thawslide::sim {

const std::vector<MapKind>& map_kinds() {
  static const std::vector<MapKind> kinds{
      {"max_thickness", "m", "maximum vertical thickness of the sliding mass",
       [](const MapCell& c) { return c.max_thickness; }},
      {"final_thickness", "m", "vertical thickness of the sliding mass", [](const MapCell& c) { return c.thickness; },
       true},
      {"max_speed", "m/s",
       "maximum depth-averaged speed, of all three components, while thicker than maps.arrival_thickness",
       [](const MapCell& c) { return c.max_speed; }},
      {"max_momentum_flux", "m3/s2", "maximum of thickness times depth-averaged speed squared",
       [](const MapCell& c) { return c.max_momentum_flux; }},
      {"max_pressure", "Pa",
       "maximum dynamic pressure: density of the column times depth-averaged speed squared, while thicker than "
       "maps.arrival_thickness",
       [](const MapCell& c) { return c.max_pressure; }},
      {"max_pressure_time", "s", "time when the dynamic pressure was largest",
       [](const MapCell& c) { return c.max_pressure_time; }},
      {"arrival_time", "s", "time when the thickness first exceeded maps.arrival_thickness",
       [](const MapCell& c) { return c.arrival_time; }},
      {"elevation_change", "m", "change in elevation of the surface since t = 0: thickness minus thickness at t = 0",
       [](const MapCell& c) { return c.thickness - c.thickness_at_start; }, true},
      {"max_basal_temperature", "C",
       "maximum temperature of the band, averaged by volume of its particles, or by area of its columns",
       [](const MapCell& c) { return c.max_basal_temperature; }},
      {"max_melt", "m", "maximum depth of liquid water in the column, of which that in the band is divided by xi",
       [](const MapCell& c) { return c.max_melt; }},
      {"max_pore_pressure", "Pa",
       "maximum pore pressure of the band, averaged by volume of its particles, or by area of its columns",
       [](const MapCell& c) { return c.max_pore_pressure; }},
  };
  return kinds;
}

}  // namespace thawslide::sim
