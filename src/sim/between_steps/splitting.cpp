#include "sim/between_steps/splitting.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/instances.hpp"
#include "base/rounding.hpp"
#include "terrain/following_ground.hpp"

namespace thawslide::sim {

namespace {

// Halves all extensive fields.
template <int Dim>
void halve(mpm::Particles<Dim>& particles, std::size_t p) {
  for (typename mpm::Particles<Dim>::Scalar* field :
       {&particles.mass, &particles.volume, &particles.initial_volume, &particles.seeped_water}) {
    if (field->is_kept()) {
      (*field)(p) *= 0.5;
    }
  }
}

// Change of velocity over a distance, by the affine velocity of APIC.
template <int Dim>
Vector<double, Dim> affine_change(const mpm::Particles<Dim>& particles, std::size_t p,
                                  const Vector<double, Dim>& distance) {
  Vector<double, Dim> change = Vector<double, Dim>::Zero();
  for (int b = 0; particles.affine_velocity.is_kept() && b < Dim; ++b) {
    for (int a = 0; a < Dim; ++a) {
      change[a] += particles.affine_velocity(p, b * Dim + a) * distance[b];
    }
  }
  return change;
}

// Moves a half. Its initial position remains that of the particle before.
template <int Dim>
void move(mpm::Particles<Dim>& particles, std::size_t p, const Vector<double, Dim>& position,
          const Vector<double, Dim>& change_of_velocity) {
  for (int a = 0; a < Dim; ++a) {
    particles.displacement(p, a) += position[a] - particles.position(p, a);
    particles.position(p, a) = position[a];
    particles.velocity(p, a) += change_of_velocity[a];
  }
}

// Halves of a particle at its height above the ground; none if it is short enough, or one of them would be outside the
// domain or the known terrain.
template <int Dim>
std::optional<Split<Dim>> split_of(const Model<Dim>& model, const Slide<Dim>& slide, std::size_t particle) {
  const mpm::Particles<Dim>& particles = slide.particles;
  const auto body = static_cast<std::size_t>(particles.body(particle));
  const double half_size = model.motion.sizes.half(body);
  const auto axis = mpm::longest_axis<Dim>(mpm::surface_stretch_of<Dim>(particles, particle));
  const bool is_torn = particles.volume(particle) > mpm::torn_volume * particles.initial_volume(particle);
  if (is_torn || !mpm::is_too_long(axis.stretch, half_size)) {
    return {};
  }
  Split<Dim> split{particle, {}, axis.direction};
  const Vector<double, Dim - 1> quarter = 0.5 * half_size * slide.grid.cell() * axis.stretch * axis.direction;
  const auto position = particles.position.template get<Vector<double, Dim>>(particle);
  const auto height_of_ground = [&](const Vector<double, Dim>& place) {
    return model.ground->height(place.template head<Dim - 1>(), body);
  };
  const double above = position[Dim - 1] - height_of_ground(position);
  for (std::size_t side = 0; side < 2; ++side) {
    Vector<double, Dim>& place = split.positions[side];
    place = position;
    place.template head<Dim - 1>() += side == 0 ? Vector<double, Dim - 1>(-quarter) : quarter;
    if (!model.ground->is_known(place.template head<Dim - 1>())) {
      return {};
    }
    place[Dim - 1] = height_of_ground(place) + above;
    for (int a = 0; a < Dim; ++a) {
      if (!(place[a] >= 0.0 && place[a] <= model.constraints.extent[a])) {
        return {};
      }
    }
  }
  return split;
}

// Energy gained by splitting [J]: halves on curved ground are higher or lower than the particle, and APIC's affine
// velocity becomes a difference of their velocities.
template <int Dim>
double energy_gained(const Vector<double, Dim>& gravity, const mpm::Particles<Dim>& particles,
                     const Split<Dim>& split) {
  const double half_mass = 0.5 * particles.mass(split.particle);
  const auto position = particles.position.template get<Vector<double, Dim>>(split.particle);
  const Vector<double, Dim> displaced = (split.positions[0] - position) + (split.positions[1] - position);
  const Vector<double, Dim> apart = affine_change(particles, split.particle, split.half_way());
  return half_mass * (apart.squaredNorm() - gravity.dot(displaced));
}

std::int64_t most_splits(const config::Case& parameters, std::size_t at_start) {
  const double by_case = parameters.mechanics.split_limit * static_cast<double>(at_start);
  return static_cast<std::int64_t>(std::min(by_case, mpm::most_particles)) - static_cast<std::int64_t>(at_start);
}

}  // namespace

template <int Dim>
std::vector<Split<Dim>> splits_due(const Setup<Dim>& setup, const Slide<Dim>& slide) {
  std::vector<Split<Dim>> due;
  for (std::size_t p = 0; p < slide.particles.size(); ++p) {
    if (const std::optional<Split<Dim>> split = split_of(setup.model, slide, p)) {
      due.push_back(*split);
    }
  }
  std::sort(due.begin(), due.end(), [&](const auto& a, const auto& b) {
    return slide.particles.id(a.particle) < slide.particles.id(b.particle);
  });
  const std::int64_t left =
      std::max(std::int64_t{0}, most_splits(setup.parameters, slide.count_at_start) - slide.split_count);
  due.resize(std::min(due.size(), static_cast<std::size_t>(left)));
  return due;
}

template <int Dim>
void split(const Setup<Dim>& setup, const std::vector<Split<Dim>>& due, Slide<Dim>& slide, double& energy) {
  mpm::Particles<Dim>& particles = slide.particles;
  const std::size_t first = particles.append(due.size());
  for (std::size_t k = 0; k < due.size(); ++k) {
    const std::size_t p = due[k].particle, other = first + k;
    energy += energy_gained(setup.model.motion.gravity, particles, due[k]);
    halve(particles, p);
    mpm::set_surface_stretch<Dim>(particles, p,
                                  mpm::halved<Dim>(mpm::surface_stretch_of<Dim>(particles, p), due[k].direction));
    for (mpm::FieldBase* field : particles.fields.all()) {
      field->copy(p, other);
    }
    particles.id(other) = slide.next_id++;
    particles.parent_id(other) = particles.id(p);
    const Vector<double, Dim> change = affine_change(particles, p, due[k].half_way());
    move(particles, p, due[k].positions[0], Vector<double, Dim>(-change));
    move(particles, other, due[k].positions[1], change);
  }
  slide.split_count += static_cast<std::int64_t>(due.size());
  slide.are_located = false;
  slide.locate(setup.model);
  slide.update_grid(setup.model, 0);
}

template <int Dim>
std::string split_warning(const Setup<Dim>& setup, const Slide<Dim>& slide, double time) {
  if (!setup.model.splits_stretched || slide.split_count < most_splits(setup.parameters, slide.count_at_start)) {
    return "";
  }
  const auto at_start = static_cast<double>(slide.count_at_start);
  return fmt::format(
      "warning: at t = {:.6g} s splitting has made {} particles of {}, and mechanics.split_limit is {:g}. From here on "
      "no particle is split, and a stretched slide can tear. Set a larger mechanics.split_limit, also with `resume "
      "--set`, or a larger grid.cell",
      time, count_text(at_start + static_cast<double>(slide.split_count)), count_text(at_start),
      setup.parameters.mechanics.split_limit);
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                   \
  template std::vector<Split<Dim>> splits_due<Dim>(const Setup<Dim>&, const Slide<Dim>&);            \
  template void split<Dim>(const Setup<Dim>&, const std::vector<Split<Dim>>&, Slide<Dim>&, double&); \
  template std::string split_warning<Dim>(const Setup<Dim>&, const Slide<Dim>&, double);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
