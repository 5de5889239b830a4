// Checks of map inputs: a DEM as the ground, releases, initial fields of bodies, probes.
#include <algorithm>

#include "base/rounding.hpp"
#include "config/checks.hpp"
#include "config/input_limits.hpp"
#include "physics/freezing.hpp"
#include "physics/mixture.hpp"

namespace thawslide::config {

namespace {

constexpr double absolute_zero = -273.15;  // C

void check_release(const Case& checked, const Body& body, const std::string& table, Reading& reading) {
  reading.refuse_if(checked.terrain.kind != TerrainKind::dem, {table + ".shape", "terrain.type"},
                    "{}.shape is \"release\", and terrain.type is not \"dem\"; a release lies on a DEM, or in it. Set "
                    "terrain.type = \"dem\" and terrain.file, or use another shape.",
                    table);
  const bool is_surface = body.thickness.from == MapValue::From::surface;
  reading.refuse_if(is_surface && body.thickness_along == ThicknessAlong::normal,
                    {table + ".thickness_along", table + ".thickness"},
                    "{0}.thickness_along is \"normal\", and {0}.thickness is the difference of two surfaces, which is "
                    "vertical. Set {0}.thickness_along = \"vertical\".",
                    table);
  reading.refuse_if(is_surface && body.placement == Placement::cut, {table + ".placement", table + ".thickness"},
                    "{0}.placement is \"cut\", and {0}.thickness is what a surface has above the DEM; that lies on the "
                    "DEM. Set {0}.placement = \"on_top\".",
                    table);
}

void check_field(const Body& body, const InitialField& field, const std::string& table, const std::string& key,
                 Reading& reading) {
  const std::string name = table + "." + key;
  if (!field.is_map() || !reading.are_valid({name, table + ".shape", table + ".release"})) {
    return;
  }
  const bool is_raster = field.over == InitialField::Over::raster;
  reading.refuse_if(body.shape != BodyShape::release, {name, table + ".shape"},
                    "{} is {}, and {}.shape is not \"release\"; only a release takes it from maps. Give a number or a "
                    "table over depth or x.",
                    name, is_raster ? "a raster" : "an attribute of polygons", table);
  reading.refuse_if(
      !is_raster && body.release.empty(), {name, table + ".release"},
      "{} is the attribute \"{}\", and {}.release is not given; there are no polygons to have it. Give the "
      "file of polygons, or a number, a table or a raster.",
      name, shown(field.source), table);
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
  reading.refuse_if(
      lowest < coldest, {key, "freezing.curve"},
      "{} is {}, and the freezing curve does not fall so low: at {} C it is {:.3g}. Give more water, or a "
      "temperature instead.",
      key, lowest, absolute_zero, coldest);
}

// Checks the porosity from an ice content if both are numbers. Maps and tables are checked for each particle.
void check_ice_content(const Case& checked, const Body& body, const std::string& table, Reading& reading) {
  const std::string key = table + ".ice_content";
  const bool by_saturation = body.saturation.is_given();
  const std::string water_key = table + (by_saturation ? ".saturation" : ".temperature");
  const InitialField& water = by_saturation ? body.saturation : body.temperature;
  const auto is_number = [](const InitialField& field) {
    return field.over == InitialField::Over::nothing && field.is_given();
  };
  if (!is_number(body.ice_content) || !is_number(water) || !reading.are_valid({"freezing.curve"})) {
    return;
  }
  const double ice = body.ice_content.table.value.front();
  const double given = water.table.value.front();
  const double saturation = by_saturation ? given : saturation_at(checked.freezing, given);
  const double most = physics::largest_porosity * (1.0 - saturation);
  reading.refuse_if(ice > most, {key, water_key},
                    "{} is {}, and the saturation is {:.3g}; the porosity, ice_content / (1 - saturation), must not "
                    "exceed {}. Allowed with it: at most {:.4g}. Give less ice, or less water.",
                    key, ice, saturation, physics::largest_porosity, most > 0.0 ? rounded_down(most, 4) : most);
}

// A file of a line requires the DEM's coordinate system.
void check_line(const Case& checked, const std::string& key, const std::string& file, Reading& reading) {
  reading.refuse_if(checked.general.dimension == 3 && !file.empty() && checked.terrain.kind != TerrainKind::dem,
                    {key, "terrain.type"},
                    "{0} is given, and terrain.type is not \"dem\"; a file of a line needs the coordinate system of a "
                    "DEM. Remove {0}, or set terrain.type = \"dem\".",
                    key);
}

void check_probe(const Probe& probe, const std::string& table, Reading& reading) {
  reading.refuse_if(!probe.line.empty() && reading.is_given(table + ".point"), {table + ".line", table + ".point"},
                    "{0}.point and {0}.line are both given; allowed: one of them, since a probe is a place or a cross "
                    "section. Remove one, or write two probes.",
                    table);
}

}  // namespace

void check_maps(const Case& checked, Reading& reading) {
  if (checked.terrain.kind == TerrainKind::dem && checked.general.dimension != 3 &&
      reading.are_valid({"terrain.type"})) {
    reading.report({"terrain.type", "case.dimension"},
                   "terrain.type is \"dem\", and case.dimension is 2; a DEM is the ground of a 3D case. Set "
                   "case.dimension = 3, or cut a 2D case out of the DEM with `thawslide section`.");
  }
  for (const auto& [name, body] : checked.bodies) {
    const std::string table = "body." + name;
    if (body.shape == BodyShape::release && reading.are_valid({table + ".shape"})) {
      check_release(checked, body, table, reading);
    }
    for (const auto& [key, field] : fields_of(body)) {
      check_field(body, *field, table, key, reading);
    }
    check_saturation(checked, body, table, reading);
    check_ice_content(checked, body, table, reading);
  }
  check_line(checked, "maps.path", checked.maps.path, reading);
  for (const auto& [name, probe] : checked.probes) {
    check_probe(probe, "probe." + name, reading);
    check_line(checked, "probe." + name + ".line", probe.line, reading);
  }
}

}  // namespace thawslide::config
