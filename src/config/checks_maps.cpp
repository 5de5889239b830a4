// Checks of map inputs: a DEM as the ground, releases, initial fields of bodies, probes.
#include <fmt/format.h>

#include <algorithm>

#include "base/rounding.hpp"
#include "config/checks.hpp"
#include "config/input_limits.hpp"
#include "physics/freezing.hpp"
#include "physics/mixture.hpp"

namespace thawslide::config {

namespace {

constexpr double absolute_zero = -273.15;  // C

void check_dem(const Case& checked, Reading& reading) {
  if (checked.terrain.kind != TerrainKind::dem || !reading.are_valid({"terrain.type"})) {
    return;
  }
  if (checked.general.dimension != 3) {
    reading.report_misfit({"terrain.type", "case.dimension"},
                          "terrain.type is \"dem\", and case.dimension is 2; a DEM is the ground of a 3D case. Set "
                          "case.dimension = 3, or cut a 2D case out of the DEM with `thawslide section`.");
  }
}

void check_release(const Case& checked, const Body& body, const std::string& table, Reading& reading) {
  if (reading.are_valid({"terrain.type"}) && checked.terrain.kind != TerrainKind::dem) {
    reading.report_misfit(
        {table + ".shape", "terrain.type"},
        fmt::format("{}.shape is \"release\", and terrain.type is not \"dem\"; a release lies on a DEM, "
                    "or in it. Set terrain.type = \"dem\" and terrain.file, or use another shape.",
                    table));
  }
  if (body.thickness.from != MapValue::From::surface || !reading.are_valid({table + ".thickness"})) {
    return;
  }
  if (body.thickness_along == ThicknessAlong::normal && reading.are_valid({table + ".thickness_along"})) {
    reading.report_misfit({table + ".thickness_along", table + ".thickness"},
                          fmt::format("{}.thickness_along is \"normal\", and {}.thickness is the difference of two "
                                      "surfaces, which is vertical. Set {}.thickness_along = \"vertical\".",
                                      table, table, table));
  }
  if (body.placement == Placement::cut && reading.are_valid({table + ".placement"})) {
    reading.report_misfit({table + ".placement", table + ".thickness"},
                          fmt::format("{}.placement is \"cut\", and {}.thickness is what a surface has above the DEM; "
                                      "that lies on the DEM. Set {}.placement = \"on_top\".",
                                      table, table, table));
  }
}

void check_field(const Body& body, const InitialField& field, const std::string& table, const std::string& key,
                 Reading& reading) {
  const std::string name = table + "." + key;
  if (!field.is_map() || !reading.are_valid({name, table + ".shape", table + ".release"})) {
    return;
  }
  const bool is_raster = field.over == InitialField::Over::raster;
  if (body.shape != BodyShape::release) {
    reading.report_misfit(
        {name, table + ".shape"},
        fmt::format("{} is {}, and {}.shape is not \"release\"; only a release takes it from maps. Give "
                    "a number or a table over depth or x.",
                    name, is_raster ? "a raster" : "an attribute of polygons", table));
  } else if (!is_raster && body.release.empty()) {
    reading.report_misfit(
        {name, table + ".release"},
        fmt::format("{} is the attribute \"{}\", and {}.release is not given; there are no polygons to "
                    "have it. Give the file of polygons, or a number, a table or a raster.",
                    name, shown(field.source), table));
  }
}

double saturation_at(const Freezing& freezing, double temperature) {
  return freezing.curve == CurveKind::power_law
             ? physics::PowerLawCurve{freezing.reference_temperature, freezing.exponent}.saturation(temperature)
             : physics::LinearCurve{freezing.reference_temperature, freezing.slope}.saturation(temperature);
}

// Checks that the freezing curve has a temperature for the saturation.
void check_saturation(const Case& checked, const Body& body, const std::string& table, Reading& reading) {
  const std::string key = table + ".saturation";
  if (!body.saturation.is_given() || body.saturation.is_map() || !reading.are_valid({key}) ||
      !reading.are_valid({"freezing.curve", "freezing.exponent", "freezing.slope", "freezing.reference_temperature"})) {
    return;
  }
  const std::vector<double>& values = body.saturation.table.value;
  const double lowest = *std::min_element(values.begin(), values.end());
  const double coldest = saturation_at(checked.freezing, absolute_zero);
  if (lowest < coldest) {
    reading.report_misfit(
        {key, "freezing.curve"},
        fmt::format("{} is {}, and the freezing curve does not fall so low: at {} C it is {:.3g}. Give "
                    "more water, or a temperature instead.",
                    key, lowest, absolute_zero, coldest));
  }
}

// Checks the porosity that follows from an ice content if both are single numbers. Maps and tables are checked for each
// particle when the body is created.
void check_ice_content(const Case& checked, const Body& body, const std::string& table, Reading& reading) {
  const std::string key = table + ".ice_content";
  const bool by_saturation = body.saturation.is_given();
  const std::string water_key = table + (by_saturation ? ".saturation" : ".temperature");
  const InitialField& water = by_saturation ? body.saturation : body.temperature;
  const auto is_number = [](const InitialField& field) {
    return field.over == InitialField::Over::nothing && field.is_given();
  };
  if (!is_number(body.ice_content) || !is_number(water) || !reading.are_valid({key, water_key, "freezing.curve"})) {
    return;
  }
  const double ice = body.ice_content.table.value.front();
  const double given = water.table.value.front();
  const double saturation = by_saturation ? given : saturation_at(checked.freezing, given);
  const double most = physics::largest_porosity * (1.0 - saturation);
  if (ice > most) {
    reading.report_misfit(
        {key, water_key},
        fmt::format("{} is {}, and the saturation is {:.3g}; the porosity, ice_content / (1 - saturation), must not "
                    "exceed {}. Allowed with it: at most {:.4g}. Give less ice, or less water.",
                    key, ice, saturation, physics::largest_porosity, most > 0.0 ? rounded_down(most, 4) : most));
  }
}

// A file of a line requires the DEM's coordinate system.
void check_line(const Case& checked, const std::string& key, const std::string& file, Reading& reading) {
  if (checked.general.dimension == 3 && !file.empty() && checked.terrain.kind != TerrainKind::dem &&
      reading.are_valid({"terrain.type", key})) {
    reading.report_misfit({key, "terrain.type"},
                          fmt::format("{} is given, and terrain.type is not \"dem\"; a file of a line needs the "
                                      "coordinate system of a DEM. Remove {}, or set terrain.type = \"dem\".",
                                      key, key));
  }
}

void check_probe(const Case& checked, const Probe& probe, const std::string& table, Reading& reading) {
  if (checked.general.dimension != 3) {
    reading.report_misfit(
        {table, "case.dimension"},
        fmt::format("[{}] has a meaning only in three dimensions, and case.dimension is 2. Remove it.", table));
  } else if (reading.are_valid({table + ".point", table + ".line"}) && !probe.line.empty() &&
             reading.is_given(table + ".point")) {
    reading.report_misfit({table + ".line", table + ".point"},
                          fmt::format("{}.point and {}.line are both given; allowed: one of them, since a probe is a "
                                      "place or a cross section. Remove one, or write two probes.",
                                      table, table));
  }
}

}  // namespace

void check_maps(const Case& checked, Reading& reading) {
  check_dem(checked, reading);
  for (const auto& [name, body] : checked.bodies) {
    const std::string table = "body." + name;
    if (body.shape == BodyShape::release && reading.are_valid({table + ".shape"})) {
      check_release(checked, body, table, reading);
    }
    check_field(body, body.temperature, table, "temperature", reading);
    check_field(body, body.saturation, table, "saturation", reading);
    check_field(body, body.porosity, table, "porosity", reading);
    check_field(body, body.ice_content, table, "ice_content", reading);
    check_saturation(checked, body, table, reading);
    check_ice_content(checked, body, table, reading);
  }
  check_line(checked, "maps.path", checked.maps.path, reading);
  for (const auto& [name, probe] : checked.probes) {
    check_probe(checked, probe, "probe." + name, reading);
    check_line(checked, "probe." + name + ".line", probe.line, reading);
  }
}

}  // namespace thawslide::config
