#include "sim/entrainment.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/instances.hpp"
#include "base/raster_sampling.hpp"
#include "sim/simulation.hpp"

namespace thawslide::sim {

namespace {

// Less of a particle than this share of a whole one waits: particles almost without mass are of no use.
constexpr double least_share = 0.01;

// Volume of bed below the nodes of a column [m3]: in the part of the domain that is nearest to them. The depth is
// looked up at as many places along each axis.
template <int Dim>
double volume_below(const config::Case& parameters, const config::Site& site,
                    const typename terrain::Bed<Dim, double>::Column& column) {
  constexpr int looks = 4;
  const config::Grid& grid = parameters.grid;
  const InitialField& depth = parameters.bed.depth;
  double sum = 0.0;
  const auto look = [&](int number, std::size_t axis) {
    const double part = (static_cast<double>(number) + 0.5) / looks - 0.5;
    return grid.min[axis] + (static_cast<double>(column[axis]) + part) * grid.cell;
  };
  const auto is_inside = [&](double place, std::size_t axis) {
    return place > grid.min[axis] && place < grid.max[axis];
  };
  for (int i = 0; i < looks; ++i) {
    const double x = look(i, 0);
    for (int j = 0; j < (Dim == 3 ? looks : 1); ++j) {
      const double y = Dim == 3 ? look(j, Dim - 2) : 0.0;
      if (is_inside(x, 0) && (Dim == 2 || is_inside(y, 1))) {
        sum += depth.is_map() ? bilinear(site.bed_depth, x, y, Missing::zero) : depth.at(0.0, x);
      }
    }
  }
  return sum * std::pow(grid.cell / looks, Dim - 1);
}

template <class Real>
terrain::BedMatter<Real> make_matter(const config::Bed& bed, Real density) {
  return {bed.law == config::BedLaw::strength ? terrain::BedLaw::strength : terrain::BedLaw::momentum,
          static_cast<Real>(bed.strength), static_cast<Real>(std::tan(bed.friction_angle * pi<double> / 180.0)),
          static_cast<Real>(bed.depth_per_slip), density};
}

}  // namespace

template <int Dim, class Real>
std::optional<terrain::Bed<Dim, Real>> make_bed(const config::Case& parameters, const config::Site& site,
                                                const Model<Dim, Real>& model) {
  if (parameters.bed.law == config::BedLaw::none) {
    return std::nullopt;
  }
  typename terrain::Bed<Dim, Real>::Column columns{}, at{};
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
  return terrain::Bed<Dim, Real>(make_matter(parameters.bed, model.bed_density), columns, std::move(mass));
}

// A particle of bed matter lies on the ground, at a place of the column that differs from one to the next (Roberts'
// sequence of low discrepancy). It bears nothing at first, so that the forces on nodes are what they were.
template <int Dim, class Real>
NewParticle<Dim, Real> Simulation<Dim, Real>::particle_of_bed(const typename terrain::Bed<Dim, Real>::Column& column,
                                                              const terrain::LooseMatter<Dim, Real>& matter,
                                                              std::int64_t number) const {
  constexpr std::array<double, 2> steps =
      Dim == 2 ? std::array{0.6180339887498949, 0.0} : std::array{0.7548776662466927, 0.5698402909980532};
  const double cell = parameters_.grid.cell;
  const auto body = static_cast<std::int32_t>(model_.body_names.size() - 1);
  const double half = static_cast<double>(model_.motion.sizes.half(static_cast<std::size_t>(body))) * cell;
  Vector<double, Dim - 1> middle, place;
  for (std::size_t a = 0; a < column.size(); ++a) {
    const int i = static_cast<int>(a);
    const double turn = steps[a] * static_cast<double>(number);
    const double last = static_cast<double>(model_.constraints.extent[i]) - half;
    middle[i] = std::clamp(column[a] * cell, half, last);
    place[i] = std::clamp((column[a] + turn - std::floor(turn) - 0.5) * cell, half, last);
  }
  if (!model_.ground->is_known(place)) {
    place = middle;
  }
  const Vector<double, Dim> normal = model_.ground->normal_below(place, cell);
  NewParticle<Dim, Real> one;
  one.body = body;
  one.material = static_cast<std::int32_t>(
      std::find(model_.material_names.begin(), model_.material_names.end(), parameters_.bed.material) -
      model_.material_names.begin());
  const double height = model_.ground->height(place) + half * normal.cwiseAbs().maxCoeff() / std::abs(normal[Dim - 1]);
  for (int a = 0; a + 1 < Dim; ++a) {
    one.position[a] = static_cast<Real>(place[a]);
  }
  one.position[Dim - 1] = static_cast<Real>(height);
  one.velocity = matter.momentum / matter.mass;
  one.volume = matter.mass / model_.bed_density;
  one.temperature = static_cast<Real>(parameters_.bed.temperature);
  one.porosity = static_cast<Real>(parameters_.bed.porosity);
  const Real weight = model_.bed_density * model_.motion.gravity.norm() * static_cast<Real>(std::abs(normal[Dim - 1]));
  one.flow_depth = weight > Real(0) ? matter.normal_pressure / weight : Real(0);
  one.heat = matter.work - Real(0.5) * matter.momentum.squaredNorm() / matter.mass;
  return one;
}

// What contact nodes have taken in this step.
template <int Dim, class Real>
void Simulation<Dim, Real>::collect_bed() {
  if (bed_in_reach() != nullptr) {
    bed_->collect(grid_, nodes_, dt_);
    ledger_.bed_work += contact_.bed_work;
    ledger_.bed_impulse += contact_.bed_impulse;
  }
}

// What is loose joins as soon as it makes a particle; as a smaller one where nothing is left of the bed, or where the
// slide has gone on by a cell.
template <int Dim, class Real>
void Simulation<Dim, Real>::take_up_bed() {
  const Real whole =
      model_.bed_density * static_cast<Real>(std::pow(parameters_.grid.cell / parameters_.bed.particles_per_axis, Dim));
  std::vector<NewParticle<Dim, Real>> joining;
  bed_->release([&](const auto& column, const terrain::LooseMatter<Dim, Real>& matter) {
    const bool has_passed = matter.idle * matter.momentum.norm() > grid_.cell() * matter.mass;
    const bool is_last = bed_->is_exhausted(column) || has_passed;
    if (!(matter.mass >= whole || (is_last && matter.mass >= static_cast<Real>(least_share) * whole))) {
      return false;
    }
    const Real parts = std::max(Real(1), std::floor(matter.mass / whole));
    terrain::LooseMatter<Dim, Real> part = matter;
    part.mass /= parts;
    part.momentum /= parts;
    part.work /= parts;
    for (Real k = 0; k < parts; ++k) {
      joining.push_back(particle_of_bed(column, part, next_id_ + static_cast<std::int64_t>(joining.size())));
      ledger_.bed_joined_mass += part.mass;
      ledger_.bed_heat += joining.back().heat;
      ledger_.bed_joined_kinetic += part.work - joining.back().heat;
    }
    return true;
  });
  append(joining);
}

#define THAWSLIDE_INSTANTIATE(Dim, Real)                                                                            \
  template std::optional<terrain::Bed<Dim, Real>> make_bed<Dim, Real>(const config::Case&, const config::Site&,     \
                                                                      const Model<Dim, Real>&);                     \
  template NewParticle<Dim, Real> Simulation<Dim, Real>::particle_of_bed(                                           \
      const typename terrain::Bed<Dim, Real>::Column&, const terrain::LooseMatter<Dim, Real>&, std::int64_t) const; \
  template void Simulation<Dim, Real>::collect_bed();                                                               \
  template void Simulation<Dim, Real>::take_up_bed();
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
