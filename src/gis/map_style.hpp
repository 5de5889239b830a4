// Styles of maps (FILE.qml, which QGIS loads with FILE.tif) and layers. Classes are equal for all runs, and colours are
// those of the report (python/thawslide/figures/maximum_maps.py).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace thawslide::gis {

using Color = std::array<std::uint8_t, 3>;  // red, green, blue

// Class of values up to `upper`, above those of the class before it.
struct ColorClass {
  double upper = 0.0;  // infinity: all larger values
  Color color{};
  bool is_drawn = true;  // false: transparent
};

struct RasterStyle {
  std::vector<ColorClass> classes;  // by increasing upper limit
  double lowest = 0.0;              // lower limit of the first class; -infinity: none
  std::string unit;                 // of the labels
  double unit_size = 1.0;           // in units of the map
  bool hides_zero = false;          // values of 0 and below are transparent
};

void write_raster_style(const std::string& file, const RasterStyle& style);

enum class LayerKind { polygons, lines, points };

struct VectorStyle {
  LayerKind kind = LayerKind::polygons;
  Color color{};
  double width = 0.5;     // of lines and outlines; the size of points [mm]
  double opacity = 0.25;  // of the fill of polygons
  std::string label;      // attribute shown as a label of each feature; empty: none
};

// Text of a style file, which a GeoPackage layer can also contain.
[[nodiscard]] std::string vector_style(const VectorStyle& style);

// Style of a map by its name ("max_thickness"). Classes have round limits.
[[nodiscard]] RasterStyle style_of_map(const std::string& name);

// Style with classes of hazard, for the maximum thickness and pressure; without classes for the other maps.
[[nodiscard]] RasterStyle hazard_style_of_map(const std::string& name);

}  // namespace thawslide::gis
