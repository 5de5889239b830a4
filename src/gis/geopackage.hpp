// GeoPackage output of layers of polygons, lines or points with attributes.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "gis/polygons.hpp"

namespace thawslide::gis {

// Column of a layer's table: one value per feature, numbers or texts. NaN and empty texts are written as null.
struct Attribute {
  std::string name;
  std::variant<std::vector<double>, std::vector<std::string>> values;
};

// Layer with as many values in each attribute as there are features.
struct MapLayer {
  std::string name;
  // One feature per element; a polygon feature may have any number of parts.
  std::variant<std::vector<Polygons>, std::vector<Polyline2>, std::vector<std::array<double, 2>>> features;
  std::vector<Attribute> attributes;
  std::string style = {};  // QGIS style, from vector_style; empty: default of QGIS
};

// `crs`: WKT; empty: unknown. Replaces an older file atomically.
void write_geopackage(const std::string& file, const std::vector<MapLayer>& layers, const std::string& crs);

}  // namespace thawslide::gis
