// Erodible bed of a case.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "base/raster.hpp"
#include "config/site.hpp"
#include "sim/solver/budget.hpp"
#include "sim/solver/slide.hpp"
#include "sim/solver/solver.hpp"
#include "terrain/bed.hpp"

namespace thawslide::sim {

namespace detail {

// Minimum fraction of a full particle; smaller volumes wait, because particles with almost no mass are useless.
inline constexpr double least_fraction = 0.01;
// Volume of bed below the nodes of a column [m3], over the part of the domain nearest to them. That of polygons is
// exact; other depths are sampled at the same number of points along each axis.
template <int Dim>
double volume_below(const config::Case& parameters, const config::Site& site,
                    const typename terrain::Bed<Dim>::Column& column) {
  constexpr int samples = 4;
  const config::Grid& grid = parameters.grid;
  const InitialField& depth = parameters.bed.depth;
  if constexpr (Dim == 3) {
    if (!site.bed_in_columns.empty()) {
      return site.bed_in_columns.at(column[0], column[1]) * grid.cell * grid.cell;
    }
  }
  double sum = 0.0;
  const auto coordinate = [&](int number, std::size_t axis) {
    const double part = (static_cast<double>(number) + 0.5) / samples - 0.5;
    return grid.min[axis] + (static_cast<double>(column[axis]) + part) * grid.cell;
  };
  const auto is_inside = [&](double position, std::size_t axis) {
    return position > grid.min[axis] && position < grid.max[axis];
  };
  for (int i = 0; i < samples; ++i) {
    const double x = coordinate(i, 0);
    for (int j = 0; j < (Dim == 3 ? samples : 1); ++j) {
      const double y = Dim == 3 ? coordinate(j, Dim - 2) : 0.0;
      if (is_inside(x, 0) && (Dim == 2 || is_inside(y, 1))) {
        sum += depth.is_map() ? bilinear(site.bed_depth, x, y, Missing::zero) : depth.at(0.0, x);
      }
    }
  }
  return sum * std::pow(grid.cell / samples, Dim - 1);
}

inline terrain::BedMaterial make_bed_material(const config::Bed& bed, double density) {
  return {bed.law, bed.strength, std::tan(bed.friction_angle * pi / 180.0), bed.depth_per_slip, density};
}

// Positions below the slide at which material removed from columns may join, relative to the domain's lower corner:
// below the lowest particle over each column. Particles farther ahead or to the side would carry the slide to bed that
// it has not reached. A column without particles above it uses its centre.
template <int Dim>
std::vector<Vector<double, Dim - 1>> places_below_slide(
    const Slide<Dim>& slide, double cell, const std::vector<typename terrain::Bed<Dim>::Column>& columns) {
  struct Lowest {
    Vector<double, Dim - 1> position;
    double height = HUGE_VAL;
    std::int64_t id = -1;
  };
  std::map<typename terrain::Bed<Dim>::Column, Lowest> lowest;
  for (const auto& column : columns) {
    for (int a = 0; a + 1 < Dim; ++a) {
      lowest[column].position[a] = column[static_cast<std::size_t>(a)] * cell;
    }
  }
  for (const std::uint32_t p : slide.grid.order()) {
    typename terrain::Bed<Dim>::Column column;
    for (int a = 0; a + 1 < Dim; ++a) {
      column[static_cast<std::size_t>(a)] = static_cast<int>(std::lround(slide.particles.position(p, a) / cell));
    }
    const auto found = lowest.find(column);
    const auto height = slide.particles.position(p, Dim - 1);
    const std::int64_t id = slide.particles.id(p);
    if (found != lowest.end() && std::tie(height, id) < std::tie(found->second.height, found->second.id)) {
      found->second = {slide.particles.position.template get<Vector<double, Dim - 1>>(p), height, id};
    }
  }
  std::vector<Vector<double, Dim - 1>> positions;
  for (const auto& column : columns) {
    positions.push_back(lowest.at(column).position);
  }
  return positions;
}

// Creates a bed particle on the ground, within one particle length behind a position below the slide. Consecutive
// numbers fill this length evenly (multiples of the golden ratio). The particle carries no stress at first, so nodal
// forces do not change.
template <int Dim>
NewParticle<Dim> particle_of_bed(const Setup<Dim>& setup, Vector<double, Dim - 1> position,
                                 const terrain::LooseMaterial<Dim>& material, std::int64_t number) {
  const Model<Dim>& model = setup.model;
  const double cell = setup.cell();
  const auto body = static_cast<std::int32_t>(model.body_names.size() - 1);
  const double half = model.motion.sizes.half(static_cast<std::size_t>(body)) * cell;
  const double turn = 0.6180339887498949 * static_cast<double>(number);
  const Vector<double, Dim - 1> along = material.momentum.template head<Dim - 1>();
  if (along.norm() > 0.0) {
    position -= 2.0 * half * (turn - std::floor(turn)) * along.normalized();
  }
  for (int a = 0; a + 1 < Dim; ++a) {
    position[a] = std::clamp(position[a], half, model.constraints.extent[a] - half);
  }
  const Vector<double, Dim> normal = model.ground->normal_below(position, cell);
  NewParticle<Dim> one;
  one.body = body;
  one.material = static_cast<std::int32_t>(
      std::find(model.material_names.begin(), model.material_names.end(), setup.parameters.bed.material) -
      model.material_names.begin());
  const double height = model.ground->height(position, static_cast<std::size_t>(body)) + half;
  for (int a = 0; a + 1 < Dim; ++a) {
    one.position[a] = position[a];
  }
  one.position[Dim - 1] = height;
  one.velocity = material.momentum / material.mass;
  one.volume = material.mass / model.bed_density;
  one.temperature = setup.parameters.bed.temperature;
  one.porosity = setup.parameters.bed.porosity;
  const double weight = model.bed_density * model.motion.gravity.norm() * std::abs(normal[Dim - 1]);
  one.flow_depth = weight > 0.0 ? material.normal_pressure / weight : 0.0;
  one.heat = material.work - 0.5 * material.momentum.squaredNorm() / material.mass;
  return one;
}

}  // namespace detail

// Empty if the case has no bed.
template <int Dim>
std::optional<terrain::Bed<Dim>> make_bed(const config::Case& parameters, const config::Site& site,
                                          const Model<Dim>& model) {
  if (parameters.bed.law == config::BedLaw::none) {
    return std::nullopt;
  }
  typename terrain::Bed<Dim>::Column columns{}, at{};
  std::size_t count = 1;
  for (std::size_t a = 0; a < columns.size(); ++a) {
    columns[a] =
        static_cast<int>(std::lround((parameters.grid.max[a] - parameters.grid.min[a]) / parameters.grid.cell)) + 1;
    count *= static_cast<std::size_t>(columns[a]);
  }
  std::vector<double> mass(count);
  for (double& of_column : mass) {
    of_column = model.bed_density * detail::volume_below<Dim>(parameters, site, at);
    for (std::size_t a = 0; a < at.size() && ++at[a] == columns[a]; ++a) {
      at[a] = 0;
    }
  }
  return terrain::Bed<Dim>(detail::make_bed_material(parameters.bed, model.bed_density), columns, std::move(mass));
}

// Steps between two additions of particles; each addition rebuilds the grid around the new ones.
inline constexpr std::int64_t joining_interval = 8;

// Takes loose material off the bed that joins the slide, and adds its terms to the budget. The particles of the slide
// are updated in host memory if any joins. Loose material joins as soon as it suffices for a particle. Smaller
// particles join if the bed is exhausted, or if the slide has moved on by a cell.
template <int Dim>
std::vector<NewParticle<Dim>> loose_particles(const Setup<Dim>& setup, const Solver<Dim>& solver,
                                              const Slide<Dim>& slide, terrain::Bed<Dim>& bed, Budget<Dim>& budget) {
  const double whole = setup.model.bed_density * std::pow(setup.cell() / setup.parameters.bed.particles_per_axis, Dim);
  std::vector<typename terrain::Bed<Dim>::Column> columns;
  std::vector<terrain::LooseMaterial<Dim>> parts;
  bed.release([&](const auto& column, const terrain::LooseMaterial<Dim>& material) {
    const bool has_passed = material.idle * material.momentum.norm() > slide.grid.cell() * material.mass;
    const bool is_last = bed.is_exhausted(column) || has_passed;
    if (!(material.mass >= whole || (is_last && material.mass >= detail::least_fraction * whole))) {
      return false;
    }
    const auto count = static_cast<std::size_t>(std::max(1.0, std::floor(material.mass / whole)));
    terrain::LooseMaterial<Dim> part = material;
    part.mass /= static_cast<double>(count);
    part.momentum /= static_cast<double>(count);
    part.work /= static_cast<double>(count);
    columns.insert(columns.end(), count, column);
    parts.insert(parts.end(), count, part);
    return true;
  });
  if (columns.empty()) {
    return {};
  }
  solver.sync_to_host();
  const auto positions = detail::places_below_slide(slide, setup.cell(), columns);
  std::vector<NewParticle<Dim>> joining;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    joining.push_back(
        detail::particle_of_bed(setup, positions[k], parts[k], slide.next_id + static_cast<std::int64_t>(k)));
    budget.bed_joined_mass += parts[k].mass;
    budget.bed_heat += joining[k].heat;
    budget.bed_joined_kinetic += parts[k].work - joining[k].heat;
  }
  return joining;
}

}  // namespace thawslide::sim
