#include "sim/between_steps/new_particles.hpp"

#include "band/new_particles.hpp"
#include "base/error.hpp"
#include "base/instances.hpp"
#include "sim/between_steps/splitting.hpp"

namespace thawslide::sim {

namespace {

// Fills in the new particles at the end of the arrays, from `first` on; ids count from `next_id`.
template <int Dim>
void fill_new(const std::vector<NewParticle<Dim>>& joining, std::size_t first, std::int64_t& next_id,
              const Model<Dim>& model, mpm::Particles<Dim>& particles) {
  for (std::size_t k = 0; k < joining.size(); ++k) {
    const NewParticle<Dim>& one = joining[k];
    const std::size_t p = first + k;
    THAWSLIDE_ASSERT(static_cast<std::size_t>(one.body) < model.body_names.size() &&
                         static_cast<std::size_t>(one.material) < model.material_names.size() && one.volume > 0.0,
                     "a particle of body {}, material {} and {} m3 joins", one.body, one.material, one.volume);
    particles.id(p) = next_id++;
    particles.body(p) = one.body;
    particles.material(p) = one.material;
    particles.position.set(p, one.position);
    particles.velocity.set(p, one.velocity);
    particles.volume(p) = particles.initial_volume(p) = one.volume;
    particles.temperature(p) = one.temperature;
    particles.porosity(p) = particles.initial_porosity(p) = one.porosity;
    particles.flow_depth(p) = one.flow_depth;
    particles.thermal_scaling(p) = 1.0;
    for (int c = 0; c < mpm::tensor_components<Dim>; ++c) {
      particles.stress(p, c) = one.stress[c];
    }
  }
}

}  // namespace

template <int Dim>
std::size_t append_particles(const std::vector<NewParticle<Dim>>& joining, const Model<Dim>& model, Slide<Dim>& slide) {
  mpm::Particles<Dim>& particles = slide.particles;
  const std::size_t first = particles.append(joining.size());
  fill_new(joining, first, slide.next_id, model, particles);
  set_unsplit(particles, first);
  band::set_heat_content(model.band, particles, first);
  for (std::size_t p = first; p < particles.size(); ++p) {
    particles.mass(p) = particles.volume(p) * physics::mixture_density(model.motion.phases, particles.porosity(p),
                                                                       particles.liquid_saturation(p));
  }
  return first;
}

#define THAWSLIDE_INSTANTIATE(Dim) \
  template std::size_t append_particles<Dim>(const std::vector<NewParticle<Dim>>&, const Model<Dim>&, Slide<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
