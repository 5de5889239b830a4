// Style files (.qml) of maps for QGIS, which loads FILE.qml for FILE.tif automatically, and the style of a GeoPackage
// layer.
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

// Stops at equal intervals from `low` to `high`, dark violet to yellow. Lightness increases monotonically, and the
// colours remain distinct in red-green colour blindness (the map "viridis", van der Walt and Smith 2015, in nine
// colours).
[[nodiscard]] std::vector<ColorStop> even_stops(double low, double high);

// Stops for signed quantities: blue at -largest, nearly white at 0, vermilion at largest (Okabe and Ito 2008, Color
// universal design).
[[nodiscard]] std::vector<ColorStop> diverging_stops(double largest);

// Colours are interpolated between the stops. `stops`: at least two, by increasing value. Values at and below
// `nothing_below` are not drawn; -infinity: all are.
void write_raster_style(const std::string& file, const std::vector<ColorStop>& stops, const std::string& unit,
                        double nothing_below);

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
void write_vector_style(const std::string& file, const VectorStyle& style);

}  // namespace thawslide::gis
