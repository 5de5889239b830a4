#include "config/whole_cells.hpp"

#include <fmt/format.h>

#include <cmath>

#include "config/fitting_cell.hpp"

namespace thawslide::config {

namespace {

constexpr double tolerance = 1e-6;  // fraction of a cell count, as in check_case

bool same_source(const Location& one, const Location& other) {
  return one.command_line == other.command_line && (one.command_line || one.source == other.source);
}

std::string corner_text(const Point& corner, std::size_t dimension) {
  std::string text;
  for (std::size_t a = 0; a < dimension; ++a) {
    text += (a == 0 ? "" : ", ") + plain_number(corner[a]);
  }
  return "[" + text + "]";
}

}  // namespace

void fit_domain_to_cells(Case& parameters, Reading& reading) {
  Grid& grid = parameters.grid;
  const auto dimension = static_cast<std::size_t>(reading.dimension);
  if (!reading.are_valid({"grid.cell", "grid.min", "grid.max", "terrain.type", "terrain.extend"})) {
    return;
  }
  const Location location = reading.location_of("grid.cell");
  if (same_source(location, reading.location_of("grid.min")) ||
      same_source(location, reading.location_of("grid.max"))) {
    return;
  }
  const bool is_bounded = parameters.terrain.kind == TerrainKind::dem ||
                          (parameters.terrain.kind == TerrainKind::profile && !parameters.terrain.extend);
  Point corner = grid.max;
  const std::vector<double> lengths = lengths_of_domain(parameters);
  for (std::size_t a = 0; a < dimension; ++a) {
    const double cells = lengths[a] / grid.cell;
    if (!(cells > 0.0) || std::abs(cells - std::round(cells)) <= tolerance * cells) {
      continue;
    }
    const bool is_horizontal = a + 1 < dimension;
    corner[a] = grid.min[a] + grid.cell * (is_bounded && is_horizontal ? std::floor(cells) : std::ceil(cells));
  }
  if (corner != grid.max) {
    reading.notes.push_back(fmt::format("note: {}: grid.max is {} for whole cells of {} m, in place of {}",
                                        location.text(), corner_text(corner, dimension), plain_number(grid.cell),
                                        corner_text(grid.max, dimension)));
    grid.max = corner;
  }
}

}  // namespace thawslide::config
