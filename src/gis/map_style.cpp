#include "gis/map_style.hpp"

#include <cpl_string.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "gis/gdal_messages.hpp"

namespace thawslide::gis {

namespace {

constexpr const char* opening = "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n";

std::string escaped(const std::string& text) { return released(CPLEscapeString(text.c_str(), -1, CPLES_XML)); }

std::string rgba(const Color& color, double opacity) {
  return fmt::format("{},{},{},{}", color[0], color[1], color[2], std::lround(255.0 * opacity));
}

// Symbol of a kind of layer, its type of geometry, and options with the colours of fill and line and the width.
struct Symbol {
  const char *kind, *layer;
  int geometry;
  const char* options;
};
constexpr Symbol symbols[] = {
    {"fill", "SimpleFill", 2,
     "color={0} outline_color={1} outline_style=solid outline_width={2:g} outline_width_unit=MM style=solid"},
    {"line", "SimpleLine", 1, "line_color={1} line_style=solid line_width={2:g} line_width_unit=MM"},
    {"marker", "SimpleMarker", 0, "color={1} name=circle outline_color=0,0,0,255 size={2:g} size_unit=MM"},
};

// "below 1 m", "1 to 2 m", "above 2 m".
std::string class_label(double low, double high, const RasterStyle& style) {
  const double size = style.unit_size;
  return !std::isfinite(high) ? fmt::format("above {:g} {}", low / size, style.unit)
         : std::isfinite(low) ? fmt::format("{:g} to {:g} {}", low / size, high / size, style.unit)
                              : fmt::format("below {:g} {}", high / size, style.unit);
}

// Colour maps of Matplotlib and ColorBrewer in nine colours. Those of ColorBrewer begin above their lightest colour.
using Palette = std::array<unsigned, 9>;  // 0xRRGGBB
constexpr Palette yellow_orange_red{0xfff1a9, 0xfedf83, 0xfec15d, 0xfd9f44, 0xfd7435,
                                    0xf43e26, 0xdb141e, 0xb60026, 0x800026};
constexpr Palette viridis{0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c, 0x28ae80, 0x5ec962, 0xaddc30, 0xfde725};
constexpr Palette cividis{0x00224e, 0x1a386f, 0x434e6c, 0x61656f, 0x7d7c78, 0x9b9476, 0xbcae6c, 0xdec958, 0xfee838};
constexpr Palette magma_reversed{0xfcfdbf, 0xfec287, 0xfb8761, 0xe55064, 0xb5367a,
                                 0x812581, 0x4f127b, 0x1c1044, 0x000004};
constexpr Palette plasma{0x0d0887, 0x4c02a1, 0x7e03a8, 0xaa2395, 0xcc4778, 0xe66c5c, 0xf89540, 0xfdc527, 0xf0f921};
constexpr Palette yellow_green_blue{0xf1faba, 0xd3eeb3, 0x9cd8b8, 0x5fc1c0, 0x33a7c2,
                                    0x1f82b9, 0x2355a4, 0x21318d, 0x081d58};
constexpr Palette red_blue{0x67001f, 0xbb2a34, 0xe58368, 0xfbceb7, 0xf6f7f7, 0xc0dceb, 0x68abd0, 0x2870b1, 0x053061};
constexpr Color light_yellow{255, 237, 160}, orange{254, 178, 76}, red{240, 59, 32}, dark_red{128, 0, 38};

constexpr double infinity = std::numeric_limits<double>::infinity();

// Colour at a fraction of a palette, by linear interpolation.
Color color_at(const Palette& palette, double fraction) {
  const double position = fraction * static_cast<double>(palette.size() - 1);
  const auto first = std::min(static_cast<std::size_t>(position), palette.size() - 2);
  const double weight = position - static_cast<double>(first);
  Color color{};
  for (std::size_t k = 0; k < color.size(); ++k) {
    const auto part = [&](unsigned whole) { return (whole >> (16 - 8 * k)) & 0xffU; };
    color[k] = static_cast<std::uint8_t>(
        std::lround((1.0 - weight) * part(palette[first]) + weight * part(palette[first + 1])));
  }
  return color;
}

// Classes of maps, between limits in the unit of the label and beyond the last one.
struct MapClasses {
  const char* maps;  // names between spaces
  std::vector<double> limits;
  const char* unit;
  double unit_size;
  const Palette& palette;
  double lowest = 0.0;
  bool hides_zero = true;
};

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
  const Symbol& symbol = symbols[static_cast<std::size_t>(style.kind)];
  std::istringstream words(
      fmt::format(fmt::runtime(symbol.options), rgba(style.color, style.opacity), rgba(style.color, 1.0), style.width));
  std::string options, labels;
  for (std::string name, value; std::getline(words, name, '=') && std::getline(words, value, ' ');) {
    options += fmt::format("        <Option type=\"QString\" name=\"{}\" value=\"{}\"/>\n", name, value);
  }
  if (!style.label.empty()) {
    labels = fmt::format(
        " <labeling type=\"simple\">\n  <settings calloutType=\"simple\">\n"
        "   <text-style fieldName=\"{}\" isExpression=\"0\" fontSize=\"9\" textColor=\"0,0,0,255\"/>\n"
        "  </settings>\n </labeling>\n",
        escaped(style.label));
  }
  return fmt::format(
      "{}<qgis version=\"3.22\" styleCategories=\"Symbology|Labeling\" "
      "labelsEnabled=\"{}\">\n <renderer-v2 type=\"singleSymbol\" forceraster=\"0\" "
      "enableorderby=\"0\">\n  <symbols>\n   <symbol type=\"{}\" name=\"0\" alpha=\"1\" "
      "clip_to_extent=\"1\">\n      <layer class=\"{}\" enabled=\"1\" locked=\"0\" pass=\"0\">\n"
      "       <Option type=\"Map\">\n{}       </Option>\n      </layer>\n   </symbol>\n  </symbols>\n"
      " </renderer-v2>\n{} <layerGeometryType>{}</layerGeometryType>\n</qgis>\n",
      opening, labels.empty() ? 0 : 1, symbol.kind, symbol.layer, options, labels, symbol.geometry);
}

RasterStyle style_of_map(const std::string& name) {
  static const MapClasses all[] = {
      {" release max_thickness final_thickness ", {0.5, 1, 2, 5, 10, 20, 50, 100}, "m", 1.0, yellow_orange_red},
      {" max_speed ", {5, 10, 20, 30, 40, 60, 80, 100}, "m/s", 1.0, viridis},
      {" max_momentum_flux ", {10, 100, 1e3, 1e4, 1e5}, "m3/s2", 1.0, viridis},
      {" max_pressure ", {3, 10, 30, 100, 300, 1000, 3000}, "kPa", 1e3, magma_reversed},
      {" max_pressure_time arrival_time ", {5, 10, 20, 30, 60, 90, 120, 180}, "s", 1.0, cividis, 0.0, false},
      {" elevation_change ", {-20, -10, -5, -2, -0.5, 0.5, 2, 5, 10, 20}, "m", 1.0, red_blue, -infinity, false},
      {" max_basal_temperature ", {-20, -10, -5, -1, 0, 20, 100, 300}, "°C", 1.0, plasma, -infinity, false},
      {" max_melt ", {1, 2, 5, 10, 20, 50, 100, 1000}, "mm", 1e-3, yellow_green_blue},
      {" max_pore_pressure ", {10, 30, 100, 300, 1000, 3000}, "kPa", 1e3, viridis},
  };
  const auto* const found = std::ranges::find_if(all, [&](const MapClasses& each) {
    return std::string_view(each.maps).find(" " + name + " ") != std::string::npos;
  });
  THAWSLIDE_ASSERT(found != std::end(all), "no style of the map {}", name);
  RasterStyle style{{}, found->lowest, found->unit, found->unit_size, found->hides_zero};
  const std::size_t last = found->limits.size();
  for (std::size_t k = 0; k <= last; ++k) {
    style.classes.push_back({k < last ? found->limits[k] * found->unit_size : infinity,
                             color_at(found->palette, static_cast<double>(k) / static_cast<double>(last)),
                             name != "elevation_change" || 2 * k != last});  // not around 0
  }
  return style;
}

RasterStyle hazard_style_of_map(const std::string& name) {
  if (name == "max_thickness") {
    return {{{0.5, light_yellow}, {1.0, orange}, {2.0, red}, {infinity, dark_red}}, 0.0, "m", 1.0, true};
  }
  if (name == "max_pressure") {
    return {{{3e3, light_yellow}, {30e3, orange}, {infinity, dark_red}}, 0.0, "kPa", 1e3, true};
  }
  return {};
}

}  // namespace thawslide::gis
