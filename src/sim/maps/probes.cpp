#include "sim/maps/probes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/error.hpp"
#include "base/rounding.hpp"

namespace thawslide::sim {

namespace {

// Adds the fractions of the interval between two numbers at which it crosses an integer.
void add_crossings(double from, double to, std::vector<double>& fractions) {
  const double lower = std::min(from, to), upper = std::max(from, to);
  const auto last = static_cast<std::int64_t>(std::ceil(upper));
  for (auto border = static_cast<std::int64_t>(std::floor(lower)) + 1; border < last; ++border) {
    fractions.push_back((static_cast<double>(border) - from) / (to - from));
  }
}

void add_segment(const std::array<double, 2>& from, const std::array<double, 2>& to, const MapGrid& map_grid,
                 std::vector<SectionPart>& parts) {
  const double length = std::hypot(to[0] - from[0], to[1] - from[1]);
  if (!(length > 0.0)) {
    return;
  }
  const double column = map_grid.column_of(from[0]), row = map_grid.row_of(from[1]);
  const double columns = map_grid.column_of(to[0]) - column, rows = map_grid.row_of(to[1]) - row;
  std::vector<double> fractions{0.0, 1.0};
  add_crossings(column - 0.5, column - 0.5 + columns, fractions);
  add_crossings(row - 0.5, row - 0.5 + rows, fractions);
  std::sort(fractions.begin(), fractions.end());
  for (std::size_t k = 0; k + 1 < fractions.size(); ++k) {
    const double part = fractions[k + 1] - fractions[k], middle = 0.5 * (fractions[k] + fractions[k + 1]);
    if (part > 0.0) {
      parts.push_back({column + middle * columns, row + middle * rows, part * length, (to[1] - from[1]) / length,
                       (from[0] - to[0]) / length});
    }
  }
}

// Point below a coordinate in cells, the one above it, and the fraction of the way to it.
struct Between {
  int below, above;
  double fraction;

  Between(double cells, int count)
      : below(std::clamp(static_cast<int>(std::floor(cells - 0.5)), 0, count - 1)),
        above(std::min(below + 1, count - 1)),
        fraction(std::clamp(cells - 0.5 - below, 0.0, 1.0)) {}
};

}  // namespace

std::vector<SectionPart> parts_of_section(const config::Polyline2& line, const MapGrid& map_grid) {
  std::vector<SectionPart> parts;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    add_segment(line[k], line[k + 1], map_grid, parts);
  }
  return parts;
}

SectionFlow flow_through(const std::vector<SectionPart>& section, const FlowMaps& maps) {
  SectionFlow flow;
  const MapGrid& grid = maps.map_grid();
  for (const SectionPart& part : section) {
    const Between column(part.column, grid.columns), row(part.row, grid.rows);
    double thickness = 0.0, discharge = 0.0;
    const auto add = [&](double weight, int at_column, int at_row) {
      const MapCell& cell = maps.cell(at_column, at_row);
      thickness += weight * cell.thickness;
      discharge += weight * cell.thickness * (cell.velocity_x * part.normal_x + cell.velocity_y * part.normal_y);
    };
    add((1.0 - column.fraction) * (1.0 - row.fraction), column.below, row.below);
    add(column.fraction * (1.0 - row.fraction), column.above, row.below);
    add((1.0 - column.fraction) * row.fraction, column.below, row.above);
    add(column.fraction * row.fraction, column.above, row.above);
    flow.area += thickness * part.length;
    flow.discharge += discharge * part.length;
    flow.max_thickness = std::max(flow.max_thickness, thickness);
  }
  return flow;
}

Probes::Probes(const config::Case& parameters, const std::map<std::string, config::Polyline2>& probes,
               const MapGrid& map_grid) {
  for (const auto& [name, corners] : probes) {
    for (const auto& corner : corners) {
      if (!map_grid.contains(corner[0], corner[1])) {
        throw UserError(
            fmt::format("{}: probe '{}' has a point at x = {} m, y = {} m, outside the maps; allowed: x from {} to {} "
                        "m, y from {} to {} m. Move it, or make the domain larger.",
                        config::location_of(parameters, "probe." + name), name, coordinate_text(corner[0]),
                        coordinate_text(corner[1]), coordinate_text(map_grid.x - 0.5 * map_grid.cell_x),
                        coordinate_text(map_grid.x + (map_grid.columns - 0.5) * map_grid.cell_x),
                        coordinate_text(map_grid.y - 0.5 * map_grid.cell_y),
                        coordinate_text(map_grid.y + (map_grid.rows - 0.5) * map_grid.cell_y)));
      }
    }
    if (corners.size() == 1) {
      points_.push_back({name, map_grid.cell_column(map_grid.column_of(corners[0][0])),
                         map_grid.cell_row(map_grid.row_of(corners[0][1]))});
      continue;
    }
    sections_.push_back({name, parts_of_section(corners, map_grid)});
    if (sections_.back().parts.empty()) {
      throw UserError(
          fmt::format("{}: the line of probe '{}' has no length; allowed: one point, or a line of at least "
                      "two different ones.",
                      config::location_of(parameters, "probe." + name), name));
    }
  }
}

std::vector<std::pair<std::string, double>> Probes::row(const FlowMaps& maps, double time) const {
  std::vector<std::pair<std::string, double>> row{{"time_s", time}};
  for (const Point& point : points_) {
    const MapCell& cell = maps.cell(point.column, point.row);
    row.emplace_back(point.name + "_thickness_m", cell.thickness);
    row.emplace_back(point.name + "_speed_m_s", cell.speed());
  }
  for (const Section& section : sections_) {
    const SectionFlow flow = flow_through(section.parts, maps);
    row.emplace_back(section.name + "_flow_area_m2", flow.area);
    row.emplace_back(section.name + "_discharge_m3_s", flow.discharge);
    row.emplace_back(section.name + "_mean_speed_m_s", flow.mean_speed());
    row.emplace_back(section.name + "_max_thickness_m", flow.max_thickness);
  }
  return row;
}

}  // namespace thawslide::sim
