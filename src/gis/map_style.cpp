#include "gis/map_style.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/atomic_file.hpp"
#include "base/error.hpp"

namespace thawslide::gis {

namespace {

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

// "below 1 m", "1 to 2 m", "above 2 m".
std::string class_label(double low, double high, const RasterStyle& style) {
  const std::string unit = style.unit.empty() ? "" : " " + style.unit;
  const auto number = [&](double value) { return fmt::format("{:g}", value / style.unit_size); };
  if (!std::isfinite(high)) {
    return fmt::format("above {}{}", number(low), unit);
  }
  return std::isfinite(low) ? fmt::format("{} to {}{}", number(low), number(high), unit)
                            : fmt::format("below {}{}", number(high), unit);
}

std::string labels(const std::string& attribute) {
  return fmt::format(
      " <labeling type=\"simple\">\n  <settings calloutType=\"simple\">\n"
      "   <text-style fieldName=\"{}\" isExpression=\"0\" fontSize=\"9\" textColor=\"0,0,0,255\"/>\n"
      "  </settings>\n </labeling>\n",
      escaped(attribute));
}

}  // namespace

void write_raster_style(const std::string& file, const RasterStyle& style) {
  THAWSLIDE_ASSERT(style.classes.size() >= 2, "{} classes of colour", style.classes.size());
  std::string items;
  double low = style.lowest;
  for (const ColorClass& each : style.classes) {
    items += fmt::format("     <item value=\"{}\" label=\"{}\" color=\"#{:02x}{:02x}{:02x}\" alpha=\"{}\"/>\n",
                         std::isfinite(each.upper) ? fmt::format("{:.9g}", each.upper) : "inf",
                         escaped(class_label(low, each.upper, style)), each.color[0], each.color[1], each.color[2],
                         each.is_drawn ? 255 : 0);
    low = each.upper;
  }
  const double first = std::isfinite(style.lowest) ? style.lowest : style.classes.front().upper;
  const double last = style.classes[style.classes.size() - 2].upper;
  // QGIS does not draw values listed in `rasterTransparency`.
  const char* const left_out = style.hides_zero
                                   ? "   <rasterTransparency>\n    <singleValuePixelList>\n     <pixelListEntry "
                                     "min=\"-1e+38\" max=\"0\" percentTransparent=\"100\"/>\n"
                                     "    </singleValuePixelList>\n   </rasterTransparency>\n"
                                   : "";
  write_file_atomically(
      file, fmt::format("{}<qgis version=\"3.22\" styleCategories=\"Symbology\">\n <pipe>\n"
                        "  <rasterrenderer type=\"singlebandpseudocolor\" band=\"1\" opacity=\"0.85\" "
                        "classificationMin=\"{:.9g}\" classificationMax=\"{:.9g}\" nodataColor=\"\" alphaBand=\"-1\">\n"
                        "{}   <rastershader>\n    <colorrampshader colorRampType=\"DISCRETE\" "
                        "classificationMode=\"1\" clip=\"0\" minimumValue=\"{:.9g}\" maximumValue=\"{:.9g}\">\n{}"
                        "    </colorrampshader>\n   </rastershader>\n  </rasterrenderer>\n </pipe>\n</qgis>\n",
                        opening, first, last, left_out, first, last, items));
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

}  // namespace thawslide::gis
