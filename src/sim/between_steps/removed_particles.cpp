#include "sim/between_steps/removed_particles.hpp"

#include <algorithm>
#include <cmath>

#include "base/instances.hpp"
#include "base/parallel.hpp"
#include "mpm/sum_over_particles.hpp"
#include "sim/between_steps/run_failure.hpp"

namespace thawslide::sim {

namespace {

Mark mark_of(mpm::Fault fault, const config::Guards& guards) {
  switch (fault) {
    case mpm::Fault::volume_not_finite:
    case mpm::Fault::state_not_finite:
      return guards.not_finite == config::Policy::remove ? is_not_finite : stays;
    case mpm::Fault::volume_not_positive:
    case mpm::Fault::volume_too_small:
    case mpm::Fault::volume_too_large:
      return guards.volume == config::Policy::remove ? has_inverted : stays;
    case mpm::Fault::left_domain:
    case mpm::Fault::left_map:
    case mpm::Fault::none:
      break;
  }
  return stays;
}

// Fault of a single particle after a step.
template <int Dim>
mpm::Fault fault_of(const mpm::Particles<Dim>& particles, std::size_t p, const config::Guards& guards) {
  const double volume = particles.volume(p);
  if (!std::isfinite(volume)) {
    return mpm::Fault::volume_not_finite;
  }
  double state = particles.temperature(p) + particles.pore_pressure(p) + particles.stress(p, 0);
  for (int a = 0; a < Dim; ++a) {
    state += particles.step_displacement(p, a);
  }
  if (!std::isfinite(state)) {
    return mpm::Fault::state_not_finite;
  }
  const auto ratio = volume / particles.initial_volume(p);
  if (ratio <= 0.0) {
    return mpm::Fault::volume_not_positive;
  }
  if (ratio < guards.smallest_volume) {
    return mpm::Fault::volume_too_small;
  }
  return ratio > guards.largest_volume ? mpm::Fault::volume_too_large : mpm::Fault::none;
}

// Marks particles outside the domain.
template <int Dim>
void mark_left_domain(const mpm::Particles<Dim>& particles, const Vector<double, Dim>& extent,
                      std::vector<std::uint8_t>& marks) {
  parallel_for(marks.size(), std::size_t{1024}, [&](std::size_t p) {
    for (int a = 0; a < Dim && marks[p] == stays; ++a) {
      if (particles.position(p, a) < 0.0 || particles.position(p, a) > extent[a]) {
        marks[p] = has_left;
      }
    }
  });
}

// For a non-finite particle, only mass and position are known; the residuals of the other terms show its content.
template <int Dim>
void add_not_finite(const Setup<Dim>& setup, const mpm::Particles<Dim>& particles, std::size_t p, Budget<Dim>& budget) {
  budget.left_mass += particles.mass(p);
  const Vector<double, Dim> position = position_of(setup.model, particles, p);
  budget.left_mechanical -= particles.mass(p) * setup.model.motion.gravity.dot(position);
}

// The effect of a step with a non-finite particle is unknown as well, so its budget terms stay unchanged.
template <int Dim>
void undo_not_finite(Budget<Dim> before, Budget<Dim>& budget) {
  std::vector<double> terms;
  before.for_each([&](const double& term) { terms.push_back(term); });
  std::size_t k = 0;
  budget.for_each([&](double& term) {
    term = std::isfinite(term) ? term : terms[k];
    ++k;
  });
}

}  // namespace

template <int Dim>
void mark_invalid(const config::Guards& guards, const mpm::Particles<Dim>& particles, Marks& marks,
                  mpm::InvalidParticle& invalid) {
  marks.clear();
  if (invalid.id < 0 || mark_of(invalid.fault, guards) == stays) {
    return;
  }
  invalid = {};
  marks.assign(particles.size(), stays);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const mpm::Fault fault = fault_of(particles, p, guards);
    marks[p] = mark_of(fault, guards);
    if (fault != mpm::Fault::none && marks[p] == stays) {
      invalid.record(particles.id(p), fault);
    }
  }
}

template <int Dim>
void mark_left(const Setup<Dim>& setup, const Slide<Dim>& slide, bool all_tiles, Marks& marks,
               mpm::InvalidParticle& invalid) {
  const bool removes = setup.parameters.grid.leaving == config::Policy::remove;
  if (removes) {
    marks.resize(slide.particles.size(), stays);
    mark_left_domain<Dim>(slide.particles, setup.model.constraints.extent, marks);
  }
  const std::size_t tiles = setup.model.ground ? slide.grid.tiles().size() : 0;
  invalid += parallel_sum<mpm::InvalidParticle>(tiles, [&](std::size_t t, mpm::InvalidParticle& of_tile) {
    // The tile's own block is the middle one of its stencil, and its ground is checked one cell beyond its edge.
    const auto own = static_cast<std::size_t>(slide.grid.blocks_about_tile(t)[mpm::Tile<Dim>::stencil / 2]);
    if (!all_tiles && !slide.ground.partly_unknown(own)) {
      return;
    }
    for (std::uint32_t k = slide.grid.tiles()[t].first; k < slide.grid.tiles()[t].last; ++k) {
      const std::uint32_t p = slide.grid.order()[k];
      const auto position = slide.particles.position.template get<Vector<double, Dim - 1>>(p);
      if (setup.model.ground->is_known(position) || (!marks.empty() && marks[p] != stays)) {
        continue;
      }
      if (removes) {
        marks[p] = has_left;
      } else {
        of_tile.record(slide.particles.id(p), mpm::Fault::left_map);
      }
    }
  });
}

Removed count_of(const Marks& marks) {
  const auto count = [&](Mark mark) { return std::count(marks.begin(), marks.end(), std::uint8_t{mark}); };
  return {count(has_left), count(is_not_finite), count(has_inverted)};
}

template <int Dim>
void add_removed(const Setup<Dim>& setup, const Slide<Dim>& slide, const Marks& marks, const Budget<Dim>& before,
                 const band::SumsOfParticle<Dim>& of_particle, Budget<Dim>& budget) {
  if (count_of(marks).not_finite > 0) {
    undo_not_finite(before, budget);
  }
  Marks known = marks;
  for (const std::uint32_t p : slide.grid.order()) {
    if (marks[p] == is_not_finite) {
      known[p] = stays;
      add_not_finite(setup, slide.particles, p, budget);
    }
    budget.removed_mass += marks[p] == is_not_finite || marks[p] == has_inverted ? slide.particles.mass(p) : 0.0;
  }
  const band::BodySums<Dim> sums = sum_over_marked(slide, of_particle, known);
  budget.left_mass += sums.mass;
  budget.left_mechanical += sums.kinetic + sums.potential;
  budget.left_thermal += sums.sensible + sums.latent;
  budget.left_momentum += sums.momentum;
  budget.left_seeped += sums.seeped;
}

template <int Dim>
mpm::InvalidParticle first_invalid(const config::Guards& guards, const mpm::Particles<Dim>& particles,
                                   const Marks& marks) {
  mpm::InvalidParticle invalid;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (marks[p] == is_not_finite || marks[p] == has_inverted) {
      invalid.record(particles.id(p), fault_of(particles, p, guards));
    }
  }
  return invalid;
}

template <int Dim>
band::BodySums<Dim> sum_over_marked(const Slide<Dim>& slide, const band::SumsOfParticle<Dim>& of_particle,
                                    const Marks& marks) {
  using Sums = band::BodySums<Dim>;
  return mpm::sum_over_particles<Sums>(
      slide.grid, [&](std::uint32_t p) { return marks[p] != 0 ? of_particle(slide.particles, p) : Sums{}; });
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                   \
  template void mark_invalid<Dim>(const config::Guards&, const mpm::Particles<Dim>&, Marks&, mpm::InvalidParticle&); \
  template void mark_left<Dim>(const Setup<Dim>&, const Slide<Dim>&, bool, Marks&, mpm::InvalidParticle&);           \
  template void add_removed<Dim>(const Setup<Dim>&, const Slide<Dim>&, const Marks&, const Budget<Dim>&,             \
                                 const band::SumsOfParticle<Dim>&, Budget<Dim>&);                                    \
  template mpm::InvalidParticle first_invalid<Dim>(const config::Guards&, const mpm::Particles<Dim>&, const Marks&); \
  template band::BodySums<Dim> sum_over_marked<Dim>(const Slide<Dim>&, const band::SumsOfParticle<Dim>&, const Marks&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
