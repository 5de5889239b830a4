// How QGIS draws a map: style files (.qml), which it takes up by itself beside FILE.tif as FILE.qml.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gis/geopackage.hpp"

namespace thawslide::gis {

using Color = std::array<std::uint8_t, 3>;  // red, green, blue

struct ColorStop {
  double value = 0.0;
  Color color{};
};

// Stops at even distances from `low` to `high`, dark violet to yellow: lightness rises all the way, and the colours
// stay apart for eyes that see red and green alike (the map "viridis", van der Walt and Smith 2015, in nine colours).
[[nodiscard]] std::vector<ColorStop> even_stops(double low, double high);

// The colours between the stops are interpolated. `stops`: at least two, by rising value. Values at and below
// `nothing_below` are not drawn.
void write_raster_style(const std::string& file, const std::vector<ColorStop>& stops, const std::string& unit,
                        double nothing_below);

enum class LayerKind { polygons, lines, points };

struct VectorStyle {
  LayerKind kind = LayerKind::polygons;
  Color color{};
  double width = 0.5;     // of lines and outlines; the size of points [mm]
  double opacity = 0.25;  // of what fills polygons
  std::string label;      // name of the attribute that stands beside each feature; empty: none
};

void write_vector_style(const std::string& file, const VectorStyle& style);

}  // namespace thawslide::gis
