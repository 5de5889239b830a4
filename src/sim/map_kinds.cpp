#include "sim/map_kinds.hpp"

namespace thawslide::sim {

const std::vector<MapKind>& map_kinds() {
  static const std::vector<MapKind> kinds{
      {"max_thickness", "m", "largest vertical thickness of the slide",
       [](const MapCell& c) { return c.max_thickness; }},
      {"final_thickness", "m", "vertical thickness of the slide", [](const MapCell& c) { return c.thickness; }, true},
      {"max_speed", "m/s",
       "largest depth-averaged speed, all three components, while the slide was thicker than maps.arrival_thickness",
       [](const MapCell& c) { return c.max_speed; }},
      {"max_momentum_flux", "m3/s2", "maximum of thickness times depth-averaged speed squared",
       [](const MapCell& c) { return c.max_momentum_flux; }},
      {"max_pressure", "Pa",
       "largest density of the column times depth-averaged speed squared, while the slide was thicker than "
       "maps.arrival_thickness",
       [](const MapCell& c) { return c.max_pressure; }},
      {"arrival_time", "s", "when the slide first was thicker than maps.arrival_thickness",
       [](const MapCell& c) { return c.arrival_time; }},
      {"elevation_change", "m",
       "elevation of the surface less that at the start: thickness less thickness at the start. Of a body cut out of "
       "the ground too: what it left is lower by the thickness that was cut",
       [](const MapCell& c) { return c.thickness - c.thickness_at_start; }, true},
      {"max_basal_temperature", "C",
       "maximum temperature of the band, averaged by volume of its particles, or by area of its columns",
       [](const MapCell& c) { return c.max_basal_temperature; }},
      {"max_melt", "m", "largest volume of liquid water in the column over the cell's area, that of the band over xi",
       [](const MapCell& c) { return c.max_melt; }},
      {"max_pore_pressure", "Pa",
       "largest pore pressure of the band, averaged by volume of its particles, or by area of its columns",
       [](const MapCell& c) { return c.max_pore_pressure; }},
  };
  return kinds;
}

}  // namespace thawslide::sim
