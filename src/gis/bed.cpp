#include "gis/bed.hpp"

#include <cmath>

#include "base/rounding.hpp"
#include "gis/error_location.hpp"
#include "gis/map_raster.hpp"
#include "gis/sampling.hpp"

namespace thawslide::gis {

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
    for (int row = 0; row < made.rows; ++row) {
      for (int column = 0; column < made.columns; ++column) {
        const double x = made.x_of(column), y = made.y_of(row);
        double& value = made.values[made.index(column, row)];
        if (domain.contains(x, y) && !(value >= 0.0 && value <= parameters.grid.cell)) {
          throw UserError(fmt::format(
              "{}: at {}, {}, in the domain, the depth of the bed is {}; allowed: from 0 m, where there is no bed, to "
              "grid.cell, {:g} m. {}",
              depth.source, coordinate_text(x), coordinate_text(y),
              std::isnan(value) ? "missing" : fmt::format("{:g} m", value), parameters.grid.cell,
              std::isnan(value) ? "Fill the raster with 0 over the whole domain, or make the domain smaller."
                                : "Check the raster's unit."));
        }
      }
    }
    return made;
  });
}

}  // namespace thawslide::gis
