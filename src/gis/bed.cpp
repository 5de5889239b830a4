#include "gis/bed.hpp"

#include <cmath>

#include "base/rounding.hpp"
#include "gis/case_inputs.hpp"
#include "gis/coverage.hpp"
#include "gis/features.hpp"
#include "gis/sampling.hpp"

namespace thawslide::gis {

namespace {

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
