#include "gis/substrates.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "base/rounding.hpp"
#include "gis/code_raster.hpp"
#include "gis/error_location.hpp"
#include "gis/geopackage.hpp"
#include "gis/named_polygons.hpp"

namespace thawslide::gis {

namespace {

using Areas = std::map<std::string, config::SubstrateArea>;
using PolygonsOf = std::map<std::string, Polygons>;  // by name of the substrate, within the domain

std::string substrate_key(const std::string& substrate, const std::string& key) {
  return fmt::format("substrate.{}.{}", substrate, key);
}

// Key that specifies the extent of a substrate.
std::string area_key(const std::string& name, const config::Substrate& substrate) {
  return substrate_key(name, !substrate.raster.empty()        ? "raster"
                             : !substrate.outline.empty()     ? "outline"
                             : std::isfinite(substrate.x_min) ? "x_min"
                                                              : "x_max");
}

// Also sets `inside` to the part in the domain.
config::SubstrateArea area_of_outline(const config::Case& parameters, const std::string& name, const Dem& ground,
                                      Polygons& inside, std::vector<std::string>& warnings) {
  const config::Substrate& substrate = parameters.substrates.at(name);
  const PolygonRequest request{substrate_key(name, ""), "outline", substrate.outline, substrate.polygons,
                               substrate.name_attribute};
  const Polygons polygons = union_of_features(read_named_polygons(parameters, request, ground.raster.crs, warnings));
  inside = part_in_domain(parameters, request, polygons);
  config::SubstrateArea area;
  area.area = area_of(inside);
  for (const Polygon& polygon : polygons) {
    area.rings.push_back(polygon.outline);
    area.rings.insert(area.rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return area;
}

config::SubstrateArea area_of_code(const config::Case& parameters, const std::string& name,
                                   const std::shared_ptr<const Raster>& codes) {
  const config::Substrate& substrate = parameters.substrates.at(name);
  config::SubstrateArea area;
  area.codes = codes;
  area.code = substrate.code;
  const CodesFound found = codes_in(domain_of(parameters), *codes);
  const auto own = found.by_code.find(substrate.code);
  if (own == found.by_code.end()) {
    fail_at(parameters, substrate_key(name, "code"), "{}: the code {} stands nowhere in the domain; found there: {}.",
            substrate.raster, substrate.code, format_codes(found));
  }
  area.area = static_cast<double>(own->second.count) * codes->cell_x * codes->cell_y;
  return area;
}

Polygons polygons_of(const config::Case& parameters, const std::string& name, const Areas& areas) {
  const Rectangle domain = domain_of(parameters);
  const config::Substrate& substrate = parameters.substrates.at(name);
  if (substrate.is_strip()) {
    return {box_polygon({std::max(domain.min_x, substrate.x_min), domain.min_y, std::min(domain.max_x, substrate.x_max),
                         domain.max_y})};
  }
  const config::SubstrateArea& area = areas.at(name);
  Raster mask = *area.codes;
  for (double& value : mask.values) {
    value = value == area.code ? 1.0 : 0.0;
  }
  return intersection_of(areas_of_mask(mask), {box_polygon(domain)});
}

void check_overlap(const config::Case& parameters, const std::string& first, const std::string& second,
                   const Polygons& one, const Polygons& other) {
  const Polygons both = intersection_of(one, other);
  const double shared = area_of(both), allowed = overlap_tolerance * std::min(area_of(one), area_of(other));
  if (shared <= allowed) {
    return;
  }
  const Rectangle extent = extent_of(both);
  fail_at(parameters, area_key(second, parameters.substrates.at(second)),

          "the substrates {} and {} overlap by {} m2 about {}, {}; a place has one substrate. Allowed: slivers up to "
          "{} m2, {:g} % of the smaller one. Draw them apart (QGIS: Vector > Geoprocessing Tools > Difference).",
          first, second, rounded_text(shared, 3), coordinate_text(0.5 * (extent.min_x + extent.max_x)),
          coordinate_text(0.5 * (extent.min_y + extent.max_y)), rounded_text(allowed, 3), 100.0 * overlap_tolerance);
}

// Substrates of one raster cannot overlap; those along x were compared when the case was read. `polygons`: of those
// with outlines.
void check_overlaps(const config::Case& parameters, const Areas& areas, PolygonsOf polygons) {
  const auto polygons_once = [&](const std::string& name) -> const Polygons& {
    const auto found = polygons.find(name);
    return found != polygons.end() ? found->second : polygons[name] = polygons_of(parameters, name, areas);
  };
  for (auto second = parameters.substrates.begin(); second != parameters.substrates.end(); ++second) {
    for (auto first = parameters.substrates.begin(); first != second; ++first) {
      const bool both_strips = first->second.is_strip() && second->second.is_strip();
      const bool of_one_raster = !first->second.raster.empty() && first->second.raster == second->second.raster;
      if (!both_strips && !of_one_raster) {
        check_overlap(parameters, first->first, second->first, polygons_once(first->first),
                      polygons_once(second->first));
      }
    }
  }
}

}  // namespace

Areas load_substrates(const config::Case& parameters, const Dem& ground, std::vector<std::string>& warnings) {
  Areas areas;
  PolygonsOf polygons;
  std::map<std::string, std::shared_ptr<const Raster>> rasters;  // by file
  for (const auto& [name, substrate] : parameters.substrates) {
    if (!substrate.outline.empty()) {
      areas[name] = area_of_outline(parameters, name, ground, polygons[name], warnings);
    } else if (!substrate.raster.empty()) {
      auto& codes = rasters[substrate.raster];
      if (codes == nullptr) {
        codes = std::make_shared<const Raster>(
            read_codes(parameters, substrate_key(name, "raster"), substrate.raster, ground.raster, warnings));
      }
      areas[name] = area_of_code(parameters, name, codes);
    }
  }
  check_overlaps(parameters, areas, std::move(polygons));
  for (const auto& [file, codes] : rasters) {
    std::set<double> named;
    for (const auto& [name, substrate] : parameters.substrates) {
      if (substrate.raster == file) {
        named.insert(substrate.code);
      }
    }
    const std::vector<std::string> more = warnings_of_codes(domain_of(parameters), file, *codes, named);
    warnings.insert(warnings.end(), more.begin(), more.end());
  }
  return areas;
}

}  // namespace thawslide::gis
