#include "gis/map_classes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "base/error.hpp"

namespace thawslide::gis {

namespace {

// Colour maps of Matplotlib and ColorBrewer in nine colours. Those of ColorBrewer begin above their lightest colour.
using Palette = std::array<Color, 9>;
constexpr Palette yellow_orange_red{{{255, 241, 169},
                                     {254, 223, 131},
                                     {254, 193, 93},
                                     {253, 159, 68},
                                     {253, 116, 53},
                                     {244, 62, 38},
                                     {219, 20, 30},
                                     {182, 0, 38},
                                     {128, 0, 38}}};
constexpr Palette viridis{{{68, 1, 84},
                           {71, 45, 123},
                           {59, 82, 139},
                           {44, 114, 142},
                           {33, 145, 140},
                           {40, 174, 128},
                           {94, 201, 98},
                           {173, 220, 48},
                           {253, 231, 37}}};
constexpr Palette cividis{{{0, 34, 78},
                           {26, 56, 111},
                           {67, 78, 108},
                           {97, 101, 111},
                           {125, 124, 120},
                           {155, 148, 118},
                           {188, 174, 108},
                           {222, 201, 88},
                           {254, 232, 56}}};
constexpr Palette magma_reversed{{{252, 253, 191},
                                  {254, 194, 135},
                                  {251, 135, 97},
                                  {229, 80, 100},
                                  {181, 54, 122},
                                  {129, 37, 129},
                                  {79, 18, 123},
                                  {28, 16, 68},
                                  {0, 0, 4}}};
constexpr Palette plasma{{{13, 8, 135},
                          {76, 2, 161},
                          {126, 3, 168},
                          {170, 35, 149},
                          {204, 71, 120},
                          {230, 108, 92},
                          {248, 149, 64},
                          {253, 197, 39},
                          {240, 249, 33}}};
constexpr Palette yellow_green_blue{{{241, 250, 186},
                                     {211, 238, 179},
                                     {156, 216, 184},
                                     {95, 193, 192},
                                     {51, 167, 194},
                                     {31, 130, 185},
                                     {35, 85, 164},
                                     {33, 49, 141},
                                     {8, 29, 88}}};
constexpr Palette red_blue{{{103, 0, 31},
                            {187, 42, 52},
                            {229, 131, 104},
                            {251, 206, 183},
                            {246, 247, 247},
                            {192, 220, 235},
                            {104, 171, 208},
                            {40, 112, 177},
                            {5, 48, 97}}};
constexpr Color light_yellow{255, 237, 160}, orange{254, 178, 76}, red{240, 59, 32}, dark_red{128, 0, 38};

constexpr double infinity = std::numeric_limits<double>::infinity();

// Colour at a fraction of a palette, by linear interpolation.
Color color_at(const Palette& palette, double fraction) {
  const double position = fraction * static_cast<double>(palette.size() - 1);
  const auto first = std::min(static_cast<std::size_t>(position), palette.size() - 2);
  const double weight = position - static_cast<double>(first);
  Color color{};
  for (std::size_t k = 0; k < color.size(); ++k) {
    color[k] =
        static_cast<std::uint8_t>(std::lround((1.0 - weight) * palette[first][k] + weight * palette[first + 1][k]));
  }
  return color;
}

// Classes between limits in the unit of the label, and beyond the last one.
std::vector<ColorClass> classes_between(const std::vector<double>& limits, double unit_size, const Palette& palette) {
  std::vector<ColorClass> classes;
  const auto last = static_cast<double>(limits.size());
  for (std::size_t k = 0; k <= limits.size(); ++k) {
    classes.push_back(
        {k < limits.size() ? limits[k] * unit_size : infinity, color_at(palette, static_cast<double>(k) / last)});
  }
  return classes;
}

RasterStyle positive(const std::vector<double>& limits, const char* unit, double unit_size, const Palette& palette) {
  return {classes_between(limits, unit_size, palette), 0.0, unit, unit_size, true};
}

RasterStyle change_of_elevation() {
  RasterStyle style{classes_between({-20, -10, -5, -2, -0.5, 0.5, 2, 5, 10, 20}, 1.0, red_blue), -infinity, "m", 1.0,
                    false};
  style.classes[style.classes.size() / 2].is_drawn = false;  // around 0
  return style;
}

}  // namespace

RasterStyle style_of_map(const std::string& name) {
  const RasterStyle thickness = positive({0.5, 1, 2, 5, 10, 20, 50, 100}, "m", 1.0, yellow_orange_red);
  const std::map<std::string, RasterStyle> styles{
      {"release", thickness},
      {"max_thickness", thickness},
      {"final_thickness", thickness},
      {"max_speed", positive({5, 10, 20, 30, 40, 60, 80, 100}, "m/s", 1.0, viridis)},
      {"max_momentum_flux", positive({10, 100, 1e3, 1e4, 1e5}, "m3/s2", 1.0, viridis)},
      {"max_pressure", positive({3, 10, 30, 100, 300, 1000, 3000}, "kPa", 1e3, magma_reversed)},
      {"max_pressure_time", {classes_between({5, 10, 20, 30, 60, 90, 120, 180}, 1.0, cividis), 0.0, "s", 1.0, false}},
      {"arrival_time", {classes_between({5, 10, 20, 30, 60, 90, 120, 180}, 1.0, cividis), 0.0, "s", 1.0, false}},
      {"elevation_change", change_of_elevation()},
      {"max_basal_temperature",
       {classes_between({-20, -10, -5, -1, 0, 20, 100, 300}, 1.0, plasma), -infinity, "°C", 1.0, false}},
      {"max_melt", positive({1, 2, 5, 10, 20, 50, 100, 1000}, "mm", 1e-3, yellow_green_blue)},
      {"max_pore_pressure", positive({10, 30, 100, 300, 1000, 3000}, "kPa", 1e3, viridis)},
  };
  const auto found = styles.find(name);
  THAWSLIDE_ASSERT(found != styles.end(), "no style of the map {}", name);
  return found->second;
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
