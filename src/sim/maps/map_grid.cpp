#include "sim/maps/map_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/rounding.hpp"
#include "sim/setup/model.hpp"

namespace thawslide::sim {

namespace {

// Cells along one axis.
struct MapAxis {
  double first, cell;  // first point; point spacing [m]
  double cells;
};

// Axis of cells aligned with `corner`, covering the range from `from` to `to` [m].
MapAxis axis_over(double corner, double cell, double from, double to) {
  // Ends that coincide with a cell border to within round-off add no cell.
  const double sliver = 1e-6;  // fraction of a cell
  const double before = std::ceil((corner - from) / cell - sliver), after = std::ceil((to - corner) / cell - sliver);
  return {corner + (0.5 - before) * cell, cell, before + after};
}

// Smallest cell size with two digits at which `most_cells` cells cover both axes [m].
double cell_for(const MapAxis& x, const MapAxis& y, double most_cells) {
  const double margin = 1.01;  // cells are whole and extend beyond the ends
  const double least = margin * std::sqrt(x.cells * x.cell * y.cells * y.cell / most_cells);
  const double digit = std::pow(10.0, std::floor(std::log10(least)) - 1.0);
  return std::ceil(least / digit) * digit;
}

// In narrower cells, with one or two columns of particles, maxima are those of a single particle. Example: a slide gave
// 53 and 48 m/s with one and two columns, and 36 and 35 m/s with 3 and 4.
constexpr double least_distances = 3.0;  // particle spacings per cell

// Minimum side of cells [m].
double least_side(const config::Case& parameters) {
  double least = parameters.grid.cell;
  for (const auto& [name, body] : parameters.bodies) {
    least = std::max(least, least_distances * parameters.grid.cell / body.particles_per_axis);
  }
  return least;
}

// Default cell sides of maps [m].
std::array<double, 2> usual_cell(const config::Case& parameters, const config::Site& site) {
  if (!site.ground) {
    return {parameters.grid.cell, parameters.grid.cell};
  }
  const double least = least_side(parameters);
  const double sliver = 1e-6;  // fraction of a cell
  const auto whole = [&](double distance) { return std::max(1.0, std::ceil(least / distance - sliver)) * distance; };
  return {whole(site.ground->cell_x), whole(site.ground->cell_y)};
}

// Text such as "5 m", or both sides if they differ.
std::string size_text(const std::array<double, 2>& cell) {
  return cell[0] == cell[1] ? fmt::format("{:g} m", cell[0]) : fmt::format("{:g} x {:g} m", cell[0], cell[1]);
}

}  // namespace

MapGrid map_grid_of(const config::Case& parameters, const config::Site& site) {
  const double requested = parameters.maps.cell;
  const std::array<double, 2> cell = requested > 0.0 ? std::array{requested, requested} : usual_cell(parameters, site);
  const auto axis_along = [&](std::size_t a, double first, double last, double distance) {
    const double domain_from = parameters.grid.min[a], domain_to = parameters.grid.max[a];
    if (!site.ground) {
      return axis_over(domain_from, cell[a], domain_from, domain_to);
    }
    const double corner = first - 0.5 * distance, end = last + 0.5 * distance;
    return axis_over(corner, cell[a], std::min(corner, domain_from), std::max(end, domain_to));
  };
  const Raster none;
  const Raster& ground = site.ground ? *site.ground : none;
  const MapAxis x = axis_along(0, ground.x, ground.x_end(), ground.cell_x);
  const MapAxis y = axis_along(1, ground.y, ground.y_end(), ground.cell_y);
  if (x.cells * y.cells > most_map_cells) {
    throw UserError(
        fmt::format("{}: maps of {:.0f} x {:.0f} cells of {:g} x {:g} m are too many: each would take {} GB of memory "
                    "while it is written. Allowed: {} cells, {} GB. Give maps.cell, {:g} m or more.",
                    config::location_of(parameters, "maps.cell"), x.cells, y.cells, x.cell, y.cell,
                    rounded_text(x.cells * y.cells * sizeof(double) / 1e9), rounded_text(most_map_cells),
                    rounded_text(most_map_cells * sizeof(double) / 1e9), cell_for(x, y, most_map_cells)));
  }
  return {x.first, y.first, x.cell, y.cell, static_cast<int>(x.cells), static_cast<int>(y.cells), site.crs};
}

Raster ground_of_cells(const config::Case& parameters, const config::Site& site, const Model<3>& model) {
  const MapGrid grid = map_grid_of(parameters, site);
  const std::size_t cells = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  Raster raster{grid.x,  grid.y, grid.cell_x, grid.cell_y, grid.columns, grid.rows, std::vector(cells, std::nan("")),
                grid.crs};
  const Vector<double, 2> origin = model.origin.head<2>(), extent = model.constraints.extent.head<2>();
  parallel_for(static_cast<std::size_t>(grid.rows), [&](std::size_t row) {
    const int j = static_cast<int>(row);
    for (int i = 0; i < grid.columns; ++i) {
      const Vector<double, 2> point = Vector<double, 2>(raster.x_of(i), raster.y_of(j)) - origin;
      if ((point.array() >= 0.0).all() && (point.array() <= extent.array()).all() && model.ground->is_known(point)) {
        raster.values[raster.index(i, j)] = model.ground->height(point) + model.origin[2];
      }
    }
  });
  return raster;
}

std::string reason_for_map_cell(const config::Case& parameters, const config::Site& site) {
  if (parameters.maps.cell > 0.0) {
    return "as maps.cell asks";
  }
  if (!site.ground) {
    return "as grid.cell";
  }
  const std::array<double, 2> cell = usual_cell(parameters, site);
  const double least = least_side(parameters);
  const double across = cell[0] / site.ground->cell_x, along = cell[1] / site.ground->cell_y;
  return across * along < 1.5
             ? "the DEM's"
             : fmt::format("{:.0f} x {:.0f} of the DEM's, to be at least {:g} m wide: {}", across, along, least,
                           least > parameters.grid.cell ? "three particle distances" : "grid.cell");
}

std::string warning_of_map_cell(const config::Case& parameters, const config::Site& site) {
  const double requested = parameters.maps.cell;
  if (requested <= 0.0 || requested >= parameters.grid.cell) {
    return "";
  }
  return fmt::format(
      "maps.cell is {:g} m, and grid.cell {:g} m: a map cell contains few particles or only one, and the maximum "
      "speeds and pressures are those of single particles. Without maps.cell, maps have cells of {}.",
      requested, parameters.grid.cell, size_text(usual_cell(parameters, site)));
}

}  // namespace thawslide::sim
