// Coordinate reference systems: what a file or the user says, whether the ground can be computed in it, and the way
// from one to another. All are texts in WKT here.
#pragma once

#include <string>

#include "gis/rectangle.hpp"

namespace thawslide::gis {

// What the messages about a reference system name.
struct Located {
  std::string file;
  Rectangle extent;                   // of its coordinates, in the file's numbers
  double cell_x = 0.0, cell_y = 0.0;  // of a raster, in the file's numbers
};

// Throws UserError where PROJ does not find its database.
void require_projection_database();

// The WKT of a system the user names, such as "EPSG:31254" or a WKT. Throws UserError where it is not known.
[[nodiscard]] std::string reference_system_named(const std::string& text);

// "EPSG:31254", or the system's title where it has no number; empty for an empty one.
[[nodiscard]] std::string name_of(const std::string& wkt);

[[nodiscard]] bool is_geographic(const std::string& wkt);

// Numbers beyond 360 or 90 are no longitude and latitude, whatever the file says.
[[nodiscard]] bool can_be_degrees(const Rectangle& extent);

// The system to compute in: the one that `terrain.crs` names, else the file's. Throws UserError where there is none,
// and where it is not a map projection in metres; the text says how to mend that.
// Only its horizontal part is returned.
[[nodiscard]] std::string metric_system(const Located& raster, const std::string& wkt_of_file,
                                        const std::string& terrain_crs);

// What the user should know of a raster that lies far outside the area its system is made for; empty where it does not.
[[nodiscard]] std::string place_warning(const Located& raster, const std::string& wkt);

}  // namespace thawslide::gis
