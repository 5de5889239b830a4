// Where a release lies: the polygons of a file, or without these the points where a raster has a thickness or a surface
// lies above the ground.
#pragma once

#include <string>
#include <vector>

#include "config/case.hpp"
#include "gis/dem.hpp"
#include "gis/vector_file.hpp"

namespace thawslide::gis {

struct ReleaseArea {
  VectorLayer layer;  // the features chosen; none where a raster gives the release
  Polygons polygons;  // their union
  Raster source;      // the thickness [m], where a raster gives the release
  Raster share;       // of each point's cell that the release covers, without a taper; at points of the ground
  [[nodiscard]] bool is_raster() const { return !source.empty(); }
};

// What a message calls a key of a body: "body.NAME.release".
[[nodiscard]] std::string key_of(const std::string& body, const std::string& name);

// The key that gives the place of a body, and the file it names: its polygons, or without these its thickness.
[[nodiscard]] std::string key_of_place(const config::Case& parameters, const std::string& body);
[[nodiscard]] const std::string& file_of_place(const config::Case& parameters, const std::string& body);

// Reads the release and checks that it lies within the domain and the DEM. Adds to the notes.
[[nodiscard]] ReleaseArea load_release_area(const config::Case& parameters, const std::string& body, const Dem& ground,
                                            std::vector<std::string>& warnings);

}  // namespace thawslide::gis
