// Where a release lies: the polygons of a file, or the points of a raster that have a thickness.
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
  Raster source;      // the raster of thickness [m], where one gives the release
  Raster share;       // of each point's cell that the release covers, without a taper; at points of the ground
  [[nodiscard]] bool is_raster() const { return !source.empty(); }
};

// What a message calls a key of a body: "body.NAME.release".
[[nodiscard]] std::string key_of(const std::string& body, const std::string& name);

// Reads the release and checks that it lies within the domain and the terrain model. Adds to the notes.
[[nodiscard]] ReleaseArea load_release_area(const config::Case& parameters, const std::string& body, const Dem& ground,
                                            std::vector<std::string>& notes);

}  // namespace thawslide::gis
