// Splitting of particles that have been stretched along the ground (mpm/splitting.hpp), between two steps.
#include "sim/splitting.hpp"

#include <algorithm>
#include <cmath>

#include "base/instances.hpp"
#include "base/rounding.hpp"
#include "sim/memory_need.hpp"
#include "sim/simulation.hpp"
#include "terrain/following_ground.hpp"

namespace thawslide::sim {

namespace {

constexpr std::int64_t split_interval = 10;  // steps between checks

// Halves all extensive fields.
template <int Dim>
void halve(mpm::Particles<Dim>& particles, std::size_t p) {
  for (typename mpm::Particles<Dim>::Scalar* field :
       {&particles.mass, &particles.volume, &particles.initial_volume, &particles.seeped_water}) {
    if (field->is_kept()) {
      (*field)(p) *= Real(0.5);
    }
  }
}

// Change of velocity over a distance, by the affine velocity of APIC.
template <int Dim>
Vector<Real, Dim> affine_change(const mpm::Particles<Dim>& particles, std::size_t p,
                                const Vector<Real, Dim>& distance) {
  Vector<Real, Dim> change = Vector<Real, Dim>::Zero();
  for (int b = 0; particles.affine_velocity.is_kept() && b < Dim; ++b) {
    for (int a = 0; a < Dim; ++a) {
      change[a] += particles.affine_velocity(p, b * Dim + a) * distance[b];
    }
  }
  return change;
}

// Moves a half. Its initial position remains that of the particle before.
template <int Dim>
void move(mpm::Particles<Dim>& particles, std::size_t p, const Vector<Real, Dim>& position,
          const Vector<Real, Dim>& change_of_velocity) {
  for (int a = 0; a < Dim; ++a) {
    particles.displacement(p, a) += position[a] - particles.position(p, a);
    particles.position(p, a) = position[a];
    particles.velocity(p, a) += change_of_velocity[a];
  }
}

}  // namespace

// Halves of a particle at its height above the ground; none if it is short enough, or one of them would be outside the
// domain or the known terrain.
template <int Dim>
std::optional<Split<Dim>> Simulation<Dim>::split_of(std::size_t particle) const {
  const auto body = static_cast<std::size_t>(particles_.body(particle));
  const Real half_size = model_.motion.sizes.half(body);
  const auto axis = mpm::longest_axis<Dim>(mpm::surface_stretch_of<Dim>(particles_, particle));
  const bool is_torn = particles_.volume(particle) > mpm::torn_volume * particles_.initial_volume(particle);
  if (is_torn || !mpm::is_too_long(axis.stretch, half_size)) {
    return {};
  }
  Split<Dim> split{particle, {}, axis.direction};
  const Vector<Real, Dim - 1> quarter = Real(0.5) * half_size * grid_.cell() * axis.stretch * axis.direction;
  const auto position = particles_.position.template get<Vector<Real, Dim>>(particle);
  const auto height_of_ground = [&](const Vector<Real, Dim>& place) {
    return model_.ground->height(place.template head<Dim - 1>().template cast<double>(), body);
  };
  const Real above = position[Dim - 1] - static_cast<Real>(height_of_ground(position));
  for (std::size_t side = 0; side < 2; ++side) {
    Vector<Real, Dim>& place = split.positions[side];
    place = position;
    place.template head<Dim - 1>() += side == 0 ? Vector<Real, Dim - 1>(-quarter) : quarter;
    if (!model_.ground->is_known(place.template head<Dim - 1>().template cast<double>())) {
      return {};
    }
    place[Dim - 1] = static_cast<Real>(height_of_ground(place)) + above;
    for (int a = 0; a < Dim; ++a) {
      if (!(place[a] >= Real(0) && place[a] <= model_.constraints.extent[a])) {
        return {};
      }
    }
  }
  return split;
}

// Particles to be split, by id. The limit admits those of smallest id.
template <int Dim>
std::vector<Split<Dim>> Simulation<Dim>::splits_due() const {
  std::vector<Split<Dim>> due;
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    if (const std::optional<Split<Dim>> split = split_of(p)) {
      due.push_back(*split);
    }
  }
  std::sort(due.begin(), due.end(),
            [&](const auto& a, const auto& b) { return particles_.id(a.particle) < particles_.id(b.particle); });
  const std::int64_t left = std::max(std::int64_t{0}, most_splits() - split_count_);
  due.resize(std::min(due.size(), static_cast<std::size_t>(left)));
  return due;
}

// Energy gained by splitting [J]: halves on curved ground are higher or lower than the particle, and APIC's affine
// velocity becomes a difference of their velocities.
template <int Dim>
Real Simulation<Dim>::energy_gained(const Split<Dim>& split) const {
  const Real half_mass = Real(0.5) * particles_.mass(split.particle);
  const auto position = particles_.position.template get<Vector<Real, Dim>>(split.particle);
  const Vector<Real, Dim> displaced = (split.positions[0] - position) + (split.positions[1] - position);
  const Vector<Real, Dim> apart = affine_change(particles_, split.particle, split.half_way());
  return half_mass * (apart.squaredNorm() - model_.motion.gravity.dot(displaced));
}

template <int Dim>
void Simulation<Dim>::split_stretched() {
  if (!model_.splits_stretched || step_number_ % split_interval != 0) {
    return;
  }
  stopwatch_.time("split_stretched", [&] {
    const std::vector<Split<Dim>> due = splits_due();
    if (!due.empty()) {
      split(due);
    }
  });
}

template <int Dim>
void Simulation<Dim>::split(const std::vector<Split<Dim>>& due) {
  const std::size_t first = particles_.append(due.size());
  for (std::size_t k = 0; k < due.size(); ++k) {
    const std::size_t p = due[k].particle, other = first + k;
    budget_.numerical += energy_gained(due[k]);
    halve(particles_, p);
    mpm::set_surface_stretch<Dim>(particles_, p,
                                  mpm::halved<Dim>(mpm::surface_stretch_of<Dim>(particles_, p), due[k].direction));
    for (mpm::FieldBase* field : particles_.fields.all()) {
      field->copy(p, other);
    }
    particles_.id(other) = next_id_++;
    particles_.parent_id(other) = particles_.id(p);
    const Vector<Real, Dim> change = affine_change(particles_, p, due[k].half_way());
    move(particles_, p, due[k].positions[0], Vector<Real, Dim>(-change));
    move(particles_, other, due[k].positions[1], change);
  }
  split_count_ += static_cast<std::int64_t>(due.size());
  are_particles_located_ = false;
  locate_particles();
  grid_.update(particles_, 0);  // without sorting, so the new particles stay last
  update_ground();
}

template <int Dim>
std::int64_t Simulation<Dim>::most_splits() const {
  const double by_case = parameters_.mechanics.split_limit * static_cast<double>(particles_at_start_);
  return static_cast<std::int64_t>(std::min(by_case, most_particles)) - static_cast<std::int64_t>(particles_at_start_);
}

template <int Dim>
std::string Simulation<Dim>::split_warning() const {
  if (!model_.splits_stretched || split_count_ < most_splits()) {
    return "";
  }
  return fmt::format(
      "warning: at t = {:.6g} s splitting has made {} particles of {}, and mechanics.split_limit is {:g}. From here on "
      "no particle is split, and a stretched slide can tear. Set a larger mechanics.split_limit, also with `resume "
      "--set`, or a larger grid.cell",
      time_, count_text(static_cast<double>(particles_at_start_) + static_cast<double>(split_count_)),
      count_text(static_cast<double>(particles_at_start_)), parameters_.mechanics.split_limit);
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                 \
  template std::optional<Split<Dim>> Simulation<Dim>::split_of(std::size_t) const; \
  template std::vector<Split<Dim>> Simulation<Dim>::splits_due() const;            \
  template Real Simulation<Dim>::energy_gained(const Split<Dim>&) const;           \
  template void Simulation<Dim>::split_stretched();                                \
  template void Simulation<Dim>::split(const std::vector<Split<Dim>>&);            \
  template std::int64_t Simulation<Dim>::most_splits() const;                      \
  template std::string Simulation<Dim>::split_warning() const;
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
