// Vector files (Shapefile, GeoPackage, GeoJSON, KML), and their features by names or by the values of an attribute.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gis/case_inputs.hpp"
#include "gis/polygons.hpp"

namespace thawslide::gis {

struct Feature {
  std::string title;  // for messages: "polygon 2 (north)", from 1
  std::string name;   // the attribute "name"; empty if there is none
  Polygons polygons;
  std::vector<Polyline2> lines;
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

// Read and check the only layer of this kind in the file. `crs`: WKT of the ground, to which they transform.
[[nodiscard]] VectorLayer read_polygons(const std::string& file, const std::string& crs);
[[nodiscard]] VectorLayer read_lines(const std::string& file, const std::string& crs);

// Spelling of an attribute's name in the file, maybe in other letter case. Throws UserError for none and for several.
[[nodiscard]] std::string attribute_named(const VectorLayer& layer, const std::string& name, const std::string& key);

// Features with the given names; all of them if there are no names. An error lists the names in the file.
[[nodiscard]] std::vector<Feature> features_named(const VectorLayer& layer, const std::vector<std::string>& names,
                                                  const std::string& name_attribute);

struct ValuedArea {
  double value = 0.0;
  Polygons polygons;  // union of those with the value
};

// Features in groups, by increasing value. Throws UserError for no number, and if features of different values overlap.
[[nodiscard]] std::vector<ValuedArea> areas_by_value(const VectorLayer& layer, const std::string& attribute,
                                                     const std::string& key);

struct PolygonRequest {
  Located<std::string> file;
  Located<std::vector<std::string>> names;  // empty: all polygons
  std::string name_attribute;
};

// The file with the selected features, in the ground's coordinates (WKT). Appends warnings.
[[nodiscard]] VectorLayer read_named_polygons(const PolygonRequest& request, const std::string& crs,
                                              std::vector<std::string>& warnings);

[[nodiscard]] Polygons union_of_features(const VectorLayer& layer);

// Part of the request's polygons in the domain. Throws UserError if there is none.
[[nodiscard]] Polygons part_in_domain(const PolygonRequest& request, const Polygons& polygons, const Rectangle& domain);

}  // namespace thawslide::gis
