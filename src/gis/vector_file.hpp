// Vector files of polygons, lines and points: Shapefile, GeoPackage, GeoJSON.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "gis/polygons.hpp"

namespace thawslide::gis {

struct Feature {
  std::string title;  // for messages: "polygon 2 (north)", from 1
  std::string name;   // the attribute "name"; empty if there is none
  Polygons polygons;
  std::vector<Polyline2> lines;
  std::vector<std::array<double, 2>> points;
  std::map<std::string, std::string> texts;  // all attributes that are not null
  std::map<std::string, double> numbers;     // numeric attributes, without booleans
};

// Features of one layer, in the ground's coordinates. The functions throw UserErrors that begin with the file's name.
struct VectorLayer {
  std::string file;
  std::vector<std::string> attributes;  // names of the attributes
  std::vector<Feature> features;        // at least one
  std::vector<std::string> warnings;    // from the reading
};

// As raster_formats. The driver "KML" does not follow links, unlike "LIBKML".
[[nodiscard]] const char* const* vector_formats();

// Each function reads the only layer of this kind in the file, and checks it: polygons have an area and do not
// intersect themselves. `crs`: WKT of the ground, to which coordinates in another system are transformed.
[[nodiscard]] VectorLayer read_polygons(const std::string& file, const std::string& crs);
[[nodiscard]] VectorLayer read_lines(const std::string& file, const std::string& crs);
[[nodiscard]] VectorLayer read_points(const std::string& file, const std::string& crs);

}  // namespace thawslide::gis
