// Polygons, lines and points in files: Shapefile, GeoPackage, GeoJSON and what else GDAL knows.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "gis/polygons.hpp"

namespace thawslide::gis {

struct Feature {
  std::string title;  // for messages: "polygon 2 (north)", from 1
  Polygons polygons;
  std::vector<Polyline2> lines;
  std::vector<std::array<double, 2>> points;
  std::map<std::string, std::string> texts;  // of all its attributes; without those that are null
  std::map<std::string, double> numbers;     // of those that are numbers; truth values are none
};

// The features of one layer, in the ground's coordinates. What the functions throw is a UserError that begins with the
// file's name.
struct VectorLayer {
  std::string file;
  std::vector<std::string> attributes;  // their names
  std::vector<Feature> features;        // at least one
  std::vector<std::string> warnings;    // what the user should know of the reading
};

// Each reads the one layer of the file that holds what it says, and checks all of it: polygons have an area and do not
// cross themselves. `crs`: WKT of the ground; where the file tells another system its coordinates are taken to this
// one.
[[nodiscard]] VectorLayer read_polygons(const std::string& file, const std::string& crs);
[[nodiscard]] VectorLayer read_lines(const std::string& file, const std::string& crs);
[[nodiscard]] VectorLayer read_points(const std::string& file, const std::string& crs);

// An attribute's name as the file writes it: the same name, or without it the one that differs in the case of letters
// alone. Throws UserError for none and for several. `key` asks for it, for the message.
[[nodiscard]] std::string attribute_named(const VectorLayer& layer, const std::string& name, const std::string& key);

// The features that carry the names; all of them if there are no names. An error names those that the file has.
[[nodiscard]] std::vector<Feature> features_named(const VectorLayer& layer, const std::vector<std::string>& names,
                                                  const std::string& name_attribute);

}  // namespace thawslide::gis
