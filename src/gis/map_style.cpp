#include "gis/map_style.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace thawslide::gis {

namespace {

constexpr Color viridis[] = {{68, 1, 84},    {71, 44, 122}, {59, 81, 139},  {44, 113, 142}, {33, 144, 141},
                             {39, 173, 129}, {92, 200, 99}, {170, 220, 50}, {253, 231, 37}};

constexpr const char* opening = "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += letter;
    }
  }
  return result;
}

std::string option(const char* name, const std::string& value) {
  return fmt::format("        <Option type=\"QString\" name=\"{}\" value=\"{}\"/>\n", name, escaped(value));
}

std::string rgba(const Color& color, double opacity) {
  return fmt::format("{},{},{},{}", color[0], color[1], color[2], std::lround(255.0 * opacity));
}

std::string symbol_layer(const VectorStyle& style) {
  const std::string width = fmt::format("{:g}", style.width);
  const std::string solid = rgba(style.color, 1.0);
  switch (style.kind) {
    case LayerKind::polygons:
      return "      <layer class=\"SimpleFill\" enabled=\"1\" locked=\"0\" pass=\"0\">\n       <Option "
             "type=\"Map\">\n" +
             option("color", rgba(style.color, style.opacity)) + option("outline_color", solid) +
             option("outline_style", "solid") + option("outline_width", width) + option("outline_width_unit", "MM") +
             option("style", "solid");
    case LayerKind::lines:
      return "      <layer class=\"SimpleLine\" enabled=\"1\" locked=\"0\" pass=\"0\">\n       <Option "
             "type=\"Map\">\n" +
             option("line_color", solid) + option("line_style", "solid") + option("line_width", width) +
             option("line_width_unit", "MM");
    case LayerKind::points:
      return "      <layer class=\"SimpleMarker\" enabled=\"1\" locked=\"0\" pass=\"0\">\n       <Option "
             "type=\"Map\">\n" +
             option("color", solid) + option("name", "circle") + option("outline_color", "0,0,0,255") +
             option("size", width) + option("size_unit", "MM");
  }
  return "";
}

std::string labels(const std::string& attribute) {
  return fmt::format(
      " <labeling type=\"simple\">\n  <settings calloutType=\"simple\">\n"
      "   <text-style fieldName=\"{}\" isExpression=\"0\" fontSize=\"9\" textColor=\"0,0,0,255\"/>\n"
      "  </settings>\n </labeling>\n",
      escaped(attribute));
}

}  // namespace

std::vector<ColorStop> even_stops(double low, double high) {
  std::vector<ColorStop> stops;
  constexpr auto last = static_cast<double>(std::size(viridis) - 1);
  for (std::size_t k = 0; k < std::size(viridis); ++k) {
    stops.push_back({low + (high - low) * static_cast<double>(k) / last, viridis[k]});
  }
  return stops;
}

std::vector<ColorStop> diverging_stops(double largest) {
  return {{-largest, {0, 114, 178}}, {0.0, {247, 247, 247}}, {largest, {213, 94, 0}}};
}

void write_raster_style(const std::string& file, const std::vector<ColorStop>& stops, const std::string& unit,
                        double nothing_below) {
  THAWSLIDE_ASSERT(stops.size() >= 2, "{} stops of colour", stops.size());
  std::string items;
  const auto add = [&](double value, const Color& color, int alpha) {
    items += fmt::format(
        "     <item value=\"{0:.9g}\" label=\"{0:.4g}{1}\" color=\"#{2:02x}{3:02x}{4:02x}\" alpha=\"{5}\"/>\n", value,
        unit.empty() ? "" : " " + escaped(unit), color[0], color[1], color[2], alpha);
  };
  for (const ColorStop& stop : stops) {
    add(stop.value, stop.color, 255);
  }
  const double low = stops.front().value, high = stops.back().value;
  // QGIS does not draw values listed in `rasterTransparency`.
  const std::string left_out =
      std::isfinite(nothing_below)
          ? fmt::format(
                "   <rasterTransparency>\n    <singleValuePixelList>\n     <pixelListEntry min=\"-1e+38\" "
                "max=\"{:.9g}\" percentTransparent=\"100\"/>\n    </singleValuePixelList>\n"
                "   </rasterTransparency>\n",
                nothing_below)
          : "";
  write_file_atomically(
      file, fmt::format("{}<qgis version=\"3.22\" styleCategories=\"Symbology\">\n <pipe>\n"
                        "  <rasterrenderer type=\"singlebandpseudocolor\" band=\"1\" opacity=\"0.85\" "
                        "classificationMin=\"{:.9g}\" classificationMax=\"{:.9g}\" nodataColor=\"\" alphaBand=\"-1\">\n"
                        "{}   <rastershader>\n    <colorrampshader colorRampType=\"INTERPOLATED\" "
                        "classificationMode=\"1\" clip=\"0\" minimumValue=\"{:.9g}\" maximumValue=\"{:.9g}\">\n{}"
                        "    </colorrampshader>\n   </rastershader>\n  </rasterrenderer>\n </pipe>\n</qgis>\n",
                        opening, low, high, left_out, low, high, items));
}

std::string vector_style(const VectorStyle& style) {
  constexpr const char* symbols[] = {"fill", "line", "marker"};
  constexpr int geometries[] = {2, 1, 0};
  const auto kind = static_cast<std::size_t>(style.kind);
  return fmt::format(
      "{}<qgis version=\"3.22\" styleCategories=\"Symbology|Labeling\" "
      "labelsEnabled=\"{}\">\n <renderer-v2 type=\"singleSymbol\" forceraster=\"0\" "
      "enableorderby=\"0\">\n  <symbols>\n   <symbol type=\"{}\" name=\"0\" alpha=\"1\" "
      "clip_to_extent=\"1\">\n{}       </Option>\n      </layer>\n   </symbol>\n  </symbols>\n"
      " </renderer-v2>\n{} <layerGeometryType>{}</layerGeometryType>\n</qgis>\n",
      opening, style.label.empty() ? 0 : 1, symbols[kind], symbol_layer(style),
      style.label.empty() ? "" : labels(style.label), geometries[kind]);
}

void write_vector_style(const std::string& file, const VectorStyle& style) {
  write_file_atomically(file, vector_style(style));
}

}  // namespace thawslide::gis
