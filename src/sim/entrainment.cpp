#include "sim/entrainment.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/raster_sampling.hpp"
#include "sim/simulation.hpp"
#include "terrain/ground_on_grid.hpp"

namespace thawslide::sim {

namespace {

// Minimum fraction of a full particle; smaller volumes wait, because particles with almost no mass are useless.
constexpr double least_fraction = 0.01;
// Steps between two additions; each addition rebuilds the grid around the new particles.
constexpr std::int64_t joining_interval = 8;

// Volume of bed below the nodes of a column [m3], over the part of the domain nearest to them. The depth is sampled at
// the same number of points along each axis.
template <int Dim>
double volume_below(const config::Case& parameters, const config::Site& site,
                    const typename terrain::Bed<Dim>::Column& column) {
  constexpr int samples = 4;
  const config::Grid& grid = parameters.grid;
  const InitialField& depth = parameters.bed.depth;
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

terrain::BedMaterial make_bed_material(const config::Bed& bed, Real density) {
  return {bed.law, static_cast<Real>(bed.strength), static_cast<Real>(std::tan(bed.friction_angle * pi / 180.0)),
          static_cast<Real>(bed.depth_per_slip), density};
}

}  // namespace

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
  std::vector<Real> mass(count);
  for (Real& of_column : mass) {
    of_column = model.bed_density * static_cast<Real>(volume_below<Dim>(parameters, site, at));
    for (std::size_t a = 0; a < at.size() && ++at[a] == columns[a]; ++a) {
      at[a] = 0;
    }
  }
  return terrain::Bed<Dim>(make_bed_material(parameters.bed, model.bed_density), columns, std::move(mass));
}

// Positions below the slide at which material removed from columns may join, relative to the domain's lower corner:
// below the lowest particle over each column. Particles farther ahead or to the side would carry the slide to bed that
// it has not reached. A column without particles above it uses its centre.
template <int Dim>
std::vector<Vector<double, Dim - 1>> Simulation<Dim>::places_below_slide(
    const std::vector<typename terrain::Bed<Dim>::Column>& columns) const {
  struct Lowest {
    Vector<double, Dim - 1> position;
    double height = HUGE_VAL;
    std::int64_t id = -1;
  };
  const double cell = parameters_.grid.cell;
  std::map<typename terrain::Bed<Dim>::Column, Lowest> lowest;
  for (const auto& column : columns) {
    for (int a = 0; a + 1 < Dim; ++a) {
      lowest[column].position[a] = column[static_cast<std::size_t>(a)] * cell;
    }
  }
  for (const std::uint32_t p : grid_.order()) {
    typename terrain::Bed<Dim>::Column column;
    for (int a = 0; a + 1 < Dim; ++a) {
      column[static_cast<std::size_t>(a)] =
          static_cast<int>(std::lround(static_cast<double>(particles_.position(p, a)) / cell));
    }
    const auto found = lowest.find(column);
    const auto height = static_cast<double>(particles_.position(p, Dim - 1));
    const std::int64_t id = particles_.id(p);
    if (found != lowest.end() && std::tie(height, id) < std::tie(found->second.height, found->second.id)) {
      found->second = {particles_.position.template get<Vector<Real, Dim - 1>>(p).template cast<double>(), height, id};
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
NewParticle<Dim> Simulation<Dim>::particle_of_bed(Vector<double, Dim - 1> position,
                                                  const terrain::LooseMaterial<Dim>& material,
                                                  std::int64_t number) const {
  const double cell = parameters_.grid.cell;
  const auto body = static_cast<std::int32_t>(model_.body_names.size() - 1);
  const double half = static_cast<double>(model_.motion.sizes.half(static_cast<std::size_t>(body))) * cell;
  const double turn = 0.6180339887498949 * static_cast<double>(number);
  const Vector<double, Dim - 1> along = material.momentum.template head<Dim - 1>().template cast<double>();
  if (along.norm() > 0.0) {
    position -= 2.0 * half * (turn - std::floor(turn)) * along.normalized();
  }
  for (int a = 0; a + 1 < Dim; ++a) {
    position[a] = std::clamp(position[a], half, static_cast<double>(model_.constraints.extent[a]) - half);
  }
  const Vector<double, Dim> normal = model_.ground->normal_below(position, cell);
  NewParticle<Dim> one;
  one.body = body;
  one.material = static_cast<std::int32_t>(
      std::find(model_.material_names.begin(), model_.material_names.end(), parameters_.bed.material) -
      model_.material_names.begin());
  const double height = model_.ground->height(position, static_cast<std::size_t>(body)) + half;
  for (int a = 0; a + 1 < Dim; ++a) {
    one.position[a] = static_cast<Real>(position[a]);
  }
  one.position[Dim - 1] = static_cast<Real>(height);
  one.velocity = material.momentum / material.mass;
  one.volume = material.mass / model_.bed_density;
  one.temperature = static_cast<Real>(parameters_.bed.temperature);
  one.porosity = static_cast<Real>(parameters_.bed.porosity);
  const Real weight = model_.bed_density * model_.motion.gravity.norm() * static_cast<Real>(std::abs(normal[Dim - 1]));
  one.flow_depth = weight > Real(0) ? material.normal_pressure / weight : Real(0);
  one.heat = material.work - Real(0.5) * material.momentum.squaredNorm() / material.mass;
  return one;
}

// Bed in contact with the slide in this step; null like bed_in_reach.
template <int Dim>
const terrain::Bed<Dim>* Simulation<Dim>::bed_to_meet() {
  if (bed_in_reach() != nullptr) {
    bed_->cover(grid_, *ground_, model_.motion.sizes, particles_);
  }
  return bed_in_reach();
}

// Collects the mass that contact nodes entrained in this step.
template <int Dim>
void Simulation<Dim>::collect_bed() {
  if (bed_in_reach() != nullptr) {
    bed_->collect(grid_, nodes_, dt_);
  }
}

// Adds loose material as soon as it suffices for a particle. Smaller particles are added if the bed is exhausted, or if
// the slide has moved on by a cell.
template <int Dim>
void Simulation<Dim>::entrain_bed() {
  if (step_number_ % joining_interval != 0) {
    return;
  }
  const Real whole =
      model_.bed_density * static_cast<Real>(std::pow(parameters_.grid.cell / parameters_.bed.particles_per_axis, Dim));
  std::vector<typename terrain::Bed<Dim>::Column> columns;
  std::vector<terrain::LooseMaterial<Dim>> parts;
  bed_->release([&](const auto& column, const terrain::LooseMaterial<Dim>& material) {
    const bool has_passed = material.idle * material.momentum.norm() > grid_.cell() * material.mass;
    const bool is_last = bed_->is_exhausted(column) || has_passed;
    if (!(material.mass >= whole || (is_last && material.mass >= static_cast<Real>(least_fraction) * whole))) {
      return false;
    }
    const auto count = static_cast<std::size_t>(std::max(Real(1), std::floor(material.mass / whole)));
    terrain::LooseMaterial<Dim> part = material;
    part.mass /= static_cast<Real>(count);
    part.momentum /= static_cast<Real>(count);
    part.work /= static_cast<Real>(count);
    columns.insert(columns.end(), count, column);
    parts.insert(parts.end(), count, part);
    return true;
  });
  if (columns.empty()) {
    return;
  }
  sync_to_host();
  const auto positions = places_below_slide(columns);
  std::vector<NewParticle<Dim>> joining;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    joining.push_back(particle_of_bed(positions[k], parts[k], next_id_ + static_cast<std::int64_t>(k)));
    budget_.bed_joined_mass += parts[k].mass;
    budget_.bed_heat += joining[k].heat;
    budget_.bed_joined_kinetic += parts[k].work - joining[k].heat;
  }
  append(joining);
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                    \
  template std::optional<terrain::Bed<Dim>> make_bed<Dim>(const config::Case&, const config::Site&,                   \
                                                          const Model<Dim>&);                                         \
  template std::vector<Vector<double, Dim - 1>> Simulation<Dim>::places_below_slide(                                  \
      const std::vector<typename terrain::Bed<Dim>::Column>&) const;                                                  \
  template NewParticle<Dim> Simulation<Dim>::particle_of_bed(Vector<double, Dim - 1>,                                 \
                                                             const terrain::LooseMaterial<Dim>&, std::int64_t) const; \
  template const terrain::Bed<Dim>* Simulation<Dim>::bed_to_meet();                                                   \
  template void Simulation<Dim>::collect_bed();                                                                       \
  template void Simulation<Dim>::entrain_bed();
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
