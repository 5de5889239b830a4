#include "sim/checks/unresolved_terrain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.hpp"

namespace thawslide::sim {

namespace {

constexpr double kept = 2.0 / 3.0;  // of the height of a crest, at least
constexpr double relevant = 0.25;   // of the thickness of the body
constexpr double flattens = 1.5;    // maximum ratio of the height of a narrow crest within twice a reach, and within it
// Minimum ratio of the height of a crest in its narrowest direction, and in any; lower in broad hollows and on hills.
constexpr double across_hollow = 0.7;
// Of the height of a crest at one place: sufficient along the whole crest, because columns remove up to 1.6 times as
// much where it lies between them as where it lies on one.
constexpr double kept_along = 0.7;

// Direction across a crest, by the step to the next point of a raster.
struct Direction {
  int east, north;
  double distance;  // of points [m]
  int narrow;       // points within which a narrow crest has fallen to most of its height
};

// Narrow dyke, or narrow gully, whose heights are counted downwards.
struct Crest {
  double height = 0.0, on_grid = 0.0;  // of the terrain, and of the ground of the grid [m]
  double width = HUGE_VAL;             // at half the height [m]
  std::array<double, 2> place{};
  Direction across{};

  [[nodiscard]] double loss() const { return height - on_grid; }
};

// Heights at evenly spaced points of a line across a crest, which is in the middle.
class Line {
 public:
  // height_at(k): at point k, from -reach to reach.
  template <class HeightAt>
  Line(int reach, const HeightAt& height_at) : reach_(reach) {
    for (int k = -reach; k <= reach; ++k) {
      heights_.push_back(height_at(k));
    }
  }
  // Height of a point above the higher one of the lowest points on its two sides, within a number of points.
  [[nodiscard]] double crest(int at, int within) const {
    const auto first = heights_.begin() + (reach_ + std::max(at - within, -reach_)),
               middle = heights_.begin() + (reach_ + at),
               end = heights_.begin() + (reach_ + std::min(at + within, reach_) + 1);
    return *middle - std::max(*std::min_element(first, middle + 1), *std::min_element(middle, end));
  }
  // Width at a height below the middle, in points.
  [[nodiscard]] double width_below(double height) const {
    return points_down_to(at(0) - height, -1) + points_down_to(at(0) - height, 1);
  }

 private:
  // Distance from the middle, in points, to where the line falls below a height towards one side.
  [[nodiscard]] double points_down_to(double height, int side) const {
    for (int k = 1; k <= reach_; ++k) {
      if (const double here = at(side * k), before = at(side * (k - 1)); here <= height) {
        return k - (height - here) / (before - here);
      }
    }
    return reach_;
  }
  [[nodiscard]] double at(int k) const { return heights_[static_cast<std::size_t>(reach_ + k)]; }

  int reach_;
  std::vector<double> heights_;
};

// Kind of crest.
struct Landform {
  double sign;          // 1: dyke, -1: gully
  double half_columns;  // half the number of columns across that cells need
  const char *name, *extent;
};

// Search over the points of a raster, or of a profile as a raster of one row.
template <int Dim>
class CrestSearch {
 public:
  CrestSearch(const Simulation<Dim>& simulation, const Raster& terrain, const Landform& landform, double least)
      : model_(simulation.model()),
        terrain_(terrain),
        cell_(simulation.parameters().grid.cell),
        landform_(landform),
        least_(least),
        columns_(columns_of(cell_)),
        simulation_is_filtered_(simulation.site().before_smoothing != nullptr) {
    for (const auto& [east, north] : {std::array{1, 0}, std::array{0, 1}, std::array{1, 1}, std::array{1, -1}}) {
      const double distance = std::hypot(east * terrain.cell_x, north * terrain.cell_y);
      const int narrow = static_cast<int>(landform.half_columns * cell_ / distance);
      if (narrow > 0 && (terrain.rows > 1 || north == 0)) {
        directions_.push_back({east, north, distance, narrow});
      }
    }
    top_ = top_of_bodies(simulation);
    const config::Case& parameters = simulation.parameters();
    for (const auto& [name, release] : simulation.site().releases) {
      if (parameters.bodies.at(name).placement == config::Placement::cut) {
        scars_.push_back(&release.thickness);
      }
    }
  }

  // The one that loses most of its height. There is none on cells as small as those of a DEM.
  [[nodiscard]] Crest worst() const {
    if (terrain_.rows > 1 && cell_ <= finest()) {
      return {};
    }
    std::vector<Crest> of_rows(static_cast<std::size_t>(terrain_.rows));
    parallel_for(of_rows.size(), [&](std::size_t row) {
      for (int column = 0; column < terrain_.columns; ++column) {
        if (const Crest crest = crest_at(column, static_cast<int>(row)); crest.loss() > of_rows[row].loss()) {
          of_rows[row] = crest;
        }
      }
    });
    return *std::max_element(of_rows.begin(), of_rows.end(),
                             [](const Crest& a, const Crest& b) { return a.loss() < b.loss(); });
  }

  // Cell that keeps a crest, at least the distance of a DEM's points; nothing if the filter of the DEM removes it.
  [[nodiscard]] std::optional<double> cell_for(const Crest& crest) const {
    constexpr double refinement = 0.8;
    const double least = terrain_.rows > 1 ? finest() : terrain_.cell_x;
    double cell = cell_;
    while (cell > least) {
      cell = std::max(least, refinement * cell);
      if (on_grid(crest, columns_of(cell)) >= kept_along * crest.height) {
        return cell;
      }
    }
    return simulation_is_filtered_ ? std::nullopt : std::optional(cell);
  }

 private:
  using Point = Vector<double, Dim - 1>;
  using Ground = terrain::FollowingGround<Dim>;

  [[nodiscard]] double finest() const { return std::max(terrain_.cell_x, terrain_.cell_y); }

  // Ground of cells of a size, without a limit of slopes.
  [[nodiscard]] Ground columns_of(double cell) const {
    const std::shared_ptr<const terrain::Surface<Dim>> terrain(model_.ground, &model_.ground->terrain());
    return {terrain, cell, model_.constraints.extent.template head<Dim - 1>(), model_.motion.sizes, model_.motion.width,
            HUGE_VAL};
  }

  // Height of a crest in the ground of a grid. Its top may be shifted.
  [[nodiscard]] double on_grid(const Crest& crest, const Ground& ground) const {
    const Direction& across = crest.across;
    const Line line(2 * across.narrow, [&](int k) {
      return landform_.sign * ground.height(relative(crest.place[0] + k * across.east * terrain_.cell_x,
                                                     crest.place[1] + k * across.north * terrain_.cell_y));
    });
    double height = 0.0;
    for (int k = -across.narrow; k <= across.narrow; ++k) {
      height = std::max(height, line.crest(k, 2 * across.narrow));
    }
    return height;
  }

  [[nodiscard]] Point relative(double x, double y) const {
    Point point;
    point[0] = x - model_.origin[0];
    if constexpr (Dim == 3) {
      point[1] = y - model_.origin[1];
    }
    return point;
  }

  // A narrow crest at a point that the grid does not represent, or one without height. It is measured in the direction
  // in which it is narrowest.
  [[nodiscard]] Crest crest_at(int column, int row) const {
    const double x = terrain_.x_of(column), y = terrain_.y_of(row);
    const Point point = relative(x, y);
    const auto extent = model_.constraints.extent.template head<Dim - 1>();
    if (!(terrain_.at(column, row) < top_) || (point.array() < 0.0).any() || (point.array() > extent.array()).any()) {
      return {};
    }
    Crest crest;
    for (const Direction& across : directions_) {
      if (!is_inside(column, row, across)) {
        return {};
      }
      const double before = height_at(column - across.east, row - across.north), here = height_at(column, row),
                   after = height_at(column + across.east, row + across.north);
      if (here >= before && here >= after) {
        const Line line = line_of(column, row, across);
        const double height = line.crest(0, 2 * across.narrow);
        const double width = across.distance * line.width_below(0.5 * height);
        if (height > least_ && height < flattens * line.crest(0, across.narrow) && width < crest.width) {
          crest = {height, 0.0, width, {x, y}, across};
        }
      }
    }
    if (crest.height == 0.0 || crest.height < across_hollow * highest(column, row)) {
      return {};
    }
    if (is_at_scar(column, row, crest.across)) {
      return {};
    }
    crest.on_grid = on_grid(crest, columns_);
    return crest.on_grid < kept * crest.height ? crest : Crest{};
  }

  // True if a release was cut out of the terrain across a point.
  [[nodiscard]] bool is_at_scar(int column, int row, const Direction& across) const {
    for (int k = -2 * across.narrow; k <= 2 * across.narrow; ++k) {
      const double x = terrain_.x_of(column + k * across.east), y = terrain_.y_of(row + k * across.north);
      for (const Raster* thickness : scars_) {
        const double c = std::round((x - thickness->x) / thickness->cell_x),
                     r = std::round((y - thickness->y) / thickness->cell_y);
        if (c >= 0.0 && r >= 0.0 && c < thickness->columns && r < thickness->rows &&
            thickness->at(static_cast<int>(c), static_cast<int>(r)) > 0.0) {
          return true;
        }
      }
    }
    return false;
  }
  [[nodiscard]] double height_at(int column, int row) const { return landform_.sign * terrain_.at(column, row); }
  [[nodiscard]] Line line_of(int column, int row, const Direction& across) const {
    return Line(2 * across.narrow, [&](int k) { return height_at(column + k * across.east, row + k * across.north); });
  }
  // Of the heights of a point in all directions.
  [[nodiscard]] double highest(int column, int row) const {
    double height = 0.0;
    for (const Direction& across : directions_) {
      height = std::max(height, line_of(column, row, across).crest(0, 2 * across.narrow));
    }
    return height;
  }
  // True if the raster has the points of a line across a point.
  [[nodiscard]] bool is_inside(int column, int row, const Direction& across) const {
    const int columns = std::abs(across.east) * 2 * across.narrow, rows = std::abs(across.north) * 2 * across.narrow;
    return column >= columns && column + columns < terrain_.columns && row >= rows && row + rows < terrain_.rows;
  }

  const Model<Dim>& model_;
  const Raster& terrain_;
  double cell_;
  Landform landform_;
  double least_;  // height [m]
  Ground columns_;
  std::vector<Direction> directions_;
  double top_;  // of the bodies [m]
  bool simulation_is_filtered_;
  std::vector<const Raster*> scars_;  // thicknesses of releases that were cut out
};

// Terrain of a profile between the sides of the domain, as a raster of one row.
template <int Dim>
Raster raster_of_profile(const Simulation<Dim>& simulation) {
  constexpr double points_per_cell = 8.0;
  const config::Grid& grid = simulation.parameters().grid;
  const Model<Dim>& model = simulation.model();
  Raster raster;
  raster.x = grid.min[0];
  raster.y = Dim == 3 ? grid.min[1] : 0.0;
  raster.cell_x = raster.cell_y = grid.cell / points_per_cell;
  raster.columns = 1 + static_cast<int>(std::lround((grid.max[0] - grid.min[0]) / raster.cell_x));
  raster.rows = 1;
  for (int column = 0; column < raster.columns; ++column) {
    raster.values.push_back(model.profile->height(raster.x_of(column) - grid.min[0]) + model.origin[Dim - 1]);
  }
  return raster;
}

}  // namespace

template <int Dim>
std::vector<std::string> warnings_of_unresolved_terrain(const Simulation<Dim>& simulation,
                                                        const std::vector<BodyFigures>& bodies) {
  const Model<Dim>& model = simulation.model();
  const config::Grid& grid = simulation.parameters().grid;
  if (!model.ground) {
    return {};
  }
  double thickness = 0.0;
  for (const BodyFigures& body : bodies) {
    thickness = std::max(thickness, body.median_thickness);
  }
  const Raster profile = model.profile ? raster_of_profile(simulation) : Raster{};
  const config::Site& site = simulation.site();
  const Raster& terrain = model.profile ? profile : site.before_smoothing ? *site.before_smoothing : *site.ground;
  std::vector<std::string> warnings = warnings_of_steep_terrain(simulation, bodies, terrain);
  for (const Landform& landform : {Landform{1.0, 1.0, "dyke", "high"}, Landform{-1.0, 2.0, "gully", "deep"}}) {
    const CrestSearch<Dim> search(simulation, terrain, landform, relevant * thickness);
    const Crest crest = search.worst();
    if (crest.height > 0.0) {
      const std::optional<double> cell = search.cell_for(crest);
      const std::string remedy =
          cell ? fmt::format("Use cells of at most {:g} m to keep it.", rounded_down(*cell, 2))
               : fmt::format("The filter of the DEM, {:g} m, removes it: a smaller terrain.smooth keeps it.",
                             site.roughness->width);
      warnings.push_back(fmt::format(
          "grid.cell: at {} the terrain has a {} too narrow for cells of {:g} m: it is {} m {}, and {} m in the "
          "columns of nodes. {}",
          place_text<Dim>(crest.place[0], crest.place[1]), landform.name, grid.cell, rounded_text(crest.height, 2),
          landform.extent, rounded_text(crest.on_grid, 2), remedy));
    }
  }
  return warnings;
}

template std::vector<std::string> warnings_of_unresolved_terrain(const Simulation<2>&, const std::vector<BodyFigures>&);
template std::vector<std::string> warnings_of_unresolved_terrain(const Simulation<3>&, const std::vector<BodyFigures>&);

}  // namespace thawslide::sim
