#include "gis/reference_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "base/text.hpp"
#include "config/input_limits.hpp"
#include "gis/case_inputs.hpp"
#include "gis/gdal_messages.hpp"

namespace thawslide::gis {

OGRSpatialReference reference_from_wkt(const std::string& wkt) {
  OGRSpatialReference reference;
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  if (!wkt.empty()) {
    const OGRErr result = reference.importFromWkt(wkt.c_str());
    THAWSLIDE_ASSERT(result == OGRERR_NONE, "WKT that GDAL does not read: {}", wkt);
  }
  return reference;
}

std::string wkt_from_reference(const OGRSpatialReference* reference) {
  if (reference == nullptr || reference->IsEmpty()) {
    return "";
  }
  const GdalMessages messages;
  for (const char* format : {"FORMAT=WKT1", "FORMAT=WKT2_2019"}) {
    const char* const options[] = {format, nullptr};
    char* text = nullptr;
    const OGRErr result = reference->exportToWkt(&text, options);
    const std::string wkt = released(text);
    if (result == OGRERR_NONE && !wkt.empty()) {
      return wkt;
    }
  }
  return "";
}

HeightUnit height_unit_of(const OGRSpatialReference* reference) {
  if (reference == nullptr) {
    return {};
  }
  const GdalMessages messages;
  HeightUnit unit;
  if (reference->IsCompound() != 0) {
    const char* name = nullptr;
    unit.metres = reference->GetTargetLinearUnits("COMPD_CS|VERT_CS", &name);
    unit.name = name == nullptr ? "" : name;
  } else if (reference->GetAxesCount() == 3) {
    OGRAxisOrientation direction = OAO_Other;
    reference->GetAxis(nullptr, 2, &direction, &unit.metres);
    unit.name = fmt::format("{:.9g} m", unit.metres);
  }
  return std::isfinite(unit.metres) && unit.metres > 0.0 ? unit : HeightUnit{};
}

namespace {

// Zone of the Universal Transverse Mercator projection (Snyder 1987, Map projections: a working manual, p. 57).
int utm_number(double longitude, double latitude) {
  const int zone = std::clamp(static_cast<int>(std::floor((longitude + 180.0) / 6.0)) + 1, 1, 60);
  return (latitude >= 0.0 ? 32600 : 32700) + zone;
}

// Command that converts a raster to metres, in the UTM zone of the raster's centre.
std::string warp_command(const MapExtent& raster, const std::string& source_option, double longitude, double latitude,
                         double metres_per_unit) {
  const int number = utm_number(longitude, latitude);
  const std::filesystem::path file(raster.file);
  const std::filesystem::path target = file.parent_path() / fmt::format("{}-EPSG{}.tif", file.stem().string(), number);
  const double size = raster.cell * metres_per_unit, digit = last_digit(size, 2),
               cell = std::round(size / digit) * digit;
  return fmt::format("gdalwarp {}-t_srs EPSG:{} -tr {:g} {:g} -r bilinear {} {}", source_option, number, cell, cell,
                     shell_quote(file.string()), shell_quote(target.string()));
}

std::string warp_of_degrees(const MapExtent& raster, const std::string& source_option) {
  constexpr double metres_per_degree = 111.3e3;  // of latitude, approximately
  const Rectangle& extent = raster.extent;
  return warp_command(raster, source_option, 0.5 * (extent.min_x + extent.max_x), 0.5 * (extent.min_y + extent.max_y),
                      metres_per_degree);
}

[[noreturn]] void fail_without_system(const MapExtent& raster) {
  const std::string found =
      fmt::format("{}: the file names no coordinate reference system ({})", raster.file, format_range(raster.extent));
  if (can_be_degrees(raster.extent)) {
    throw UserError(
        "{}. If these are degrees, reproject to metres: {}. If they are metres, set terrain.crs to the system they are "
        "in, such as terrain.crs = \"EPSG:31287\".",
        found, warp_of_degrees(raster, "-s_srs EPSG:4326 "));
  }
  throw UserError("{}. Set terrain.crs to the one that the data provider states, such as terrain.crs = \"EPSG:31287\".",
                  found);
}

[[noreturn]] void fail_with_degrees(const MapExtent& raster, const std::string& wkt) {
  if (!can_be_degrees(raster.extent)) {
    throw UserError(
        "{}: the tag specifies degrees ({}), but the numbers are metric ({}). Set terrain.crs = \"EPSG:...\" to the "
        "system of the coordinates, which the data provider states.",
        raster.file, name_of(wkt), format_range(raster.extent));
  }
  throw UserError("{}: the coordinates are degrees ({}; {}); allowed: a map projection in metres. Reproject: {}",
                  raster.file, name_of(wkt), format_range(raster.extent), warp_of_degrees(raster, ""));
}

// Longitude and latitude of the raster's centre; NaN if undefined.
std::array<double, 2> middle_in_degrees(const MapExtent& raster, const std::string& wkt) {
  OGRSpatialReference degrees;
  degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  degrees.importFromEPSG(4326);
  std::vector<double> x{0.5 * (raster.extent.min_x + raster.extent.max_x)};
  std::vector<double> y{0.5 * (raster.extent.min_y + raster.extent.max_y)};
  const bool is_known = Reprojection(wkt, wkt_from_reference(&degrees)).apply(x, y);
  return is_known ? std::array<double, 2>{x[0], y[0]} : std::array<double, 2>{std::nan(""), std::nan("")};
}

[[noreturn]] void fail_with_unit(const MapExtent& raster, const std::string& wkt, const std::string& unit,
                                 double metres_per_unit, bool from_key) {
  if (from_key) {
    throw UserError("{} is in the unit '{}'; allowed: a map projection in metres, such as \"EPSG:31287\".",
                    name_of(wkt), unit);
  }
  std::string remedy = "Reproject it to one with gdalwarp";
  const auto [longitude, latitude] = middle_in_degrees(raster, wkt);
  if (std::isfinite(longitude) && std::isfinite(latitude)) {
    remedy = "Reproject: " + warp_command(raster, "", longitude, latitude, metres_per_unit);
  }
  throw UserError(
      "{}: the coordinates are in the unit '{}' ({}); allowed: a map projection in metres, and elevations in metres. "
      "{}",
      raster.file, unit, name_of(wkt), remedy);
}

// Extreme lengths on the map over those on the ellipsoid, by direction: axes of Tissot's indicatrix (Snyder 1987, Map
// projections: a working manual, USGS Professional Paper 1395, pp. 20-26).
struct PointScales {
  double smallest = 1.0, largest = 1.0;
  double x = 0.0, y = 0.0;  // on the map [m]

  // Largest relative error of lengths, or of ratios of lengths in two directions.
  [[nodiscard]] double error() const {
    return std::max({std::abs(largest - 1.0), std::abs(smallest - 1.0), largest / smallest - 1.0});
  }
};

// Scales at the corner with the largest error, in a projection in metres; 1 if no corner is on the ellipsoid.
PointScales worst_scales(const std::string& wkt, const Rectangle& extent) {
  constexpr double step = 10.0;  // m
  const OGRSpatialReference reference = reference_from_wkt(wkt);
  OGRSpatialReference degrees;
  degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  degrees.CopyGeogCSFrom(&reference);
  const Reprojection to_degrees(wkt, wkt_from_reference(&degrees));
  const double radians = degrees.GetAngularUnits(nullptr), turn = 2.0 * std::numbers::pi / radians;
  const double a = reference.GetSemiMajor(nullptr), b = reference.GetSemiMinor(nullptr);
  PointScales worst;
  for (const auto& [x, y] : {std::pair(extent.min_x, extent.min_y), std::pair(extent.min_x, extent.max_y),
                             std::pair(extent.max_x, extent.min_y), std::pair(extent.max_x, extent.max_y)}) {
    std::vector<double> longitude{x + step, x - step, x, x, x}, latitude{y, y, y + step, y - step, y};
    if (!to_degrees.apply(longitude, latitude)) {
      continue;
    }
    const double e2 = 1.0 - (b / a) * (b / a), sine = std::sin(radians * latitude[4]);
    const double w2 = 1.0 - e2 * sine * sine;
    const double meridian = a * (1.0 - e2) / (w2 * std::sqrt(w2)) * radians / (2.0 * step);
    const double parallel = a / std::sqrt(w2) * std::cos(radians * latitude[4]) * radians / (2.0 * step);
    // Metres on the ellipsoid, to the east and to the north, per metre on the map.
    const double east_x = parallel * std::remainder(longitude[0] - longitude[1], turn);
    const double east_y = parallel * std::remainder(longitude[2] - longitude[3], turn);
    const double north_x = meridian * (latitude[0] - latitude[1]), north_y = meridian * (latitude[2] - latitude[3]);
    // Sum and difference of the singular values of this matrix.
    const double sum = std::hypot(east_x + north_y, east_y - north_x);
    const double difference = std::hypot(east_x - north_y, east_y + north_x);
    const PointScales scales{2.0 / (sum + difference), 2.0 / std::abs(sum - difference), x, y};
    worst = std::isfinite(scales.error()) && scales.error() > worst.error() ? scales : worst;
  }
  return worst;
}

// GDAL ignores characters after the digits of a number.
bool is_sound_number(const std::string& text) {
  const std::size_t colon = text.find(':');
  const bool is_number_of_epsg = colon == 4 && (text[0] == 'E' || text[0] == 'e');
  return !is_number_of_epsg || (text.size() > 5 && text.find_first_not_of("0123456789+", 5) == std::string::npos);
}

}  // namespace

void require_projection_database() {
  const GdalMessages messages;
  OGRSpatialReference known;
  if (known.importFromEPSG(4326) != OGRERR_NONE) {
    throw UserError(
        "PROJ's database of coordinate reference systems, proj.db, cannot be used{}. Install it (Debian: apt-get "
        "install proj-data), or let PROJ_LIB name the folder that holds it.",
        messages.remark());
  }
}

std::string reference_system_named(const std::string& text) {
  const GdalMessages messages;
  OGRSpatialReference reference;
  if (!is_sound_number(text) ||
      reference.SetFromUserInput(text.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) !=
          OGRERR_NONE) {
    require_projection_database();
    const std::string with_registry = "EPSG:" + text;
    const bool lacks_registry =
        is_sound_number(with_registry) && reference.SetFromUserInput(with_registry.c_str()) == OGRERR_NONE;
    throw UserError(
        "'{}' is not a known coordinate reference system{} a number of the EPSG registry such as \"EPSG:31287\" "
        "(epsg.io finds it), or a WKT.",
        config::shown(text),
        lacks_registry ? fmt::format("; did you mean \"{}\"? Allowed:", with_registry) : "; allowed:");
  }
  return wkt_from_reference(&reference);
}

std::string name_of(const std::string& wkt) {
  if (wkt.empty()) {
    return "";
  }
  const GdalMessages messages;
  const OGRSpatialReference reference = reference_from_wkt(wkt);
  const char* authority = reference.GetAuthorityName(nullptr);
  const char* code = reference.GetAuthorityCode(nullptr);
  if (authority != nullptr && code != nullptr) {
    return fmt::format("{}:{}", authority, code);
  }
  const char* name = reference.GetName();
  return name == nullptr ? "unnamed" : name;
}

bool can_be_degrees(const Rectangle& extent) {
  return std::max(std::abs(extent.min_x), std::abs(extent.max_x)) <= 360.0 &&
         std::max(std::abs(extent.min_y), std::abs(extent.max_y)) <= 90.0;
}

std::string metric_system(const MapExtent& raster, const std::string& wkt_of_file, const std::string& terrain_crs) {
  const bool from_key = !terrain_crs.empty();
  const std::string wkt = from_key ? reference_system_named(terrain_crs) : wkt_of_file;
  require_projection_database();  // without it, a file's system may be misread
  if (wkt.empty()) {
    fail_without_system(raster);
  }
  const GdalMessages messages;
  OGRSpatialReference reference = reference_from_wkt(wkt);
  if (reference.IsGeographic() != 0) {
    if (from_key) {
      throw UserError("{} is in degrees; allowed: a map projection in metres, such as \"EPSG:31287\".", name_of(wkt));
    }
    fail_with_degrees(raster, wkt);
  }
  if (reference.IsProjected() == 0) {
    throw UserError(
        "{}: the coordinate reference system '{}' is not a map projection; allowed: a projection in metres. Set "
        "terrain.crs, such as terrain.crs = \"EPSG:31287\".",
        raster.file, name_of(wkt));
  }
  const char* unit = nullptr;
  const double metres_per_unit = reference.GetLinearUnits(&unit);
  if (std::abs(metres_per_unit - 1.0) > 1e-9) {
    fail_with_unit(raster, wkt, unit == nullptr ? "unknown" : unit, metres_per_unit, from_key);
  }
  if (from_key) {
    // The key georeferences a DEM and does not change its values.
    const HeightUnit heights = height_unit_of(&reference);
    if (std::abs(heights.metres - 1.0) > 1e-9) {
      throw UserError(
          "{} has heights in the unit '{}'; allowed: a map projection in metres, without heights or with heights in "
          "metres. Name its horizontal part alone, and state the unit of the elevations in the file: gdal_edit.py "
          "-units",
          name_of(wkt), heights.name);
    }
  }
  reference.StripVertical();
  reference.DemoteTo2D(nullptr);
  return wkt_from_reference(&reference);
}

std::string distortion_note(const MapExtent& raster, const std::string& wkt, bool from_key) {
  constexpr double noticeable = 0.01, most = 0.05;
  const PointScales scales = worst_scales(wkt, raster.extent);
  // "1.46 times those on the ground at the corner 1002000, 5900000"
  const std::string range = scales.largest < 1.001 * scales.smallest
                                ? fmt::format("{:.3g}", scales.largest)
                                : fmt::format("{:.3g} to {:.3g}, by direction,", scales.smallest, scales.largest);
  const std::string times = fmt::format("{} times those on the ground at the corner {}, {}", range,
                                        coordinate_text(scales.x), coordinate_text(scales.y));
  if (scales.error() > most) {
    const auto [longitude, latitude] = middle_in_degrees(raster, wkt);
    const std::string source = from_key ? fmt::format("-s_srs {} ", shell_quote(name_of(wkt))) : "";
    throw UserError(
        "{}: lengths in the map projection {} are {}; allowed: a projection that preserves lengths to within {:g} %. "
        "Reproject: {}",
        raster.file, name_of(wkt), times, 100.0 * most,
        warp_command(raster, source, longitude, latitude, 1.0 / std::sqrt(scales.smallest * scales.largest)));
  }
  return scales.error() <= noticeable ? ""
                                      : fmt::format("note: lengths in the map projection of {}, {}, are {}",
                                                    name_of_file(raster.file), name_of(wkt), times);
}

std::string height_system_of(const std::string& wkt) {
  const GdalMessages messages;
  const OGRSpatialReference reference = reference_from_wkt(wkt);
  const auto named = [&reference](const char* node) -> std::string {
    const char* name = reference.GetAttrValue(node);
    return name == nullptr || lower_case(name).find("unknown") != std::string::npos ? "" : name;
  };
  if (reference.IsCompound() == 0) {
    return reference.GetAxesCount() == 3 ? named("DATUM") : "";
  }
  const std::string datum = named("COMPD_CS|VERT_CS|VERT_DATUM");
  return datum.empty() ? named("COMPD_CS|VERT_CS") : datum;
}

void require_same_heights(const std::string& file, const std::string& found, const std::string& dem) {
  if (!found.empty() && !dem.empty() && lower_case(found) != lower_case(dem)) {
    throw UserError(
        "{}: the elevations refer to '{}', those of the DEM to '{}'; allowed: one vertical reference system. Transform "
        "one of the files (gdalwarp -s_srs ... -t_srs ...), or state the same system in both, if they have the same: "
        "gdal_edit.py -a_srs EPSG:... {}",
        file, found, dem, shell_quote(file));
  }
}

std::string location_warning(const MapExtent& raster, const std::string& wkt) {
  constexpr double far = 1000.0, kilometres_per_degree = 111.2;  // [km]; along a meridian
  const GdalMessages messages;
  OGRSpatialReference registered;
  double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
  const char* area = nullptr;
  const std::string name = name_of(wkt);
  const bool has_area = name.rfind("EPSG:", 0) == 0 && registered.SetFromUserInput(name.c_str()) == OGRERR_NONE &&
                        registered.GetAreaOfUse(&west, &south, &east, &north, &area);
  if (!has_area || west > east) {
    return "";  // no area of use is given, or it crosses the date line
  }
  const auto [longitude, latitude] = middle_in_degrees(raster, wkt);
  const double adjacent = std::max({0.0, west - longitude, longitude - east});
  const double along = std::max({0.0, south - latitude, latitude - north});
  const double distance =
      kilometres_per_degree * std::hypot(adjacent * std::cos(latitude * std::numbers::pi / 180.0), along);
  if (distance <= far) {
    return "";
  }
  return fmt::format(
      "the middle of {} would be at longitude {:.4g}, latitude {:.4g} in {}, which is for longitudes {:.4g} to {:.4g} "
      "and latitudes {:.4g} to {:.4g}: is it the right system? If not, set terrain.crs to the one the numbers are in",
      name_of_file(raster.file), longitude, latitude, name, west, east, south, north);
}

}  // namespace thawslide::gis
