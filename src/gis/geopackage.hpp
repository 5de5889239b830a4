// Maps of lines and areas for a GIS: layers of polygons, lines or points with attributes, in a GeoPackage.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "base/raster.hpp"
#include "gis/polygons.hpp"

namespace thawslide::gis {

// A column of the table of a layer: one value a feature, numbers or texts. NaN and empty texts are written as null.
struct Attribute {
  std::string name;
  std::variant<std::vector<double>, std::vector<std::string>> values;
};

// As many values in each attribute as there are features.
struct MapLayer {
  std::string name;
  // One feature an element: polygons are areas of any number of parts.
  std::variant<std::vector<Polygons>, std::vector<Polyline2>, std::vector<std::array<double, 2>>> features;
  std::vector<Attribute> attributes;
  std::string style = {};  // how QGIS draws it, as vector_style says; empty: as it likes
};

// `crs`: WKT; empty: unknown. Whole or not there: written beside its place and renamed; an older file is replaced.
void write_geopackage(const std::string& file, const std::vector<MapLayer>& layers, const std::string& crs);

// The cells about the points whose value is neither 0 nor NaN, as areas with holes: cells that share an edge are one.
[[nodiscard]] Polygons areas_of_mask(const Raster& mask);

}  // namespace thawslide::gis
