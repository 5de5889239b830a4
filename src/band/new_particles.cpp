#include "band/new_particles.hpp"

#include "band/heat_kernels.hpp"
#include "band/pressure_kernels.hpp"
#include "base/instances.hpp"

namespace thawslide::band {

template <int Dim>
void set_heat_content(const BandModel<Dim>& model, mpm::Particles<Dim>& particles, std::size_t first) {
  model.with_heat_content([&](const auto& content) {
    for (std::size_t p = first; p < particles.size(); ++p) {
      particles.heat_content(p) = content.content(particles.temperature(p), particles.initial_porosity(p));
      if (model.rescaling_mixes) {
        particles.initial_heat_content(p) = particles.heat_content(p);
      }
      particles.liquid_saturation(p) = content.curve.saturation(particles.temperature(p));
      particles.initial_saturation(p) = particles.liquid_saturation(p);
      particles.previous_temperature(p) = particles.temperature(p);
    }
  });
}

template <int Dim>
void add_heat(const BandModel<Dim>& model, double heat, std::size_t particle, mpm::Particles<Dim>& particles) {
  const auto p = static_cast<std::uint32_t>(particle);
  const mpm::ScalarIndex one{{p}};
  const double before = particles.temperature(p);
  particles.heat_content(p) += heat * particles.thermal_scaling(p) / particles.initial_volume(p);
  with_particle_heat(model, [&](const auto& law) {
    particles.temperature(p) = law.temperature(particles, one, particles.heat_content(p), before);
    follow_temperature(model.phases, law, particles, one, true, before);
  });
  particles.previous_temperature(p) = particles.temperature(p);
}

template <int Dim>
void set_pore_pressure(const BandModel<Dim>& model, mpm::Particles<Dim>& particles, std::size_t first) {
  for (std::size_t p = first; p < particles.size(); ++p) {
    if (!model.pressure) {
      particles.pore_pressure(p) = 0.0;
      continue;
    }
    particles.ice_pressure(p) = physics::ice_pressure(model.phases, model.gravity, particles.flow_depth(p));
    if (model.balances_water()) {
      particles.pore_void(p) = void_at_start(model, particles, p);
    }
    if (particles.temperature(p) < model.reference_temperature) {
      const auto frozen = model.ice_presses ? frozen_pressures(model, particles.ice_pressure(p),
                                                               particles.temperature(p), particles.liquid_saturation(p))
                                            : Pressures<double>{};
      particles.liquid_pressure(p) = frozen.liquid;
      particles.pore_pressure(p) = frozen.pore;
    } else {
      particles.liquid_pressure(p) =
          thawing_pressure(model, particles, mpm::ScalarIndex{{static_cast<std::uint32_t>(p)}});
      particles.pore_pressure(p) = particles.liquid_pressure(p);
    }
  }
}

#define THAWSLIDE_INSTANTIATE(Dim)                                                               \
  template void set_heat_content<Dim>(const BandModel<Dim>&, mpm::Particles<Dim>&, std::size_t); \
  template void add_heat<Dim>(const BandModel<Dim>&, double, std::size_t, mpm::Particles<Dim>&); \
  template void set_pore_pressure<Dim>(const BandModel<Dim>&, mpm::Particles<Dim>&, std::size_t);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
