#include "gis/substrates.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "base/error.hpp"
#include "base/rounding.hpp"
#include "base/text.hpp"
#include "gis/case_inputs.hpp"
#include "gis/features.hpp"
#include "gis/point_window.hpp"
#include "gis/polygons.hpp"
#include "gis/reference_system.hpp"
#include "gis/reprojection.hpp"
#include "gis/sampling.hpp"

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
  area.rings = rings_of(polygons);
  return area;
}

// Points of a raster of codes in the domain with one code, or with all.
struct CodePoints {
  long count = 0;
  Rectangle extent;

  void add(double x, double y) {
    if (count++ == 0) {
      extent = {x, y, x, y};
    }
    extent.include(x, y);
  }
  [[nodiscard]] std::string text(const CodePoints& all) const {
    return fmt::format("{:.2g} % of the domain, {}",
                       100.0 * static_cast<double>(count) / static_cast<double>(all.count), format_range(extent));
  }
};

struct CodesFound {
  std::map<double, CodePoints> by_code;
  CodePoints without, all;
};

CodesFound codes_in(const Rectangle& area, const Raster& codes) {
  CodesFound found;
  for_each_point(codes, [&](int column, int row, double code) {
    const double x = codes.x_of(column), y = codes.y_of(row);
    if (area.contains(x, y)) {
      found.all.add(x, y);
      (std::isnan(code) ? found.without : found.by_code[code]).add(x, y);
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

// Codes of a file in the ground's coordinates, around the domain; NaN: none. A raster in another reference system is
// sampled at the ground's points by nearest neighbour.
Raster read_codes(const config::Case& parameters, const std::string& key, const std::string& file, const Raster& ground,
                  std::vector<std::string>& warnings) {
  Raster codes =
      read_map(parameters, {key, file, Quantity::code, ground.crs, domain_of(parameters), "the domain"}, warnings);
  return with_error_location(parameters, key, [&] {
    make_whole(file, codes);
    if (Reprojection(codes.crs, ground.crs).changes_nothing()) {
      return codes;
    }
    warnings.push_back(fmt::format("note: the codes of {}, which is in {}, were resampled to the points of the DEM",
                                   name_of_file(file), name_of(codes.crs)));
    try {
      return nearest(codes, ground);
    } catch (const UserError& error) {
      throw UserError("{}: {}", file, error.what());
    }
  });
}

// Warnings about unnamed codes in the domain, and about parts of it without a code.
void add_code_warnings(const config::Case& parameters, const std::string& file, const Raster& codes,
                       std::vector<std::string>& warnings) {
  std::set<double> named;
  for (const auto& [name, substrate] : parameters.substrates) {
    if (substrate.raster == file) {
      named.insert(substrate.code);
    }
  }
  const Rectangle domain = domain_of(parameters);
  const CodesFound found = codes_in(domain, codes);
  const std::string name = name_of_file(file);
  for (const auto& [code, points] : found.by_code) {
    if (named.count(code) == 0) {
      warnings.push_back(fmt::format("the code {:g} of {} ({}) belongs to no substrate: [basal] applies there", code,
                                     name, points.text(found.all)));
    }
  }
  if (found.without.count > 0) {
    warnings.push_back(fmt::format("{} has no data at {} of its points in the domain ({}): [basal] applies there", name,
                                   found.without.count, found.without.text(found.all)));
  }
  const Rectangle covered = span_of_points(codes).widened(0.5 * codes.cell_x, 0.5 * codes.cell_y);
  if (const std::string beyond = describe_overhang(domain, covered); !beyond.empty()) {
    warnings.push_back(fmt::format("{} does not cover the domain, which reaches beyond it by {}: [basal] applies there",
                                   name, beyond));
  }
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
    std::vector<std::string> codes_there;
    for (const auto& [code, points] : found.by_code) {
      codes_there.push_back(fmt::format("{:g}", code));
    }
    fail_at(parameters, substrate_key(name, "code"), "{}: the code {} stands nowhere in the domain; found there: {}.",
            substrate.raster, substrate.code, codes_there.empty() ? "none" : joined_by_and(codes_there));
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
  if (const auto shared = overlap_of(one, other)) {
    fail_at(parameters, area_key(second, parameters.substrates.at(second)),
            "the substrates {} and {} overlap by {} m2 about {}; a place has one substrate. Allowed: slivers up to {} "
            "m2, {:g} % of the smaller one. Draw them apart (QGIS: Vector > Geoprocessing Tools > Difference).",
            first, second, rounded_text(shared->area, 3), shared->place, rounded_text(shared->allowed, 3),
            100.0 * overlap_tolerance);
  }
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

void check_depths(const config::Case& parameters, const VectorLayer& layer, const std::string& attribute) {
  for (const Feature& feature : layer.features) {
    const double depth = feature.numbers.at(attribute);
    if (!(depth >= 0.0 && depth <= parameters.grid.cell)) {
      throw UserError(
          "{}: the attribute '{}' of {} is {:g} m; allowed: from 0 m, where there is no bed, to grid.cell, {:g} m. "
          "Correct it.",
          layer.file, attribute, feature.title, depth, parameters.grid.cell);
    }
  }
}

std::vector<ValuedArea> areas_by_depth(const config::Case& parameters, const VectorLayer& layer) {
  const InitialField& depth = parameters.bed.depth;
  if (depth.over != InitialField::Over::attribute) {
    return {{depth.at(0.0, 0.0), union_of_features(layer)}};
  }
  const std::string key = "bed.depth";
  return with_error_location(parameters, key, [&] {
    std::vector<ValuedArea> areas = areas_by_value(layer, depth.source, key);
    check_depths(parameters, layer, attribute_named(layer, depth.source, key));
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
    add_code_warnings(parameters, file, *codes, warnings);
  }
  return areas;
}

Raster load_bed_depth(const config::Case& parameters, const Dem& ground, std::vector<std::string>& warnings) {
  const InitialField& depth = parameters.bed.depth;
  if (parameters.bed.law == config::BedLaw::none || depth.over != InitialField::Over::raster) {
    return {};
  }
  const std::string key = "bed.depth";
  const Rectangle domain = domain_of(parameters);
  const Rectangle about = domain.widened(ground.raster.cell_x, ground.raster.cell_y);
  const Raster map =
      read_map(parameters, {key, depth.source, Quantity::length, ground.raster.crs, about, "the domain"}, warnings);
  return with_error_location(parameters, key, [&] {
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
  const PolygonRequest request{"bed.", "outline", bed.outline, bed.polygons, bed.name_attribute};
  const VectorLayer layer = read_named_polygons(parameters, request, ground.raster.crs, warnings);
  const Polygons inside = part_in_domain(parameters, request, union_of_features(layer));
  Raster columns = columns_of_nodes(parameters.grid);
  for (const ValuedArea& area : areas_by_depth(parameters, layer)) {
    const Raster fraction = coverage_of(intersection_of(area.polygons, inside), columns);
    for (std::size_t k = 0; k < columns.values.size(); ++k) {
      columns.values[k] += area.value * fraction.values[k];
    }
  }
  return columns;
}

}  // namespace thawslide::gis
