// Particles appended to a run between two steps.
#include <algorithm>

#include "band/heat.hpp"
#include "band/pore_pressure.hpp"
#include "base/error.hpp"
#include "base/instances.hpp"
#include "sim/simulation.hpp"
#include "sim/splitting.hpp"
#include "terrain/ground_on_grid.hpp"
#include "terrain/near_ground.hpp"

namespace thawslide::sim {

// Fills in the new particles at the end of the arrays, from `first` on; ids count from `next_id`.
template <int Dim>
void fill_new(const std::vector<NewParticle<Dim>>& joining, std::size_t first, std::int64_t& next_id,
              const Model<Dim>& model, mpm::Particles<Dim>& particles) {
  for (std::size_t k = 0; k < joining.size(); ++k) {
    const NewParticle<Dim>& one = joining[k];
    const std::size_t p = first + k;
    THAWSLIDE_ASSERT(static_cast<std::size_t>(one.body) < model.body_names.size() &&
                         static_cast<std::size_t>(one.material) < model.material_names.size() && one.volume > Real(0),
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
    particles.thermal_scaling(p) = Real(1);
    for (int c = 0; c < mpm::Particles<Dim>::tensor_components; ++c) {
      particles.stress(p, c) = one.stress[c];
    }
  }
}

template <int Dim>
void Simulation<Dim>::append(const std::vector<NewParticle<Dim>>& joining) {
  if (joining.empty()) {
    return;
  }
  release_device();
  const std::size_t first = particles_.append(joining.size());
  fill_new(joining, first, next_id_, model_, particles_);
  set_unsplit(particles_, first);
  band::set_heat_content(model_.band, particles_, first);
  for (std::size_t p = first; p < particles_.size(); ++p) {
    particles_.mass(p) = particles_.volume(p) * physics::mixture_density(model_.motion.phases, particles_.porosity(p),
                                                                         particles_.liquid_saturation(p));
  }
  are_particles_located_ = false;
  locate_particles();
  grid_.update(particles_, 0);  // without sorting, so the new particles stay last
  update_ground();
  if (model_.band.pressure && model_.band.needs_normal_load()) {
    update_columns();
    update_normal_load(first);
  }
  band::set_pore_pressure(model_.band, particles_, first);
  if (model_.motion.effective_stress) {
    mpm::split_total_stress(particles_, first);
  }
  if (model_.ground) {
    terrain::set_contact_offset(model_.motion.sizes, grid_.cell(), particles_, first);
  }
  if (!model_.contact.band_columns) {
    band::rescale_band(grid_, model_.band, static_cast<Real>(band_thickness()), particles_, first);
  }
  for (std::size_t k = 0; model_.band.heat && k < joining.size(); ++k) {
    band::add_heat(model_.band, joining[k].heat, first + k, particles_);
  }
  std::vector<std::uint8_t> is_new(particles_.size(), 0);
  std::fill(is_new.begin() + static_cast<std::ptrdiff_t>(first), is_new.end(), std::uint8_t{1});
  const BodySums<Dim> sums = sum_over_marked(is_new);
  budget_.joined_mass += sums.mass;
  budget_.joined_mechanical += sums.kinetic + sums.potential;
  budget_.joined_thermal += sums.sensible + sums.latent;
  budget_.joined_momentum += sums.momentum;
}

#define THAWSLIDE_INSTANTIATE(Dim) template void Simulation<Dim>::append(const std::vector<NewParticle<Dim>>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::sim
