// Initial heat content, and the current scaling by the band.
#include "band/heat.hpp"
#include "band/heat_kernels.hpp"
#include "band/rescaling.hpp"
#include "base/instances.hpp"
#include "base/parallel.hpp"

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
double rescale_band(const mpm::SparseGrid<Dim>& grid, const BandModel<Dim>& model, double thickness,
                    mpm::Particles<Dim>& particles, std::size_t first) {
  const BandScaling<Dim> scaling{model.region == BandRegion::all, grid.mapping().has_ground, grid.cell(), thickness};
  return parallel_sum<double>(grid.tiles().size(), [&](std::size_t t, double& added) {
    with_particle_heat(model, [&](const auto& law) {
      for (std::uint32_t k = grid.tiles()[t].first; k < grid.tiles()[t].last; ++k) {
        const std::uint32_t p = grid.order()[k];
        if (p >= first) {
          rescale_particle(model, law, model.pressure, scaling.of(particles, p), p, particles, added);
        }
      }
    });
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

#define THAWSLIDE_INSTANTIATE(Dim)                                                                                    \
  template void set_heat_content<Dim>(const BandModel<Dim>&, mpm::Particles<Dim>&, std::size_t);                      \
  template double rescale_band<Dim>(const mpm::SparseGrid<Dim>&, const BandModel<Dim>&, double, mpm::Particles<Dim>&, \
                                    std::size_t);                                                                     \
  template void add_heat<Dim>(const BandModel<Dim>&, double, std::size_t, mpm::Particles<Dim>&);
THAWSLIDE_FOR_ALL_INSTANCES(THAWSLIDE_INSTANTIATE)
#undef THAWSLIDE_INSTANTIATE

}  // namespace thawslide::band
