// Ground steeper than cells represent, or so steep that steps become short.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"
#include "sim/checks/unresolved_terrain.hpp"

namespace thawslide::sim {

namespace {

// Bodies whose ground is much lower than the terrain, because columns were lowered or average a crest.
template <int Dim>
void add_bodies_on_lower_ground(const Simulation<Dim>& simulation, const std::vector<BodyFigures>& bodies,
                                std::vector<std::string>& warnings) {
  constexpr double quarter = 0.25;
  const Model<Dim>& model = simulation.model();
  const auto& particles = simulation.particles();
  std::vector<double> lowered(model.body_names.size(), 0.0);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const auto place = particles.position.template get<Vector<double, Dim - 1>>(p);
    double& most = lowered[static_cast<std::size_t>(particles.body(p))];
    most = std::max(most, model.ground->terrain().height(place) - model.ground->height(place));
  }
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    if (lowered[body] > quarter * bodies[body].median_thickness && bodies[body].median_thickness > 0.0) {
      warnings.push_back(fmt::format(
          "body.{}: the ground of the cells is up to {} m below the terrain under it, and the body starts there. Move "
          "it away from the cliff, or use smaller cells and a larger grid.steepest.",
          model.body_names[body], rounded_text(lowered[body], 2)));
    }
  }
}

// Ground below the top of the bodies where steps become much shorter than at the start.
template <int Dim>
void add_steep_ground(const Simulation<Dim>& simulation, const Raster& terrain, std::vector<std::string>& warnings) {
  constexpr double much = 2.5;  // more than grid.steepest allows by default
  const Model<Dim>& model = simulation.model();
  struct Steep {
    double slope = 0.0;
    std::array<double, 2> place{};
  };
  const auto& particles = simulation.particles();
  double at_start = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    double squares = 0.0;
    for (int a = 0; a + 1 < Dim; ++a) {
      squares += std::pow(particles.ground_slope(p, a), 2);
    }
    at_start = std::max(at_start, std::sqrt(squares));
  }
  const double top = top_of_bodies(simulation);
  std::vector<Steep> of_rows(static_cast<std::size_t>(terrain.rows));
  parallel_for(of_rows.size(), [&](std::size_t row) {
    for (int column = 0; column < terrain.columns; ++column) {
      Vector<double, Dim - 1> place;
      const std::array<double, 2> at{terrain.x_of(column), terrain.y_of(static_cast<int>(row))};
      bool is_inside = terrain.at(column, static_cast<int>(row)) < top;
      for (int a = 0; a + 1 < Dim; ++a) {
        place[a] = at[static_cast<std::size_t>(a)] - model.origin[a];
        is_inside = is_inside && place[a] >= 0.0 && place[a] <= model.constraints.extent[a];
      }
      if (is_inside) {
        const double slope = model.ground->gradient(place, 0.0).norm();
        if (slope > of_rows[row].slope) {
          of_rows[row] = {slope, at};
        }
      }
    }
  });
  const Steep steepest = *std::max_element(of_rows.begin(), of_rows.end(),
                                           [](const Steep& a, const Steep& b) { return a.slope < b.slope; });
  const double factor = std::hypot(1.0, steepest.slope) / std::hypot(1.0, at_start);
  if (factor > much) {
    warnings.push_back(fmt::format(
        "note: grid.steepest: the ground of the cells is as steep as {} degrees at {}. If the slide passes there, "
        "adaptive steps become {} times shorter than at the start, from which `check` estimates the cost.",
        rounded_text(std::atan(steepest.slope) * 180.0 / pi, 2), place_text<Dim>(steepest.place[0], steepest.place[1]),
        rounded_text(factor, 2)));
  }
}

}  // namespace

template <int Dim>
std::vector<std::string> warnings_of_steep_terrain(const Simulation<Dim>& simulation,
                                                   const std::vector<BodyFigures>& bodies, const Raster& terrain) {
  const Model<Dim>& model = simulation.model();
  const config::Grid& grid = simulation.parameters().grid;
  std::vector<std::string> warnings;
  if (const auto& lowering = model.ground->lowering(); lowering.columns > 0) {
    warnings.push_back(fmt::format(
        "grid.steepest: the terrain is steeper than {:g} degrees. Columns of nodes lowered: {}, by up to {} m at {}. "
        "Increase grid.steepest (allowed: up to 85 degrees) to keep the terrain, with shorter steps, or filter it.",
        grid.steepest, count_text(static_cast<double>(lowering.columns)), rounded_text(lowering.largest, 2),
        place_text<Dim>(lowering.place[0] + model.origin[0], lowering.place[Dim - 2] + model.origin[Dim - 2])));
  }
  add_bodies_on_lower_ground(simulation, bodies, warnings);
  add_steep_ground(simulation, terrain, warnings);
  return warnings;
}

template std::vector<std::string> warnings_of_steep_terrain(const Simulation<2>&, const std::vector<BodyFigures>&,
                                                            const Raster&);
template std::vector<std::string> warnings_of_steep_terrain(const Simulation<3>&, const std::vector<BodyFigures>&,
                                                            const Raster&);

}  // namespace thawslide::sim
