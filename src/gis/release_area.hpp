// Area of a release: the polygons of a file or, without these, the points at which a raster has a thickness or a
// surface lies above the ground; and its thickness there.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "config/case.hpp"
#include "gis/dem.hpp"
#include "gis/vector_file.hpp"

namespace thawslide::gis {

struct ReleaseArea {
  VectorLayer layer;  // selected features; none for a raster
  Polygons polygons;  // their union
  Raster source;      // thickness [m] for a raster
  Raster fraction;    // covered fraction of each point's cell, without a taper; at points of the ground
  [[nodiscard]] bool is_raster() const { return !source.empty(); }
};

// [m]; a raster with larger values contains elevations.
inline constexpr double thickest = 500.0;
inline constexpr const char* swapped_dem =
    "Is this raster a DEM, swapped with the raster of the thickness? It needs the thickness.";

// Name of a body's key in messages: "body.NAME.release".
[[nodiscard]] std::string key_of(const std::string& body, const std::string& name);

// Key that specifies the area of a body, and the file it names: its polygons or, without these, its thickness.
[[nodiscard]] std::string area_key(const config::Case& parameters, const std::string& body);
[[nodiscard]] const std::string& area_file(const config::Case& parameters, const std::string& body);

// Reads the release and checks that it lies within the domain and the DEM. Appends warnings.
[[nodiscard]] ReleaseArea load_release_area(const config::Case& parameters, const std::string& body, const Dem& ground,
                                            std::vector<std::string>& warnings);

// Vertical thickness of a release at the points of the ground [m], at the points of the area's `fraction`, with its
// taper. Throws UserError if it is missing or negative. Appends warnings.
[[nodiscard]] Raster vertical_thickness_of(const config::Case& parameters, const std::string& body,
                                           const ReleaseArea& area, const Dem& ground,
                                           std::vector<std::string>& warnings);

// Vertical thickness [m] of a layer `along_normal` [m] thick on a plane with the gradient dz/dx, dz/dy.
inline double vertical_thickness(double along_normal, double dz_dx, double dz_dy) {
  return along_normal * std::sqrt(1.0 + dz_dx * dz_dx + dz_dy * dz_dy);
}

}  // namespace thawslide::gis
