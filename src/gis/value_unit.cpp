// Units of the values of rasters.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>

#include "base/error.hpp"
#include "base/text.hpp"
#include "config/input_limits.hpp"
#include "gis/raster_file.hpp"

namespace thawslide::gis {

namespace {

constexpr double survey_foot = 1200.0 / 3937.0;  // m, US survey foot

// Spellings in lower case without spaces and punctuation, and the conversion to the unit of the computation.
struct Unit {
  Quantity quantity;
  std::string_view spellings;
  double factor, offset = 0.0;
};

// clang-format off
constexpr Unit units[] = {
    {Quantity::length, "m metre metres meter meters masl mamsl", 1.0},
    {Quantity::length, "mm millimetre millimetres millimeter millimeters", 1e-3},
    {Quantity::length, "cm centimetre centimetres centimeter centimeters", 1e-2},
    {Quantity::length, "dm decimetre decimetres decimeter decimeters", 0.1},
    {Quantity::length, "km kilometre kilometres kilometer kilometers", 1e3},
    {Quantity::length, "in inch inches", 0.0254},
    {Quantity::length, "ft foot feet internationalfoot internationalfeet footintl", 0.3048},
    {Quantity::length, "yd yard yards", 0.9144},
    {Quantity::length, "usft ftus footus usfoot usfeet ussurveyft ussurveyfoot ussurveyfeet footussurvey surveyfoot "
                       "surveyfeet", survey_foot},
    {Quantity::temperature, "c °c degc celsius degreecelsius degreescelsius", 1.0},
    {Quantity::temperature, "k kelvin degk degreekelvin degreeskelvin", 1.0, -273.15},
    {Quantity::temperature, "f °f degf fahrenheit degreefahrenheit degreesfahrenheit", 5.0 / 9.0, -160.0 / 9.0},
    {Quantity::fraction, "1 fraction ratio m3/m3 m3m3", 1.0}, {Quantity::fraction, "% percent percentage", 0.01},
    {Quantity::speed, "m/s ms1 mps", 1.0}, {Quantity::speed, "cm/s", 0.01}, {Quantity::speed, "mm/s", 1e-3},
    {Quantity::speed, "km/h kmh kmh1 kph", 1.0 / 3.6}, {Quantity::speed, "ft/s", 0.3048},
    {Quantity::speed, "mph mi/h", 0.44704}, {Quantity::speed, "kn", 1852.0 / 3600},
    {Quantity::time, "s sec second seconds", 1.0}, {Quantity::time, "ms", 1e-3},
    {Quantity::time, "min minute minutes", 60.0}, {Quantity::time, "h hr hour hours", 3600.0},
};
// clang-format on

struct TextsOfQuantity {
  const char* of;       // quantity of the unit
  const char* allowed;  // examples of allowed units
  const char* own;      // unit of the computation, for messages
  const char* short_own;
};

const std::map<Quantity, TextsOfQuantity> texts_of{
    {Quantity::length, {"length", "m, mm, cm, dm, km, in, ft, US survey foot, yd", "metres", "m"}},
    {Quantity::temperature, {"temperature", "C, K, F", "degrees Celsius", "C"}},
    {Quantity::fraction, {"fraction", "1, %", "fractions of 1", "1"}},
    {Quantity::speed, {"speed", "m/s, cm/s, mm/s, km/h, ft/s, mph, kn", "m/s", "m/s"}},
    {Quantity::time, {"time", "s, ms, min, h", "seconds", "s"}}};

std::string simplified(const std::string& unit) {
  std::string simple = lower_case(unit);
  std::erase_if(simple, [](char c) { return std::string_view(" ._-^()[]").find(c) != std::string_view::npos; });
  return simple;
}

// A unit such as "unknown" counts as not stated.
bool states_nothing(const std::string& unit) {
  const std::string simple = simplified(unit);
  return simple.empty() || simple == "unknown" || simple == "unspecified" || simple == "none";
}

std::optional<Unit> known_unit(const std::string& unit, Quantity quantity) {
  const std::string word = " " + simplified(unit) + " ";
  const Unit* const found = std::find_if(std::begin(units), std::end(units), [&](const Unit& each) {
    return each.quantity == quantity && fmt::format(" {} ", each.spellings).find(word) != std::string::npos;
  });
  return found == std::end(units) ? std::nullopt : std::optional<Unit>(*found);
}

}  // namespace

UnitConversion conversion_from(const StatedUnits& stated, Quantity quantity) {
  // GDAL reports the vertical unit for a band without a unit, whatever the band measures.
  const bool is_vertical = states_nothing(stated.band) || stated.band == stated.vertical;
  if (quantity == Quantity::code ||
      (is_vertical && (quantity != Quantity::length || states_nothing(stated.vertical)))) {
    return {};
  }
  const TextsOfQuantity& texts = texts_of.at(quantity);
  const std::optional<Unit> found =
      is_vertical ? Unit{quantity, "", stated.vertical_metres} : known_unit(stated.band, quantity);
  if (!found) {
    throw UserError(
        "{}: the unit of the values is '{}'; allowed: a unit of {} ({}). Check that it is the right file, or "
        "state the unit that the values have: gdal_edit.py -units {} {}",
        stated.file, config::shown(stated.band), texts.of, texts.allowed, texts.short_own, shell_quote(stated.file));
  }
  constexpr double agreement = 1e-5;  // relative; the two kinds of feet differ by less
  if (quantity == Quantity::length && !states_nothing(stated.vertical) &&
      std::abs(found->factor / stated.vertical_metres - 1.0) > agreement) {
    throw UserError(
        "{}: two units are stated for the values: '{}' by the band, '{}' by the heights of the coordinate reference "
        "system; allowed: one. State the right one in both: gdal_edit.py -units m -a_srs EPSG:... {}",
        stated.file, config::shown(stated.band), config::shown(stated.vertical), shell_quote(stated.file));
  }
  UnitConversion conversion{found->factor, found->offset, ""};
  if (found->factor != 1.0 || found->offset != 0.0) {
    conversion.warning =
        fmt::format("note: {} states the unit '{}': its values were converted to {}", name_of_file(stated.file),
                    config::shown(is_vertical ? stated.vertical : stated.band), texts.own);
  }
  return conversion;
}

}  // namespace thawslide::gis
