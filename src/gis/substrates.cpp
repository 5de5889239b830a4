// Maps of the ground: substrates and the erodible bed.
#include <algorithm>
#include <cmath>
#include <memory>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "base/text.hpp"
#include "gis/point_window.hpp"
#include "gis/polygons.hpp"
#include "gis/sampling.hpp"
#include "gis/site.hpp"
#include "gis/vector_file.hpp"

namespace thawslide::gis {

namespace {

using Areas = std::map<std::string, config::SubstrateArea>;
using PolygonsOf = std::map<std::string, Polygons>;  // by name of the substrate, within the domain

std::string place_of_key(const config::Case& parameters, const std::string& substrate, const char* key) {
  return place_of(parameters, fmt::format("substrate.{}.{}", substrate, key));
}

// Numbers of the points of a raster of codes in an area: with each code, and without one.
struct CodesFound {
  std::map<double, long> by_code;
  long without = 0;
};

CodesFound codes_in(const Rectangle& area, const Raster& codes) {
  CodesFound found;
  for_each_point(codes, [&](int column, int row, double code) {
    if (area.contains(codes.x_of(column), codes.y_of(row))) {
      ++(std::isnan(code) ? found.without : found.by_code[code]);
    }
  });
  return found;
}

// Removes round-off of codes that are stored with a scale.
void make_whole(const std::string& file, Raster& codes) {
  constexpr double round_off = 1e-9;
  for_each_point(codes, [&](int column, int row, double& code) {
    const double whole = std::round(code);
    if (std::abs(code - whole) <= round_off * std::max(1.0, std::abs(code))) {
      code = whole;
    } else if (!std::isnan(code)) {
      throw UserError(
          "{}: the raster holds {:g} at {}, {}; allowed: whole numbers, the codes of substrates. Check that it is the "
          "right file.",
          file, code, coordinate_text(codes.x_of(column)), coordinate_text(codes.y_of(row)));
    }
  });
}

// Codes of a file in the ground's coordinates, around the domain; NaN: none.
Raster read_codes(const Located<std::string>& file, const Raster& ground, const Rectangle& domain,
                  std::vector<std::string>& warnings) {
  Raster codes = read_map({file, Quantity::code, ground.crs, domain, "the domain"}, warnings);
  at_place(file.place, [&] { make_whole(file.value, codes); });
  return codes;
}

// Warning about the part of the domain to which a raster of codes gives no substrate; empty if there is none.
std::string code_warning(const std::map<std::string, config::Substrate>& substrates, const std::string& file,
                         const Raster& codes, const Rectangle& domain) {
  CodesFound found = codes_in(domain, codes);
  long all = found.without;
  for (const auto& [code, count] : found.by_code) {
    all += count;
  }
  for (const auto& [name, substrate] : substrates) {
    if (substrate.raster == file) {
      found.by_code.erase(substrate.code);
    }
  }
  std::vector<std::string> parts;
  const auto add = [&](const std::string& what, long count) {
    parts.push_back(fmt::format("{} ({:.2g} % of its points)", what,
                                100.0 * static_cast<double>(count) / static_cast<double>(all)));
  };
  for (const auto& [code, count] : found.by_code) {
    add(fmt::format("the code {:g}", code), count);
  }
  if (found.without > 0) {
    add("points without data", found.without);
  }
  const Rectangle covered = span_of_points(codes).widened(0.5 * codes.cell_x, 0.5 * codes.cell_y);
  if (const std::string beyond = describe_overhang(domain, covered); !beyond.empty()) {
    parts.push_back(fmt::format("the domain beyond it ({})", beyond));
  }
  return parts.empty() ? ""
                       : fmt::format("{}: no substrate is given for {}: [basal] applies there", name_of_file(file),
                                     joined_by_and(parts));
}

config::SubstrateArea area_of_code(const Located<double>& code, const std::string& file,
                                   const std::shared_ptr<const Raster>& codes, const Rectangle& domain) {
  const CodesFound found = codes_in(domain, *codes);
  const auto own = found.by_code.find(code.value);
  if (own == found.by_code.end()) {
    std::vector<std::string> codes_there;
    for (const auto& [other, count] : found.by_code) {
      codes_there.push_back(fmt::format("{:g}", other));
    }
    throw UserError("{}: {}: the code {} stands nowhere in the domain; found there: {}.", code.place, file, code.value,
                    codes_there.empty() ? "none" : joined_by_and(codes_there));
  }
  config::SubstrateArea area;
  area.codes = codes;
  area.code = code.value;
  area.area = static_cast<double>(own->second) * codes->cell_x * codes->cell_y;
  return area;
}

// Of a strip or of codes.
Polygons polygons_of(const config::Substrate& substrate, const Areas& areas, const std::string& name,
                     const Rectangle& domain) {
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

// Substrates of one raster cannot overlap; those along x were compared before. `polygons`: of those with outlines.
void check_overlaps(const config::Case& parameters, const Areas& areas, PolygonsOf polygons) {
  const auto polygons_once = [&](const auto& substrate) -> const Polygons& {
    const auto& [name, declared] = substrate;
    const auto found = polygons.find(name);
    return found != polygons.end() ? found->second
                                   : polygons[name] = polygons_of(declared, areas, name, domain_of(parameters.grid));
  };
  for (auto second = parameters.substrates.begin(); second != parameters.substrates.end(); ++second) {
    for (auto first = parameters.substrates.begin(); first != second; ++first) {
      const config::Substrate &one = first->second, &other = second->second;
      if ((one.is_strip() && other.is_strip()) || (!one.raster.empty() && one.raster == other.raster)) {
        continue;
      }
      if (const auto shared = overlap_of(polygons_once(*first), polygons_once(*second))) {
        const char* const key = !other.raster.empty()        ? "raster"
                                : !other.outline.empty()     ? "outline"
                                : std::isfinite(other.x_min) ? "x_min"
                                                             : "x_max";
        throw UserError(
            "{}: the substrates {} and {} overlap by {} m2 about {}; a place has one substrate. Allowed: slivers up to "
            "{} m2, {:g} % of the smaller one. Draw them apart (QGIS: Vector > Geoprocessing Tools > Difference).",
            place_of_key(parameters, second->first, key), first->first, second->first, rounded_text(shared->area, 3),
            shared->place, rounded_text(shared->allowed, 3), 100.0 * overlap_tolerance);
      }
    }
  }
}

std::vector<ValuedArea> areas_by_depth(const Located<InitialField>& depth, const VectorLayer& layer, double cell) {
  if (depth.value.over != InitialField::Over::attribute) {
    return {{depth.value.at(0.0, 0.0), union_of_features(layer)}};
  }
  return at_place(depth.place, [&] {
    std::vector<ValuedArea> areas = areas_by_value(layer, depth.value.source, "bed.depth");
    const std::string attribute = attribute_named(layer, depth.value.source, "bed.depth");
    for (const Feature& feature : layer.features) {
      const double value = feature.numbers.at(attribute);
      if (!(value >= 0.0 && value <= cell)) {
        throw UserError(
            "{}: the attribute '{}' of {} is {:g} m; allowed: from 0 m, where there is no bed, to grid.cell, {:g} m. "
            "Correct it.",
            layer.file, attribute, feature.title, value, cell);
      }
    }
    return areas;
  });
}

// Zero at each column of nodes in the domain.
Raster columns_of_nodes(const config::Grid& grid) {
  Raster columns;
  columns.x = grid.min[0];
  columns.y = grid.min[1];
  columns.cell_x = columns.cell_y = grid.cell;
  columns.columns = static_cast<int>(std::lround((grid.max[0] - grid.min[0]) / grid.cell)) + 1;
  columns.rows = static_cast<int>(std::lround((grid.max[1] - grid.min[1]) / grid.cell)) + 1;
  return columns.filled(0.0);
}

}  // namespace

Areas load_substrates(const config::Case& parameters, const Dem& ground, std::vector<std::string>& warnings) {
  const Rectangle domain = domain_of(parameters.grid);
  const std::string& crs = ground.raster.crs;
  Areas areas;
  PolygonsOf polygons;
  std::map<std::string, std::shared_ptr<const Raster>> rasters;  // by file
  for (const auto& [name, substrate] : parameters.substrates) {
    const auto place = [&parameters, &name = name](const char* key) { return place_of_key(parameters, name, key); };
    if (!substrate.outline.empty()) {
      const PolygonRequest request{
          {substrate.outline, place("outline")}, {substrate.polygons, place("polygons")}, substrate.name_attribute};
      const Polygons whole = union_of_features(read_named_polygons(request, crs, warnings));
      polygons[name] = part_in_domain(request, whole, domain);
      areas[name].area = area_of(polygons[name]);
      areas[name].rings = rings_of(whole);
    } else if (!substrate.raster.empty()) {
      auto& codes = rasters[substrate.raster];
      if (codes == nullptr) {
        codes = std::make_shared<const Raster>(
            read_codes({substrate.raster, place("raster")}, ground.raster, domain, warnings));
      }
      areas[name] = area_of_code({static_cast<double>(substrate.code), place("code")}, substrate.raster, codes, domain);
    }
  }
  check_overlaps(parameters, areas, std::move(polygons));
  for (const auto& [file, codes] : rasters) {
    add_warning(code_warning(parameters.substrates, file, *codes, domain), warnings);
  }
  return areas;
}

Raster load_bed_depth(const config::Case& parameters, const Dem& ground, std::vector<std::string>& warnings) {
  const InitialField& depth = parameters.bed.depth;
  if (parameters.bed.law == config::BedLaw::none || depth.over != InitialField::Over::raster) {
    return {};
  }
  const std::string place = place_of(parameters, "bed.depth");
  const Rectangle domain = domain_of(parameters.grid);
  const Raster map = read_map({{depth.source, place},
                               Quantity::length,
                               ground.raster.crs,
                               domain.widened(ground.raster.cell_x, ground.raster.cell_y),
                               "the domain"},
                              warnings);
  return at_place(place, [&] {
    Raster made = sampled(map, ground.raster, Missing::unknown);
    for_each_point(made, [&](int column, int row, double value) {
      const double x = made.x_of(column), y = made.y_of(row);
      if (domain.contains(x, y) && !(value >= 0.0 && value <= parameters.grid.cell)) {
        throw UserError(
            "{}: at {}, {}, in the domain, the depth of the bed is {}; allowed: from 0 m, where there is no bed, to "
            "grid.cell, {:g} m. {}",
            depth.source, coordinate_text(x), coordinate_text(y),
            std::isnan(value) ? "missing" : fmt::format("{:g} m", value), parameters.grid.cell,
            std::isnan(value) ? "Fill the raster with 0 over the whole domain, or make the domain smaller."
                              : "Check the raster's unit.");
      }
    });
    return made;
  });
}

Raster load_bed_in_columns(const config::Case& parameters, const Dem& ground, std::vector<std::string>& warnings) {
  const config::Bed& bed = parameters.bed;
  if (bed.law == config::BedLaw::none || bed.outline.empty()) {
    return {};
  }
  const PolygonRequest request{located(parameters, "bed.outline", bed.outline),
                               located(parameters, "bed.polygons", bed.polygons), bed.name_attribute};
  const VectorLayer layer = read_named_polygons(request, ground.raster.crs, warnings);
  const Polygons inside = part_in_domain(request, union_of_features(layer), domain_of(parameters.grid));
  Raster columns = columns_of_nodes(parameters.grid);
  for (const ValuedArea& area :
       areas_by_depth(located(parameters, "bed.depth", bed.depth), layer, parameters.grid.cell)) {
    const Raster fraction = coverage_of(intersection_of(area.polygons, inside), columns);
    for (std::size_t k = 0; k < columns.values.size(); ++k) {
      columns.values[k] += area.value * fraction.values[k];
    }
  }
  return columns;
}

}  // namespace thawslide::gis
