// How QGIS draws a map: style files (.qml). It takes up FILE.qml beside FILE.tif by itself, and what a layer of a
// GeoPackage carries.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace thawslide::gis {

using Color = std::array<std::uint8_t, 3>;  // red, green, blue

struct ColorStop {
  double value = 0.0;
  Color color{};
};

// Stops at even distances from `low` to `high`, dark violet to yellow: lightness rises all the way, and the colours
// stay apart for eyes that see red and green alike (the map "viridis", van der Walt and Smith 2015, in nine colours).
[[nodiscard]] std::vector<ColorStop> even_stops(double low, double high);

// For what rises and falls: blue at -largest, nearly white at 0, vermilion at largest (Okabe and Ito 2008, Color
// universal design).
[[nodiscard]] std::vector<ColorStop> diverging_stops(double largest);

// The colours between the stops are interpolated. `stops`: at least two, by rising value. Values at and below
// `nothing_below` are not drawn; -infinity: all are.
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

// The text of a style file, which a layer of a GeoPackage can also carry itself.
[[nodiscard]] std::string vector_style(const VectorStyle& style);
void write_vector_style(const std::string& file, const VectorStyle& style);

}  // namespace thawslide::gis
