#include "sim/checks/body_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "config/case_proposal.hpp"
#include "sim/setup/body_shape.hpp"

namespace thawslide::sim {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Column of particles of one body.
struct Column {
  double volume = 0.0;
  double underside = infinity;  // of the lowest particle [m], relative to the domain's lower corner
  std::size_t lowest = 0;
};

template <int Dim>
class Bodies {
 public:
  explicit Bodies(const Simulation<Dim>& simulation) : simulation_(simulation) {
    for (const std::string& name : simulation.model().body_names) {
      const auto body = parameters().bodies.find(name);
      const int per_axis = body == parameters().bodies.end() ? 1 : body->second.particles_per_axis;
      spacing_.push_back(parameters().grid.cell / per_axis);
    }
    columns_.resize(spacing_.size());
    const auto& particles = simulation.particles();
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const auto body = static_cast<std::size_t>(particles.body(p));
      const double spacing = spacing_[body];
      Column& column = columns_[body][cell_of<Dim - 1>(p, spacing)];
      column.volume += volume_in_section(p);
      const double underside = height(p) - 0.5 * volume_in_section(p) / std::pow(spacing, Dim - 1);
      if (underside < column.underside) {
        column.underside = underside;
        column.lowest = p;
      }
      if (parameters().bodies.size() > 1) {
        by_cell_[cell_of<Dim>(p, parameters().grid.cell)].push_back(p);
      }
    }
  }

  [[nodiscard]] BodyFigures figures(std::size_t number) const {
    BodyFigures figures;
    figures.name = simulation_.model().body_names[number];
    const std::vector<double>& release_times = simulation_.model().release_times;
    figures.release_time = release_times.empty() ? 0.0 : release_times[number];
    figures.spacing = spacing_[number];
    const double section = sum_particles(number, figures);
    figures.shape_volume = shape_volume(figures, section) * (figures.volume / section);
    measure_columns(number, figures);
    const auto release = simulation_.site().releases.find(figures.name);
    if (release != simulation_.site().releases.end()) {
      measure_release(release->second, figures);
    }
    figures.mean_thickness = section / figures.area;
    figures.particles_across = figures.median_thickness / figures.spacing;
    figures.max_particles_across = figures.largest_thickness / figures.spacing;
    return figures;
  }

 private:
  // Of a cubic cell, relative to the domain's lower corner.
  template <std::size_t Axes>
  using CellIndex = std::array<int, Axes>;

  [[nodiscard]] const config::Case& parameters() const { return simulation_.parameters(); }
  [[nodiscard]] double height(std::size_t p) const { return simulation_.particles().position(p, Dim - 1); }
  [[nodiscard]] std::size_t body_of(std::size_t p) const {
    return static_cast<std::size_t>(simulation_.particles().body(p));
  }
  // Cell of a lattice of this width [m].
  template <std::size_t Axes>
  [[nodiscard]] CellIndex<Axes> cell_of(std::size_t p, double width) const {
    CellIndex<Axes> index;
    for (std::size_t a = 0; a < Axes; ++a) {
      index[a] = static_cast<int>(std::floor(simulation_.particles().position(p, static_cast<int>(a)) / width));
    }
    return index;
  }

  // In a section as wide everywhere as results are per metre of.
  [[nodiscard]] double volume_in_section(std::size_t p) const {
    const auto& particles = simulation_.particles();
    return particles.volume(p) / simulation_.model().motion.width.at(particles.position(p, 0));
  }

  // Volume of the shape. A release or a body without a shape has the volume of its particles, `seeded`.
  [[nodiscard]] double shape_volume(const BodyFigures& figures, double seeded) const {
    const auto body = parameters().bodies.find(figures.name);
    if (body == parameters().bodies.end() || body->second.shape == config::BodyShape::release) {
      return seeded;
    }
    return BodyShape<Dim>(parameters(), simulation_.site(), body->second, std::nullopt).volume();
  }

  // Returns the volume in a section.
  double sum_particles(std::size_t number, BodyFigures& figures) const {
    const auto& particles = simulation_.particles();
    figures.coldest = infinity;
    figures.warmest = -infinity;
    double section = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      if (body_of(p) == number) {
        section += volume_in_section(p);
        ++figures.particles;
        figures.volume += particles.volume(p);
        figures.mass += particles.mass(p);
        figures.coldest = std::min(figures.coldest, particles.temperature(p));
        figures.warmest = std::max(figures.warmest, particles.temperature(p));
      }
    }
    return section;
  }

  void measure_columns(std::size_t number, BodyFigures& figures) const {
    const double width = std::pow(figures.spacing, Dim - 1);
    Raster thickness;  // by column
    double resting = 0.0;
    figures.clearance = infinity;
    for (const auto& [index, column] : columns_[number]) {
      thickness.values.push_back(column.volume / width);
      const double clearance = clearance_of(column);
      figures.clearance = std::min(figures.clearance, clearance);
      resting += clearance < figures.spacing ? 1.0 : 0.0;
    }
    const auto columns = static_cast<double>(thickness.values.size());
    figures.area = columns * width;
    figures.resting_fraction = resting / columns;
    figures.median_thickness = config::median_thickness(thickness);
    figures.largest_thickness = *std::max_element(thickness.values.begin(), thickness.values.end());
  }

  // Measures a release on its map, because particles along its edge share the volume there.
  static void measure_release(const config::Release& release, BodyFigures& figures) {
    const Raster& thickness = release.thickness;
    double covered = 0.0, largest = 0.0;
    for (const double value : thickness.values) {
      covered += value > 0.0 ? 1.0 : 0.0;
      largest = std::max(largest, std::isnan(value) ? 0.0 : value);
    }
    // A thickness raster has no outline; its area is that of the covered cells.
    figures.area = release.area > 0.0 ? release.area : covered * thickness.cell_x * thickness.cell_y;
    figures.median_thickness = config::median_thickness(thickness);
    figures.largest_thickness = largest;
  }

  // Clearance between a column's underside and the ground, a holding side of the domain, or another body [m].
  [[nodiscard]] double clearance_of(const Column& column) const {
    double below = -infinity;
    if (const auto& ground = simulation_.model().ground) {
      below = ground->height(simulation_.particles().position.template get<Vector<double, Dim - 1>>(column.lowest));
    }
    if (parameters().grid.boundary[2 * (Dim - 1)] != config::BoundaryKind::open) {
      below = std::max(below, 0.0);
    }
    return std::min(column.underside - below, clearance_over_bodies(column));
  }

  // Clearance above the nearest particle of another body in the cells around the lowest particle; infinite if there is
  // none.
  [[nodiscard]] double clearance_over_bodies(const Column& column) const {
    double clearance = infinity;
    const auto& particles = simulation_.particles();
    const CellIndex<Dim> middle = cell_of<Dim>(column.lowest, parameters().grid.cell);
    for (int k = 0; k < mpm::Tile<Dim>::stencil && !by_cell_.empty(); ++k) {
      CellIndex<Dim> point = middle;
      for (std::size_t a = 0, rest = static_cast<std::size_t>(k); a < Dim; ++a, rest /= 3) {
        point[a] += static_cast<int>(rest % 3) - 1;
      }
      const auto found = by_cell_.find(point);
      for (std::size_t n = 0; found != by_cell_.end() && n < found->second.size(); ++n) {
        const std::size_t p = found->second[n];
        const double half = 0.5 * spacing_[body_of(p)], reach = half + 0.5 * spacing_[body_of(column.lowest)];
        bool is_below = body_of(p) != body_of(column.lowest) && height(p) <= height(column.lowest);
        for (int a = 0; a + 1 < Dim; ++a) {
          is_below = is_below && std::abs(particles.position(p, a) - particles.position(column.lowest, a)) <= reach;
        }
        if (is_below) {
          clearance = std::min(clearance, std::max(0.0, column.underside - height(p) - half));
        }
      }
    }
    return clearance;
  }

  const Simulation<Dim>& simulation_;
  std::vector<double> spacing_;                                 // by body [m]
  std::vector<std::map<CellIndex<Dim - 1>, Column>> columns_;   // by body, on a lattice with its spacing
  std::map<CellIndex<Dim>, std::vector<std::size_t>> by_cell_;  // particle indices; empty for one body
};

}  // namespace

template <int Dim>
std::vector<BodyFigures> body_figures(const Simulation<Dim>& simulation) {
  const Bodies<Dim> bodies(simulation);
  std::vector<BodyFigures> all;
  for (std::size_t b = 0; b < simulation.parameters().bodies.size(); ++b) {
    all.push_back(bodies.figures(b));
  }
  return all;
}

template std::vector<BodyFigures> body_figures<2>(const Simulation<2>&);
template std::vector<BodyFigures> body_figures<3>(const Simulation<3>&);

}  // namespace thawslide::sim
