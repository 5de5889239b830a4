#include "gis/value_unit.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>

#include "base/error.hpp"
#include "base/shell_quote.hpp"
#include "config/input_limits.hpp"

namespace thawslide::gis {

namespace {

constexpr double survey_foot = 1200.0 / 3937.0;  // m, US survey foot

// Spelling in lower case, without spaces, points, brackets, underscores and hyphens.
struct Spelling {
  const char* word;
  double factor, offset = 0.0;
};

constexpr Spelling lengths[] = {
    {"m", 1.0},
    {"metre", 1.0},
    {"metres", 1.0},
    {"meter", 1.0},
    {"meters", 1.0},
    {"masl", 1.0},
    {"mamsl", 1.0},
    {"mm", 1e-3},
    {"millimetre", 1e-3},
    {"millimetres", 1e-3},
    {"millimeter", 1e-3},
    {"millimeters", 1e-3},
    {"cm", 1e-2},
    {"centimetre", 1e-2},
    {"centimetres", 1e-2},
    {"centimeter", 1e-2},
    {"centimeters", 1e-2},
    {"dm", 0.1},
    {"decimetre", 0.1},
    {"decimetres", 0.1},
    {"decimeter", 0.1},
    {"decimeters", 0.1},
    {"km", 1e3},
    {"kilometre", 1e3},
    {"kilometres", 1e3},
    {"kilometer", 1e3},
    {"kilometers", 1e3},
    {"in", 0.0254},
    {"inch", 0.0254},
    {"inches", 0.0254},
    {"ft", 0.3048},
    {"foot", 0.3048},
    {"feet", 0.3048},
    {"internationalfoot", 0.3048},
    {"internationalfeet", 0.3048},
    {"footintl", 0.3048},
    {"yd", 0.9144},
    {"yard", 0.9144},
    {"yards", 0.9144},
    {"usft", survey_foot},
    {"ftus", survey_foot},
    {"footus", survey_foot},
    {"usfoot", survey_foot},
    {"usfeet", survey_foot},
    {"ussurveyft", survey_foot},
    {"ussurveyfoot", survey_foot},
    {"ussurveyfeet", survey_foot},
    {"footussurvey", survey_foot},
    {"surveyfoot", survey_foot},
    {"surveyfeet", survey_foot},
};

constexpr double kelvin_offset = -273.15, fahrenheit_factor = 5.0 / 9.0, fahrenheit_offset = -160.0 / 9.0;

constexpr Spelling temperatures[] = {
    {"c", 1.0},
    {"°c", 1.0},
    {"degc", 1.0},
    {"celsius", 1.0},
    {"degreecelsius", 1.0},
    {"degreescelsius", 1.0},
    {"k", 1.0, kelvin_offset},
    {"kelvin", 1.0, kelvin_offset},
    {"degk", 1.0, kelvin_offset},
    {"degreekelvin", 1.0, kelvin_offset},
    {"degreeskelvin", 1.0, kelvin_offset},
    {"f", fahrenheit_factor, fahrenheit_offset},
    {"°f", fahrenheit_factor, fahrenheit_offset},
    {"degf", fahrenheit_factor, fahrenheit_offset},
    {"fahrenheit", fahrenheit_factor, fahrenheit_offset},
    {"degreefahrenheit", fahrenheit_factor, fahrenheit_offset},
    {"degreesfahrenheit", fahrenheit_factor, fahrenheit_offset},
};

constexpr Spelling fractions[] = {
    {"1", 1.0},    {"fraction", 1.0}, {"ratio", 1.0},    {"m3/m3", 1.0},
    {"m3m3", 1.0}, {"%", 0.01},       {"percent", 0.01}, {"percentage", 0.01},
};

// clang-format off
constexpr Spelling speeds[] = {
    {"m/s", 1.0}, {"ms1", 1.0}, {"mps", 1.0}, {"cm/s", 0.01}, {"mm/s", 1e-3}, {"km/h", 1.0 / 3.6}, {"kmh", 1.0 / 3.6},
    {"kmh1", 1.0 / 3.6}, {"kph", 1.0 / 3.6}, {"ft/s", 0.3048}, {"mph", 0.44704}, {"mi/h", 0.44704}, {"kn", 1852.0 / 3600},
};

constexpr Spelling times[] = {
    {"s", 1.0}, {"sec", 1.0}, {"second", 1.0}, {"seconds", 1.0}, {"ms", 1e-3}, {"min", 60.0}, {"minute", 60.0},
    {"minutes", 60.0}, {"h", 3600.0}, {"hr", 3600.0}, {"hour", 3600.0}, {"hours", 3600.0},
};
// clang-format on

struct UnitsOfQuantity {
  const Spelling* begin;
  const Spelling* end;
  const char* of;       // quantity of the unit
  const char* allowed;  // examples of allowed units
  const char* own;      // unit of the computation, for messages
  const char* short_own;
};

UnitsOfQuantity units_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::temperature:
      return {std::begin(temperatures), std::end(temperatures), "temperature", "C, K, F", "degrees Celsius", "C"};
    case Quantity::fraction:
      return {std::begin(fractions), std::end(fractions), "fraction", "1, %", "fractions of 1", "1"};
    case Quantity::speed:
      return {std::begin(speeds), std::end(speeds), "speed", "m/s, cm/s, mm/s, km/h, ft/s, mph, kn", "m/s", "m/s"};
    case Quantity::time:
      return {std::begin(times), std::end(times), "time", "s, ms, min, h", "seconds", "s"};
    case Quantity::length:
    case Quantity::code:
      break;
  }
  return {
      std::begin(lengths), std::end(lengths), "length", "m, mm, cm, dm, km, in, ft, US survey foot, yd", "metres", "m"};
}

std::string simplified(const std::string& unit) {
  std::string simple;
  for (const char c : unit) {
    const char small = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (std::string(" ._-^()[]").find(small) == std::string::npos) {
      simple += small;
    }
  }
  return simple;
}

// A unit such as "unknown" counts as not stated.
bool states_nothing(const std::string& unit) {
  const std::string simple = simplified(unit);
  return simple.empty() || simple == "unknown" || simple == "unspecified" || simple == "none";
}

std::optional<Spelling> known_unit(const std::string& unit, const UnitsOfQuantity& units) {
  const std::string simple = simplified(unit);
  const Spelling* const found =
      std::find_if(units.begin, units.end, [&](const Spelling& each) { return each.word == simple; });
  return found == units.end ? std::nullopt : std::optional<Spelling>(*found);
}

[[noreturn]] void fail_with_unit(const StatedUnits& stated, const UnitsOfQuantity& units) {
  throw UserError(fmt::format(
      "{}: the unit of the values is '{}'; allowed: a unit of {} ({}). Check that it is the right file, or "
      "state the unit that the values have: gdal_edit.py -units {} {}",
      stated.file, config::shown(stated.band), units.of, units.allowed, units.short_own, shell_quote(stated.file)));
}

void check_that_both_agree(const StatedUnits& stated, double band_metres) {
  constexpr double agreement = 1e-5;  // relative; the two kinds of feet differ by less
  if (!states_nothing(stated.vertical) && std::abs(band_metres / stated.vertical_metres - 1.0) > agreement) {
    throw UserError(fmt::format(
        "{}: two units are stated for the values: '{}' by the band, '{}' by the heights of the coordinate reference "
        "system; allowed: one. State the right one in both: gdal_edit.py -units m -a_srs EPSG:... {}",
        stated.file, config::shown(stated.band), config::shown(stated.vertical), shell_quote(stated.file)));
  }
}

UnitConversion with_warning(const StatedUnits& stated, const std::string& unit, const Spelling& found,
                            const char* own) {
  UnitConversion conversion{found.factor, found.offset, ""};
  if (found.factor != 1.0 || found.offset != 0.0) {
    conversion.warning = fmt::format("note: {} states the unit '{}': its values were converted to {}",
                                     std::filesystem::path(stated.file).filename().string(), config::shown(unit), own);
  }
  return conversion;
}

}  // namespace

UnitConversion conversion_from(const StatedUnits& stated, Quantity quantity) {
  const UnitsOfQuantity units = units_of(quantity);
  // GDAL reports the vertical unit for a band without a unit, whatever the band measures.
  const bool is_vertical = states_nothing(stated.band) || stated.band == stated.vertical;
  if (quantity == Quantity::code || (is_vertical && quantity != Quantity::length)) {
    return {};
  }
  if (is_vertical) {
    return states_nothing(stated.vertical)
               ? UnitConversion{}
               : with_warning(stated, stated.vertical, {"", stated.vertical_metres}, units.own);
  }
  const std::optional<Spelling> found = known_unit(stated.band, units);
  if (!found) {
    fail_with_unit(stated, units);
  }
  if (quantity == Quantity::length) {
    check_that_both_agree(stated, found->factor);
  }
  return with_warning(stated, stated.band, *found, units.own);
}

}  // namespace thawslide::gis
